// SPDX-License-Identifier: MIT
#include "core/scan/sensor_model.h"

#include <pybind11/stl.h>

#include <tuple>

#include "core/text.h"
#include "python/module/bindings.h"

namespace raymoval::python {

void bind_sensors(py::module_& module) {
  py::class_<SensorModel>(module, "SensorModel",
                          "What is known of a sensor. Angles in radians in the sensor frame "
                          "(azimuth counter-clockwise from +x about +z, elevation up from the x-y "
                          "plane), ranges in metres. If the sensor spins about another axis than "
                          "+z, angles are about that axis.")
      .def(py::init<>())
      .def_static("named", &sensor_model_named, py::arg("name"),
                  "The data sheet values of a known sensor (see `sensors`).")
      .def_readwrite("name", &SensorModel::name)
      .def_readwrite("azimuth_min", &SensorModel::azimuth_min)
      .def_readwrite("azimuth_max", &SensorModel::azimuth_max,
                     "Above pi where the view goes through the back of the sensor frame.")
      .def_readwrite("elevation_min", &SensorModel::elevation_min)
      .def_readwrite("elevation_max", &SensorModel::elevation_max)
      .def_readwrite("azimuth_step", &SensorModel::azimuth_step,
                     "Between neighbouring directions of one beam; 0 = unknown.")
      .def_readwrite("elevation_step", &SensorModel::elevation_step,
                     "Mean between neighbouring beams; 0 = unknown.")
      .def_readwrite("range_min", &SensorModel::range_min, "Nearest range that it reports.")
      .def_readwrite("range_max", &SensorModel::range_max, "Farthest range that it reports.")
      .def_readwrite("missing_return_is_meaningful", &SensorModel::missing_return_is_meaningful,
                     "Whether a direction without a return means that nothing stood within range.")
      .def_property_readonly(
          "spin_axis",
          [](const SensorModel& sensor) {
            return std::make_tuple(sensor.spin_axis.x(), sensor.spin_axis.y(),
                                   sensor.spin_axis.z());
          },
          "Unit vector of the frame of the points; +z if none was found.")
      .def_readonly("basis", &SensorModel::basis,
                    "What an estimate rests on; empty for a sensor of known values.")
      .def_readonly("beams", &SensorModel::beams,
                    "As an estimate found them; 0 where they are unknown.")
      .def("__repr__", [](const SensorModel& sensor) {
        const auto degrees = [](double radians) { return fixed_text(radians * 57.29577951, 1); };
        return "<raymoval.SensorModel " + sensor.name + ": elevation " +
               degrees(sensor.elevation_min) + " to " + degrees(sensor.elevation_max) +
               " deg, range " + number_text(sensor.range_min) + " to " +
               number_text(sensor.range_max) + " m>";
      });
  module.def("sensors", &sensor_model_names, "Names of the known sensors.");
}

}  // namespace raymoval::python
