// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "core/files/files.h"
#include "core/parallel.h"
#include "datasets/sequence_poses.h"
#include "python/module/arrays.h"
#include "python/module/bindings.h"
#include "python/module/interruptible.h"
#include "python/module/sequences.h"

namespace raymoval::python {
namespace {

/// @param refines whether the poses of the sequence are improved, else they are not used
/// @param file for the poses; empty: none is written
/// @return the poses, n x 4 x 4, and notes for the user
std::pair<py::array_t<double>, std::vector<std::string>> make_poses_of(
    const HeldSequence& held, bool refines, const std::string& file, int threads,
    const py::object& on_progress) {
  Sequence sequence = *held.sequence;
  sequence.notes.clear();
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    make_poses(sequence, refines ? PoseWork::kRefine : PoseWork::kEstimate,
               {threads > 0 ? threads : hardware_threads(), work.progress, work.cancel});
    if (!file.empty()) write_atomically(file, pose_file_text(sequence, file));
  });
  for (const std::string& doubt : sequence.pose_doubts) {
    sequence.notes.push_back("The poses may be wrong: " + doubt + ".");
  }
  return {array_of(sequence.made_poses), sequence.notes};
}

}  // namespace

void bind_poses(py::module_& module) {
  module.def("make_poses", &make_poses_of, py::arg("sequence"), py::arg("refines"), py::arg("file"),
             py::arg("threads"), py::arg("on_progress"));
}

}  // namespace raymoval::python
