// SPDX-License-Identifier: MIT
#include "python/module/remover.h"

#include <pybind11/stl.h>

#include <mutex>
#include <shared_mutex>
#include <utility>

#include "core/error.h"
#include "python/module/arrays.h"
#include "python/module/bindings.h"
#include "python/module/interruptible.h"
#include "python/module/scans.h"

namespace raymoval::python {
namespace {

/// What a method in Python is given. It may keep it for longer than its run. Each of these
/// functions lets go of the GIL before it waits for the lock.
class MethodRun {
 public:
  MethodRun(const ScanSource& scans, RemovalSink& sink, const RunContext& context)
      : size_(scans.size()), scans_(&scans), sink_(&sink), context_(&context) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] HeldScan load(py::ssize_t index) const {
    const std::size_t at = position(index, size_);
    const py::gil_scoped_release without_gil;
    const std::shared_lock lock(mutex_);
    check_is_running();
    return {scans_->load(at), nullptr};
  }
  void accept(std::size_t scan, const py::object& value) const {
    const Mask mask = mask_from(value, "scan " + std::to_string(scan));
    const py::gil_scoped_release without_gil;
    const std::shared_lock lock(mutex_);
    check_is_running();
    sink_->accept(scan, mask);
    context_->advance();
  }
  [[nodiscard]] SensorModel sensor() const {
    const py::gil_scoped_release without_gil;
    const std::shared_lock lock(mutex_);
    check_is_running();
    return scans_->sensor();
  }
  [[nodiscard]] std::vector<Pose> poses() const {
    const py::gil_scoped_release without_gil;
    const std::shared_lock lock(mutex_);
    check_is_running();
    return poses_of(*scans_);
  }
  [[nodiscard]] int threads() const {
    const py::gil_scoped_release without_gil;
    const std::shared_lock lock(mutex_);
    check_is_running();
    return context_->threads;
  }
  /// To be called without the GIL as well.
  void end() {
    const std::unique_lock lock(mutex_);
    scans_ = nullptr;
  }

 private:
  void check_is_running() const {
    if (scans_ == nullptr) {
      throw UsageError("the run of the method is over; its scans and its sink ended with it.");
    }
    context_->check_cancelled();
  }

  std::size_t size_;
  mutable std::shared_mutex mutex_;
  const ScanSource* scans_;
  RemovalSink* sink_;
  const RunContext* context_;
};

struct MethodScans {
  std::shared_ptr<MethodRun> run;
};
struct MethodSink {
  std::shared_ptr<MethodRun> run;
};

/// Ends the run of a method however it ends.
class RunEnd {
 public:
  explicit RunEnd(MethodRun& run) : run_(run) {}
  ~RunEnd() { run_.end(); }
  RunEnd(const RunEnd&) = delete;
  RunEnd& operator=(const RunEnd&) = delete;

 private:
  MethodRun& run_;
};

/// Calls `object.run`. Python's exceptions pass through.
class PythonRemover : public Remover {
 public:
  explicit PythonRemover(SharedObject object) : object_(std::move(object)) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    context.begin_pass("scans", scans.size());
    const auto run = std::make_shared<MethodRun>(scans, sink, context);
    const RunEnd end(*run);
    const py::gil_scoped_acquire gil;
    const PythonScope in_python;
    object_.get().attr("run")(MethodScans{run}, MethodSink{run});
  }

 private:
  SharedObject object_;
};

/// Where an exception was raised: " (voxels.py, line 12, in run)".
std::string place_text(const py::error_already_set& error) {
  py::object trace = error.trace();
  if (!trace || trace.is_none()) return "";
  while (!trace.attr("tb_next").is_none()) trace = trace.attr("tb_next");
  const py::object code = trace.attr("tb_frame").attr("f_code");
  return " (" + std::string(py::str(code.attr("co_filename"))) + ", line " +
         std::string(py::str(trace.attr("tb_lineno"))) + ", in " +
         std::string(py::str(code.attr("co_name"))) + ")";
}

/// What an exception says, with its class unless it is one of raymoval.
std::string exception_text(const py::error_already_set& error) {
  const py::object own = py::module_::import("raymoval._raymoval").attr("Error");
  std::string text = py::str(error.value());
  if (error.matches(own)) return text;
  const std::string name = py::str(error.type().attr("__name__"));
  return text.empty() ? name : name + ": " + text;
}

/// Whether an exception means that the run was cancelled.
bool says_cancelled(const py::error_already_set& error) {
  return error.matches(PyExc_KeyboardInterrupt) ||
         error.matches(py::module_::import("raymoval._raymoval").attr("Cancelled"));
}

/// The same for the harness, to which a method that raises is a failed one.
class HarnessedRemover : public Remover {
 public:
  HarnessedRemover(std::string name, SharedObject object)
      : name_(std::move(name)), remover_(std::move(object)) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    std::string failure;
    try {
      remover_.run(scans, sink, context);
    } catch (const py::error_already_set& error) {
      const py::gil_scoped_acquire gil;
      if (says_cancelled(error)) throw Cancelled();
      failure = "method '" + name_ + "' raised " + exception_text(error) + place_text(error);
    }
    if (!failure.empty()) throw MethodError(failure);
  }

 private:
  std::string name_;
  PythonRemover remover_;
};

ParameterValue value_from(const std::string& name, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::int_>(value)) return value.cast<std::int64_t>();
  if (py::isinstance<py::float_>(value)) return value.cast<double>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  throw UsageError("parameter '" + name + "': expected a bool, a number or a text.");
}

py::dict dict_of(const Configuration& configuration) {
  py::dict values;
  for (const auto& [name, value] : configuration) {
    values[py::str(name)] = std::visit([](const auto& one) { return py::cast(one); }, value);
  }
  return values;
}

}  // namespace

std::unique_ptr<Remover> python_remover(const py::object& object) {
  return std::make_unique<PythonRemover>(SharedObject(object));
}

MethodEntry python_entry(const py::dict& described) {
  const auto text = [&](const char* key) { return described[key].cast<std::string>(); };
  MethodEntry entry;
  entry.name = text("name");
  entry.sentence = text("sentence");
  entry.source = "Python";
  entry.version = text("version");
  for (const auto& [key, value] : described["parameters"].cast<py::dict>()) {
    ParameterSpec spec;
    spec.name = py::str(key);
    spec.default_value = value_from(spec.name, value);
    entry.parameters.push_back(std::move(spec));
  }
  entry.variants = {
      {.name = "python", .sentence = "As it is.", .online = described["online"].cast<bool>()}};
  const SharedObject make(described["make"]);
  entry.make = [make, name = entry.name](const Configuration& values) {
    const py::gil_scoped_acquire gil;
    return std::make_unique<HarnessedRemover>(name, SharedObject(make.get()(dict_of(values))));
  };
  return entry;
}

void bind_remover(py::module_& module) {
  py::class_<MethodScans>(module, "Scans",
                          "The scans of a method's run: scans[i] is a Scan without labels, in the "
                          "frame that the harness chooses: the first scan is at its origin, z "
                          "points up.")
      .def("__len__", [](const MethodScans& scans) { return scans.run->size(); })
      .def(
          "__getitem__",
          [](const MethodScans& scans, py::ssize_t index) { return scans.run->load(index); },
          py::arg("index"))
      .def("__iter__", &iterator_over)
      .def_property_readonly(
          "poses", [](const MethodScans& scans) { return array_of(scans.run->poses()); },
          "T_world_sensor of all scans, n x 4 x 4 float64, metres.")
      .def_property_readonly(
          "sensor", [](const MethodScans& scans) { return scans.run->sensor(); },
          "The sensor's model.")
      .def_property_readonly(
          "threads", [](const MethodScans& scans) { return scans.run->threads(); },
          "How many threads the method may use.");
  py::class_<MethodSink>(module, "Sink", "Takes a method's answer.")
      .def(
          "accept",
          [](const MethodSink& sink, std::size_t scan, const py::object& mask) {
            sink.run->accept(scan, mask);
          },
          py::arg("scan"), py::arg("mask"),
          "Takes the mask of a scan: N bool, True for what is removed. Each scan exactly once, in "
          "any order.");
}

}  // namespace raymoval::python
