// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scan/scan.h"
#include "datasets/clouds/format/cloud_format.h"
#include "python/module/shared_object.h"

namespace raymoval::python {

/// The points of a scan as NumPy holds them: N x k numbers, float32 or float64, with any strides.
/// Columns 0 to 2 are x, y and z in metres; with k = 4 the last is the reflectance. Nothing is
/// copied; reading it needs no GIL.
class PointArray {
 public:
  /// To be called with the GIL.
  /// @param value an array, or what numpy.asarray makes one of
  /// @param where begins messages, such as "scan 3"
  /// @throws UsageError for another shape or another type of numbers
  PointArray(const py::handle& value, const std::string& where);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// A copy in float32; numbers that are not finite are kept.
  [[nodiscard]] Cloud cloud() const;

 private:
  template <class Number>
  void copy_to(Cloud& cloud) const;

  SharedObject owner_;
  const char* data_ = nullptr;
  std::size_t rows_ = 0, columns_ = 0;
  std::ptrdiff_t row_stride_ = 0, column_stride_ = 0;  ///< Bytes.
  bool is_double_ = false;
};

/// "(50, 3, 4)", as NumPy writes the shape of an array.
std::string shape_text(const py::array& array);

/// `T_world_sensor` from a 4 x 4 matrix.
/// @param where begins messages, such as "pose 3"
/// @throws UsageError for another shape; DataError if it is no rigid motion
Pose pose_from(const py::handle& value, const std::string& where);
/// The poses of all scans from n x 4 x 4 numbers. @throws as `pose_from`
std::vector<Pose> poses_from(const py::handle& value);
/// 4 x 4 numbers, float64.
py::array_t<double> array_of(const Pose& pose);
/// n x 4 x 4 numbers, float64.
py::array_t<double> array_of(const std::vector<Pose>& poses);

/// A mask from a vector of bool, or of whole numbers of which each is 0 or 1.
/// @throws UsageError for another shape or type; MethodError for another number
Mask mask_from(const py::handle& value, const std::string& where);
/// A vector of bool.
py::array_t<bool> array_of(const Mask& mask);

/// A view of `values`, which `owner` holds.
template <class Number>
py::array_t<Number> view_of(const std::vector<Number>& values, const py::handle& owner) {
  return py::array_t<Number>(static_cast<py::ssize_t>(values.size()), values.data(), owner);
}

}  // namespace raymoval::python
