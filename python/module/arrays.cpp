// SPDX-License-Identifier: MIT
#include "python/module/arrays.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "datasets/clouds/poses.h"

namespace raymoval::python {
namespace {

/// @throws UsageError if numpy.asarray fails
py::array as_array(const py::handle& value, const std::string& where, const char* expected) {
  if (py::isinstance<py::array>(value)) return py::reinterpret_borrow<py::array>(value);
  const std::string type = py::str(py::type::handle_of(value).attr("__name__"));
  const std::string message = where + ": is a " + type + ", expected " + expected + ".";
  // NumPy would make arrays of objects of these, with a warning or without.
  if (py::isinstance<py::tuple>(value) || py::isinstance<py::dict>(value) || value.is_none()) {
    throw UsageError(message);
  }
  try {
    return py::module_::import("numpy").attr("asarray")(value).cast<py::array>();
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) throw;
    throw UsageError(message);
  }
}

std::string type_text(const py::array& array) {
  return py::str(array.dtype());
}

/// Whether `array` has numbers of this type. NumPy converts arrays with swapped bytes.
template <class Number>
bool holds(const py::array& array) {
  return py::isinstance<py::array_t<Number>>(array);
}

py::array_t<double, py::array::c_style | py::array::forcecast> as_doubles(const py::handle& value,
                                                                          const std::string& where,
                                                                          const char* expected) {
  const py::array array = as_array(value, where, expected);
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    throw UsageError(where + ": has numbers of type " + type_text(array) + ", expected float64.");
  }
  return array;
}

/// @param matrix 16 numbers row by row
Pose rigid_motion(const double* matrix, const std::string& where) {
  Eigen::Matrix<double, 3, 4> upper;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) upper(i, j) = matrix[4 * i + j];
  }
  const bool is_affine =
      matrix[12] == 0.0 && matrix[13] == 0.0 && matrix[14] == 0.0 && matrix[15] == 1.0;
  if (!is_affine) {
    throw DataError(where + ": its last row is not 0 0 0 1, expected T_world_sensor as a 4 x 4 " +
                    "matrix that takes column vectors. Transpose it if it takes rows.");
  }
  return rigid_pose(upper, where);
}

template <class Number>
bool all_are_0_or_1(const char* data, std::size_t size, std::ptrdiff_t stride) {
  for (std::size_t i = 0; i < size; ++i) {
    Number value;
    std::memcpy(&value, data + static_cast<std::ptrdiff_t>(i) * stride, sizeof(Number));
    if (value != Number{0} && value != Number{1}) return false;
  }
  return true;
}

}  // namespace

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape"));
}

PointArray::PointArray(const py::handle& value, const std::string& where) {
  const py::array array = as_array(value, where, "an array of N x 3 points (float32 or float64)");
  if (array.ndim() != 2 || array.shape(1) < 3) {
    const bool is_transposed = array.ndim() == 2 && (array.shape(0) == 3 || array.shape(0) == 4);
    throw UsageError(
        where + ": the points have the shape " + shape_text(array) +
        ", expected (N, 3): x, y and z in metres; with (N, 4) the last is the reflectance." +
        (is_transposed ? " Transpose them: points.T." : ""));
  }
  const bool is_float = holds<float>(array);
  if (!is_float && !holds<double>(array)) {
    throw UsageError(where + ": the points are " + type_text(array) +
                     ", expected float32 or float64 (metres). Convert them with " +
                     "points.astype(numpy.float32).");
  }
  is_double_ = !is_float;
  data_ = static_cast<const char*>(array.data());
  rows_ = static_cast<std::size_t>(array.shape(0));
  columns_ = static_cast<std::size_t>(array.shape(1));
  row_stride_ = array.strides(0);
  column_stride_ = array.strides(1);
  owner_ = SharedObject(array);
}

template <class Number>
void PointArray::copy_to(Cloud& cloud) const {
  const auto at = [&](const char* row, std::ptrdiff_t column) {
    Number value;  // Strides need not be multiples of its size.
    std::memcpy(&value, row + column * column_stride_, sizeof(Number));
    return static_cast<float>(value);
  };
  cloud.points.resize(rows_);
  for (std::size_t i = 0; i < rows_; ++i) {
    const char* row = data_ + static_cast<std::ptrdiff_t>(i) * row_stride_;
    cloud.points[i] = {at(row, 0), at(row, 1), at(row, 2)};
  }
  if (columns_ != 4) return;
  cloud.intensity.resize(rows_);
  for (std::size_t i = 0; i < rows_; ++i) {
    cloud.intensity[i] = at(data_ + static_cast<std::ptrdiff_t>(i) * row_stride_, 3);
  }
}

Cloud PointArray::cloud() const {
  Cloud cloud;
  if (is_double_) {
    copy_to<double>(cloud);
  } else {
    copy_to<float>(cloud);
  }
  return cloud;
}

Pose pose_from(const py::handle& value, const std::string& where) {
  const auto matrix = as_doubles(value, where, "a 4 x 4 array");
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4) {
    throw UsageError(where + ": has the shape " + shape_text(matrix) +
                     ", expected (4, 4): T_world_sensor with the last row 0 0 0 1.");
  }
  return rigid_motion(matrix.data(), where);
}

std::vector<Pose> poses_from(const py::handle& value) {
  const auto matrices = as_doubles(value, "poses", "an array of n x 4 x 4 numbers");
  if (matrices.ndim() != 3 || matrices.shape(1) != 4 || matrices.shape(2) != 4) {
    const bool lacks_row = matrices.ndim() == 3 && matrices.shape(1) == 3 && matrices.shape(2) == 4;
    throw UsageError("poses: have the shape " + shape_text(matrices) +
                     ", expected (n, 4, 4): T_world_sensor of each scan." +
                     (lacks_row ? " Append the row 0 0 0 1 to each of them." : ""));
  }
  std::vector<Pose> poses;
  for (py::ssize_t i = 0; i < matrices.shape(0); ++i) {
    poses.push_back(rigid_motion(matrices.data(i, 0, 0), "pose " + std::to_string(i)));
  }
  return poses;
}

py::array_t<double> array_of(const Pose& pose) {
  py::array_t<double> array({4, 4});
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = pose.matrix();
  std::copy_n(matrix.data(), 16, array.mutable_data());
  return array;
}

py::array_t<double> array_of(const std::vector<Pose>& poses) {
  py::array_t<double> array(
      {static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  double* numbers = array.mutable_data();
  for (const Pose& pose : poses) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = pose.matrix();
    numbers = std::copy_n(matrix.data(), 16, numbers);
  }
  return array;
}

Mask mask_from(const py::handle& value, const std::string& where) {
  const py::array array = as_array(value, where, "a vector of bool, one for each point");
  const char kind = array.dtype().kind();
  if (array.ndim() != 1 || (kind != 'b' && kind != 'i' && kind != 'u')) {
    throw UsageError(where + ": the mask has the shape " + shape_text(array) + " and the type " +
                     type_text(array) + ", expected (N,) of bool, True for what is removed.");
  }
  const auto bytes =
      kind == 'b' || array.itemsize() == 1
          ? array
          : py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(array);
  const auto size = static_cast<std::size_t>(bytes.shape(0));
  const char* data = static_cast<const char*>(bytes.data());
  const std::ptrdiff_t stride = bytes.strides(0);
  const bool is_binary = bytes.itemsize() == 1 ? all_are_0_or_1<std::uint8_t>(data, size, stride)
                                               : all_are_0_or_1<std::int64_t>(data, size, stride);
  if (!is_binary) {
    throw MethodError(where + ": a mask value is neither 0 (kept) nor 1 (removed).");
  }
  Mask mask(size);
  for (std::size_t i = 0; i < size; ++i) {
    mask[i] = static_cast<std::uint8_t>(data[static_cast<std::ptrdiff_t>(i) * stride]);
  }
  return mask;
}

py::array_t<bool> array_of(const Mask& mask) {
  py::array_t<bool> array(static_cast<py::ssize_t>(mask.size()));
  std::copy(mask.begin(), mask.end(), array.mutable_data());
  return array;
}

}  // namespace raymoval::python
