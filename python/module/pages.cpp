// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "benchmark/report/page.h"
#include "benchmark/report/scene.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "python/module/bindings.h"
#include "python/module/interruptible.h"
#include "python/module/masks.h"

namespace raymoval::python {
namespace {

/// The page of `raymoval report`. @return its HTML and what is missing from it
std::pair<std::string, std::vector<std::string>> run_page(const std::string& folder,
                                                          std::size_t points,
                                                          const py::object& on_progress) {
  Page page;
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    const KeptRun run(folder, "");
    PageRequest request;
    request.run = &run;
    request.methods = &MethodRegistry::built_in();
    request.points = points;
    request.threads = hardware_threads();
    request.progress = work.progress;
    request.cancel = work.cancel;
    page = make_page(request);
    work.progress->end();
  });
  return {page.html, page.warnings};
}

/// What was kept and removed of a sequence, without labels.
Scene scene_of(const HeldSequence& held, const MaskStore& masks, std::size_t points,
               const WorkContext& work) {
  const Sequence& sequence = *held.sequence;
  MapSceneBuilder builder(sequence.name, "removed", sequence.upright_frame(), points);
  work.progress->begin("points for the page", sequence.scans->size());
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    if (work.cancel->load()) throw Cancelled();
    const Scan scan = sequence.scans->load(i);
    builder.add(scan, masks.get(i));
    work.progress->advance();
  }
  work.progress->end();
  return builder.finish();
}

/// The page of `raymoval clean --html`.
std::string masks_page(const HeldSequence& held, const py::object& given, std::size_t points,
                       const py::object& on_progress) {
  const MaskStore masks = masks_from(given, held);
  std::string html;
  run_interruptibly(on_progress, [&](const WorkContext& work) {
    const Scene scene = scene_of(held, masks, points, work);
    html = map_page(scene, held.sequence->name + ", cleaned",
                    {counted_text(masks.removed_count(), "point") + " of " +
                     counted_text(scene.scans.size(), "scan") + " removed."});
  });
  return html;
}

}  // namespace

void bind_pages(py::module_& module) {
  module.def("run_page", &run_page, py::arg("folder"), py::arg("points"), py::arg("on_progress"));
  module.def("masks_page", &masks_page, py::arg("sequence"), py::arg("masks"), py::arg("points"),
             py::arg("on_progress"));
}

}  // namespace raymoval::python
