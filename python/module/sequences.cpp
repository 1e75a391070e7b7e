// SPDX-License-Identifier: MIT
#include "python/module/sequences.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "benchmark/suite/reading_options.h"
#include "core/error.h"
#include "core/files/scratch_folder.h"
#include "core/parallel.h"
#include "core/scan/scan_spool.h"
#include "core/text.h"
#include "datasets/clouds/returns.h"
#include "datasets/open_sequence.h"
#include "datasets/reading/left_out.h"
#include "datasets/settings.h"
#include "datasets/world_axes/up_direction.h"
#include "python/module/bindings.h"
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

std::string text_of(const py::handle& value) {
  return py::str(value);
}

/// The options of `raymoval.open`: those of the command line, with _ for -.
SequenceOptions options_from(const py::dict& given) {
  SequenceOptions options;
  for (const auto& [key, value] : given) {
    const std::string name = text_of(key);
    std::vector<std::string> names;
    const ReadingOption* found = nullptr;
    for (const ReadingOption& option : reading_options()) {
      names.push_back(option.name);
      std::replace(names.back().begin(), names.back().end(), '-', '_');
      if (names.back() == name) found = &option;
    }
    if (found == nullptr) {
      throw UsageError("raymoval.open has no option '" + name + "'." + suggestion(name, names));
    }
    const bool is_flag = found->type.empty();
    if (!is_flag || value.cast<bool>()) found->set(options, name, text_of(value));
  }
  return options;
}

HeldSequence held(std::shared_ptr<const Sequence> sequence) {
  auto truth = std::make_shared<Truth>(Truth{sequence->labels, sequence->label_rule});
  return {std::move(sequence), std::move(truth)};
}

HeldSequence open(const std::string& path, const py::dict& given, int threads,
                  const py::object& on_progress) {
  const SequenceRequest place{path, options_from(given)};
  std::shared_ptr<const Sequence> opened;
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    check_not_both(path);
    opened = std::make_shared<const Sequence>(
        open_sequence(path, place.options,
                      {threads > 0 ? threads : hardware_threads(), work.progress, work.cancel}));
  });
  HeldSequence sequence = held(std::move(opened));
  sequence.place = absolute_place(place);
  return sequence;
}

/// Label words of arrays: a vector for each scan, a word for each row.
class ArrayLabels : public LabelSource {
 public:
  explicit ArrayLabels(std::vector<std::vector<std::uint32_t>> words) : words_(std::move(words)) {}
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    const std::vector<std::uint32_t>& words = words_[scan.index];
    if (words.size() != scan.stored_point_count) {
      throw DataError("labels of scan " + std::to_string(scan.index) + ": there are " +
                      grouped_text(words.size()) + ", expected one for each of its " +
                      grouped_text(scan.stored_point_count) + " points.");
    }
    return of_kept_points(scan, words);
  }

 private:
  std::vector<std::vector<std::uint32_t>> words_;
};

std::shared_ptr<const LabelSource> labels_from(const py::object& labels, std::size_t scans) {
  if (labels.is_none()) return nullptr;
  std::vector<std::vector<std::uint32_t>> words;
  for (const py::handle one : labels) {
    const auto array = py::array::ensure(one);
    const char kind = array ? array.dtype().kind() : 'O';
    if ((kind != 'u' && kind != 'i' && kind != 'b') || array.ndim() != 1) {
      throw UsageError("labels of scan " + std::to_string(words.size()) +
                       ": expected a vector of whole numbers, a label word for each point.");
    }
    const py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast> plain(array);
    words.emplace_back(plain.data(), plain.data() + plain.size());
  }
  if (words.size() != scans) {
    throw UsageError("labels: are those of " + counted_text(words.size(), "scan") + ", expected " +
                     std::to_string(scans) + ".");
  }
  return std::make_shared<ArrayLabels>(std::move(words));
}

std::vector<double> times_from(const py::object& given, std::size_t scans) {
  std::vector<double> times;
  if (!given.is_none()) {
    times = given.cast<std::vector<double>>();
    if (times.size() == scans) return times;
    throw UsageError("times: there are " + std::to_string(times.size()) +
                     ", expected one for each of the " + counted_text(scans, "pose") +
                     ", in seconds.");
  }
  for (std::size_t i = 0; i < scans; ++i) {
    times.push_back(static_cast<double>(i) * kUsualScanPeriod);
  }
  return times;
}

std::optional<Eigen::Vector3d> up_from(const py::object& given) {
  if (given.is_none()) return std::nullopt;
  const std::string text = py::str(given);
  const auto up = parse_up(text);
  if (!up) throw UsageError("up: '" + text + "' is not a direction; " + kUpForm + ".");
  return up;
}

HeldSequence from_arrays(const py::object& scans, const py::object& poses, const py::object& times,
                         const py::object& sensor, const py::object& up, const py::object& labels,
                         const std::string& name) {
  if (poses.is_none()) {
    throw UsageError("poses are missing, expected n x 4 x 4 numbers: T_world_sensor of each scan.");
  }
  ArraySource::Facts facts;
  facts.poses = poses_from(poses);
  facts.times = times_from(times, facts.poses.size());
  if (py::isinstance<SensorModel>(sensor)) {
    facts.sensor = sensor.cast<SensorModel>();
  } else if (!sensor.is_none()) {
    facts.sensor_name = sensor.cast<std::string>();
  }
  const std::size_t count = facts.poses.size();
  const auto direction = up_from(up);
  auto points = point_store(scans, count);
  const auto source = std::make_shared<const ArraySource>(std::move(points), std::move(facts));
  auto sequence = std::make_shared<Sequence>();
  sequence->name = name;
  sequence->layout = "arrays";
  sequence->scans = sequence->opened = source;
  sequence->labels = labels_from(labels, count);
  sequence->up_choice = std::make_shared<const UpChoice>(direction);
  HeldSequence made = held(std::move(sequence));
  made.arrays = source;
  return made;
}

/// Reads all scans for their times, because not every source has the times separately.
py::array_t<double> times_of(const HeldSequence& held, const py::object& on_progress) {
  const ScanSource& scans = *held.sequence->scans;
  std::vector<double> times(scans.size());
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    work.progress->begin("times", scans.size());
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (work.cancel->load()) throw Cancelled();
      times[i] = scans.load(i).time_s;
      work.progress->advance();
    }
  });
  return py::array_t<double>(static_cast<py::ssize_t>(times.size()), times.data());
}

HeldScan load(const HeldSequence& held, py::ssize_t index) {
  const std::size_t at = position(index, held.sequence->scans->size());
  const py::gil_scoped_release without_gil;
  return {held.sequence->scans->load(at), held.truth};
}

std::string repr_of_sequence(const HeldSequence& held) {
  const Sequence& sequence = *held.sequence;
  return "<raymoval.Sequence " + sequence.name + " (" + sequence.layout +
         "): " + counted_text(sequence.scans->size(), "scan") +
         (sequence.labels ? ", labelled>" : ">");
}

void bind_facts(py::class_<HeldSequence>& sequence) {
  sequence
      .def_property_readonly(
          "name", [](const HeldSequence& held) { return held.sequence->name; }, "Name in results.")
      .def_property_readonly(
          "layout", [](const HeldSequence& held) { return held.sequence->layout; },
          "How it is stored: 'semantickitti', 'files', 'arrays', ...")
      .def_property_readonly(
          "poses",
          [](const HeldSequence& held) { return array_of(poses_of(*held.sequence->scans)); },
          "T_world_sensor of all scans, n x 4 x 4 float64, metres. No scan is read for it.")
      .def_property_readonly(
          "sensor",
          [](const HeldSequence& held) {
            const py::gil_scoped_release without_gil;
            return held.sequence->scans->sensor();
          },
          "The sensor's model; estimated from a few scans if nothing says it.")
      .def_property_readonly(
          "up",
          [](const HeldSequence& held) {
            const py::gil_scoped_release without_gil;
            return axis_text(held.sequence->up().direction);
          },
          "The direction of the world that is up, such as 'z' or '-y'; estimated if nothing says "
          "it.")
      .def_property_readonly(
          "has_labels", [](const HeldSequence& held) { return held.sequence->labels != nullptr; },
          "Whether methods can be scored on it.")
      .def_property_readonly(
          "notes", [](const HeldSequence& held) { return opening_lines(*held.sequence); },
          "What a user should know of how it was opened, in sentences.")
      .def_property_readonly(
          "path",
          [](const HeldSequence& held) {
            return held.place ? std::optional(held.place->path) : std::nullopt;
          },
          "Where it was opened; None for arrays.");
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

void bind_sequences(py::module_& module) {
  py::class_<HeldSequence> sequence(
      module, "Sequence",
      "Posed scans, read one by one when they are asked for: sequence[i] is a Scan. Threads may "
      "share it.");
  sequence.def("__len__", [](const HeldSequence& held) { return held.sequence->scans->size(); })
      .def("__getitem__", &load, py::arg("index"))
      .def("__iter__", &iterator_over)
      .def("__repr__", &repr_of_sequence);
  bind_facts(sequence);
  module.def("open", &open, py::arg("path"), py::arg("options"), py::arg("threads"),
             py::arg("on_progress"));
  module.def("from_arrays", &from_arrays, py::arg("scans"), py::arg("poses"), py::arg("times"),
             py::arg("sensor"), py::arg("up"), py::arg("labels"), py::arg("name"));
  module.def("times", &times_of, py::arg("sequence"), py::arg("on_progress"));
  module.def("scenes", &scene_names, "Names of the scenes that raymoval brings along.");
}

}  // namespace raymoval::python
