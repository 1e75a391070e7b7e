// SPDX-License-Identifier: MIT
#include "python/module/scans.h"

#include <algorithm>

#include "core/error.h"
#include "python/module/arrays.h"
#include "python/module/bindings.h"

namespace raymoval::python {
namespace {

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

py::array_t<float> points_of(const py::object& self) {
  const Scan& scan = self.cast<const HeldScan&>().scan;
  const auto rows = static_cast<py::ssize_t>(scan.size());
  const float* data = scan.points.empty() ? nullptr : scan.points.front().data();
  return py::array_t<float>({rows, py::ssize_t{3}}, data, self);
}

py::object reflectance_of(const py::object& self) {
  const Scan& scan = self.cast<const HeldScan&>().scan;
  if (scan.reflectance.empty()) return py::none();
  return view_of(scan.reflectance, self);
}

std::vector<std::uint32_t> label_words(const HeldScan& held) {
  const py::gil_scoped_release without_gil;
  return held.truth->labels->labels(held.scan);
}

bool has_labels(const HeldScan& held) {
  return held.truth != nullptr && held.truth->labels != nullptr;
}

py::object labels_of(const HeldScan& held) {
  if (!has_labels(held)) return py::none();
  const std::vector<std::uint32_t> words = label_words(held);
  return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(words.size()), words.data());
}

py::object moving_of(const HeldScan& held) {
  if (!has_labels(held)) return py::none();
  const std::vector<std::uint32_t> words = label_words(held);
  Mask moving(words.size());
  std::transform(words.begin(), words.end(), moving.begin(), [&](std::uint32_t word) {
    return static_cast<std::uint8_t>(held.truth->rule.classify(word) == LabelClass::kMoving);
  });
  return array_of(moving);
}

std::string repr_of_scan(const HeldScan& held) {
  const Scan& scan = held.scan;
  return "<raymoval.Scan " + std::to_string(scan.index) + " (" + scan.name +
         "): " + std::to_string(scan.size()) + " points>";
}

}  // namespace

std::size_t position(py::ssize_t index, std::size_t size) {
  const auto count = static_cast<py::ssize_t>(size);
  if (index < -count || index >= count) {
    throw py::index_error("scan " + std::to_string(index) + " of " + std::to_string(count));
  }
  return static_cast<std::size_t>(index < 0 ? index + count : index);
}

py::object iterator_over(const py::object& sequence) {
  PyObject* iterator = PySeqIter_New(sequence.ptr());
  if (iterator == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(iterator);
}

std::vector<Pose> poses_of(const ScanSource& scans) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < scans.size(); ++i) poses.push_back(scans.pose(i));
  return poses;
}

void bind_scans(py::module_& module) {
  py::class_<HeldScan>(module, "Scan",
                       "One sweep of the sensor. Its arrays are made when they are asked for; "
                       "`points` and `reflectance` are views that copy nothing.")
      .def_property_readonly(
          "index", [](const HeldScan& held) { return held.scan.index; },
          "Position in its sequence, from 0.")
      .def_property_readonly(
          "name", [](const HeldScan& held) { return held.scan.name; },
          "Name of the frame in its data set, such as '000123'.")
      .def_property_readonly(
          "time", [](const HeldScan& held) { return held.scan.time_s; },
          "Seconds since the first scan of the data set.")
      .def_property_readonly(
          "pose", [](const HeldScan& held) { return array_of(held.scan.T_world_sensor); },
          "T_world_sensor, 4 x 4 float64, metres: takes points of the sensor frame to the world.")
      .def_property_readonly("points", &points_of,
                             "N x 3 float32, sensor frame, metres. All are finite; missing "
                             "returns are left out.")
      .def_property_readonly("reflectance", &reflectance_of,
                             "N float32, or None if the data has none.")
      .def_property_readonly("labels", &labels_of,
                             "N uint32 label words: the lower 16 bits are the semantic id, the "
                             "upper ones the instance. None without labels, and for methods.")
      .def_property_readonly("moving", &moving_of,
                             "N bool: whether the label of a point says that it moves. None "
                             "without labels, and for methods.")
      .def_property_readonly(
          "stored_index",
          [](const HeldScan& held) {
            py::array_t<std::uint32_t> index(static_cast<py::ssize_t>(held.scan.size()));
            for (std::size_t i = 0; i < held.scan.size(); ++i) {
              index.mutable_data()[i] = static_cast<std::uint32_t>(held.scan.stored_position(i));
            }
            return index;
          },
          "N uint32: the row of each point in its file or array, missing returns included.")
      .def_property_readonly(
          "stored_point_count", [](const HeldScan& held) { return held.scan.stored_point_count; },
          "Points in the file or array, those left out included.")
      .def("__len__", [](const HeldScan& held) { return held.scan.size(); })
      .def("__repr__", &repr_of_scan);
}

}  // namespace raymoval::python
