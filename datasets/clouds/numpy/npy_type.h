// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "datasets/clouds/numpy/python_value.h"
#include "datasets/records/point_records.h"

namespace raymoval {

/// A field of an array's items, or all of an item that has no fields (then its name is empty).
struct NpyField {
  PointField field;
  bool big_endian = false;
};

/// What the items of an array are.
struct NpyType {
  std::vector<NpyField> fields;
  std::size_t bytes = 0;    ///< Of an item, padding among them.
  bool structured = false;  ///< Whether the items have named fields.
};

/// Reads "descr" of the head of an .npy file. Fields within fields are named "outer.inner"; texts
/// and complex numbers are fields of several values; times are whole numbers.
/// @throws DataError naming the type that is not read, among them Python objects, which only
/// running
///   code could read
NpyType npy_type(const PythonValue& descr, const std::string& where);

/// The text of "descr" for rows of `layout`: a plain type if the layout is of unnamed numbers of
/// one type, else a list of fields.
/// @param names of the fields, as they are to be written
std::string npy_descr(const RecordLayout& layout, const std::vector<std::string>& names);

/// Whether rows of `layout` are numbers of one type that never had names.
bool is_plain_array(const RecordLayout& layout);

}  // namespace raymoval
