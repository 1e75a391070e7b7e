// SPDX-License-Identifier: MIT
#include "python/module/array_source.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/files/scratch_folder.h"
#include "core/scan/scan_spool.h"
#include "core/text.h"
#include "datasets/clouds/returns.h"
#include "python/module/interruptible.h"

namespace raymoval::python {
namespace {

std::string scan_text(std::size_t scan) {
  return "scan " + std::to_string(scan);
}

/// Arrays that are all there.
class ArrayList : public PointStore {
 public:
  explicit ArrayList(std::vector<PointArray> arrays) : arrays_(std::move(arrays)) {}
  [[nodiscard]] std::size_t size() const override { return arrays_.size(); }
  [[nodiscard]] Cloud points(std::size_t scan) const override { return arrays_[scan].cloud(); }

 private:
  std::vector<PointArray> arrays_;
};

/// A sequence in Python that makes its arrays on request.
class PythonSequence : public PointStore {
 public:
  PythonSequence(const py::object& sequence, std::size_t size)
      : sequence_(SharedObject(sequence)), size_(size) {}
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] Cloud points(std::size_t scan) const override { return array(scan).cloud(); }

 private:
  [[nodiscard]] PointArray array(std::size_t scan) const {
    // First this and then the GIL, by every thread: what Python does may let go of the GIL.
    const std::lock_guard lock(mutex_);
    const py::gil_scoped_acquire gil;
    const PythonScope in_python;
    return {sequence_.get().attr("__getitem__")(scan), scan_text(scan)};
  }

  SharedObject sequence_;
  std::size_t size_;
  mutable std::mutex mutex_;
};

ScanSpool generator_spool() {
  return {0, scratch_root() / "raymoval-scans", "the scans of a generator (TMPDIR says where)"};
}

template <class Value>
std::string bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

template <class Value>
std::vector<Value> values_of(const std::string& bytes) {
  std::vector<Value> values(bytes.size() / sizeof(Value));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  return values;
}

/// Keeps points in a file without a name below TMPDIR (else /tmp): 12 bytes a point, 16 with
/// reflectance.
class PointSpool : public PointStore {
 public:
  /// @throws DataError if the file cannot be made
  PointSpool() : points_(generator_spool()), intensities_(generator_spool()) {}
  /// Adds the next scan; no other thread reads meanwhile. @throws DataError if the disk is full
  void add(const Cloud& cloud) {
    points_.append(bytes_of(cloud.points));
    intensities_.append(bytes_of(cloud.intensity));
  }
  [[nodiscard]] std::size_t size() const override { return points_.size(); }
  /// @throws DataError if the file cannot be read
  [[nodiscard]] Cloud points(std::size_t scan) const override {
    Cloud cloud;
    cloud.points = values_of<Eigen::Vector3f>(points_.get(scan));
    cloud.intensity = values_of<float>(intensities_.get(scan));
    return cloud;
  }

 private:
  ScanSpool points_, intensities_;
};

std::shared_ptr<const PointStore> array_list(const py::object& scans) {
  std::vector<PointArray> arrays;
  for (const py::handle scan : scans) arrays.emplace_back(scan, scan_text(arrays.size()));
  return std::make_shared<ArrayList>(std::move(arrays));
}

std::shared_ptr<const PointStore> spooled(const py::object& scans, std::size_t most) {
  auto spool = std::make_shared<PointSpool>();
  for (const py::handle scan : scans) {
    const PointArray array(scan, scan_text(spool->size()));
    {
      const py::gil_scoped_release without_gil;
      spool->add(array.cloud());
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (spool->size() > most) break;  // That they do not fit the poses is known by now.
  }
  return spool;
}

}  // namespace

std::shared_ptr<const PointStore> point_store(const py::object& scans, std::size_t most) {
  if (py::isinstance<py::array>(scans)) {
    const auto array = py::reinterpret_borrow<py::array>(scans);
    if (array.ndim() == 3) return array_list(scans);
    throw UsageError("scans: is one array of the shape " + shape_text(array) +
                     ", expected a list, a sequence or a generator of arrays, one for each scan.");
  }
  if (py::isinstance<py::list>(scans) || py::isinstance<py::tuple>(scans)) return array_list(scans);
  if (py::isinstance<py::str>(scans)) {
    throw UsageError("scans: is a text. Open a path or a scene with raymoval.open first.");
  }
  if (py::hasattr(scans, "__len__") && py::hasattr(scans, "__getitem__")) {
    return std::make_shared<PythonSequence>(scans, py::len(scans));
  }
  if (py::hasattr(scans, "__iter__")) return spooled(scans, most);
  const std::string type = py::str(py::type::handle_of(scans).attr("__name__"));
  throw UsageError("scans: is a " + type +
                   ", expected a list, a sequence or a generator of arrays, one for each scan.");
}

ArraySource::ArraySource(std::shared_ptr<const PointStore> points, Facts facts)
    : points_(std::move(points)),
      facts_(std::move(facts)),
      sensor_(facts_.sensor_name),
      left_out_(facts_.poses.size()) {
  const std::size_t scans = points_->size(), poses = facts_.poses.size();
  if (scans > poses && dynamic_cast<const PointSpool*>(points_.get()) != nullptr) {
    throw UsageError("there are more scans than the " + counted_text(poses, "pose") +
                     ", expected one pose for each.");
  }
  if (scans != poses) {
    throw UsageError("there are " + counted_text(scans, "scan") + " and " +
                     counted_text(poses, "pose") + ", expected one pose for each scan.");
  }
  if (scans == 0) throw UsageError("there is no scan, expected at least one.");
}

Scan ArraySource::load(std::size_t index) const {
  Scan scan;
  scan.index = index;
  scan.name = std::to_string(index);
  scan.name.insert(0, 6 - std::min<std::size_t>(6, scan.name.size()), '0');
  scan.time_s = facts_.times[index];
  scan.T_world_sensor = facts_.poses[index];
  read_returns(
      scan, PointFrame::kSensor, scan_text(index),
      [&](const Eigen::Vector3d&) { return points_->points(index); }, " Leave it out.");
  if (scan.stored_index.empty() && !scan.points.empty()) return scan;
  Mask left_out(scan.stored_point_count, 1);
  for (const std::uint32_t row : scan.stored_index) left_out[row] = 0;
  const std::lock_guard lock(mutex_);
  left_out_.set(index, left_out);
  return scan;
}

const SensorModel& ArraySource::sensor() const {
  if (facts_.sensor) return *facts_.sensor;
  return sensor_.get(size(), [this](std::size_t index) { return load(index); });
}

MaskStore ArraySource::left_out() const {
  const std::lock_guard lock(mutex_);
  return left_out_;
}

}  // namespace raymoval::python
