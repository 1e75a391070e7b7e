// SPDX-License-Identifier: MIT
#pragma once

#include "datasets/clouds/format/cloud_format.h"

namespace raymoval {

/// NumPy's .npy: arrays of named fields (N or H x W), and arrays of numbers of one type (N x k or
/// H x W x k), whose columns are named by the point layout, or x y z intensity field_4 and so on.
/// Arrays of columns (Fortran order) are read too. Points are written as an array of fields;
/// numbers of one type that never had names as an array of numbers.
CloudFormat npy_format();

/// NumPy's .npz, a zip archive of such arrays, stored or deflated: the only array, or the one named
/// points or arr_0. It is not written.
CloudFormat npz_format();

}  // namespace raymoval
