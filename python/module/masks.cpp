// SPDX-License-Identifier: MIT
#include "python/module/masks.h"

#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "python/module/bindings.h"

namespace raymoval::python {
namespace {

void check_count(std::size_t masks, std::size_t scans) {
  if (masks == scans) return;
  throw MethodError("there are " + counted_text(masks, "mask") + ", expected one for each of " +
                    counted_text(scans, "scan") + ".");
}

/// Of a mask with a value for each row, the values of the points that `scan` has.
Mask of_points(const Scan& scan, const Mask& rows) {
  Mask mask(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) mask[i] = rows[scan.stored_position(i)];
  return mask;
}

py::array_t<bool> get(const HeldMasks& held, py::ssize_t index) {
  return array_of(held.mask(position(index, held.masks.size())));
}

}  // namespace

Mask HeldMasks::mask(std::size_t scan) const {
  Mask seen = masks.get(scan);
  const Mask missing = left_out.size() > 0 ? left_out.get(scan) : Mask();
  if (missing.empty()) return seen;
  Mask rows(missing.size(), 0);
  std::size_t next = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (missing[row] == 0) rows[row] = seen[next++];
  }
  return rows;
}

MaskStore masks_from(const py::object& given, const HeldSequence& sequence) {
  const ScanSource& scans = *sequence.sequence->scans;
  if (py::isinstance<HeldMasks>(given)) {
    const HeldMasks& held = given.cast<const HeldMasks&>();
    check_count(held.masks.size(), scans.size());
    return held.masks;
  }
  MaskStore masks(scans.size());
  std::size_t count = 0;
  for (const py::handle one : given) {
    const std::size_t index = count++;
    if (index >= scans.size()) continue;
    const std::string where = "mask " + std::to_string(index);
    const Mask mask = mask_from(one, where);
    const py::gil_scoped_release without_gil;
    const Scan scan = scans.load(index);
    if (mask.size() != sequence.mask_size(scan)) {
      throw MethodError(where + ": has " + grouped_text(mask.size()) +
                        " values, expected one for each of the scan's " +
                        grouped_text(sequence.mask_size(scan)) + " points.");
    }
    masks.set(index, sequence.arrays ? of_points(scan, mask) : mask);
  }
  check_count(count, scans.size());
  return masks;
}

void bind_masks(py::module_& module) {
  py::class_<HeldMasks>(module, "Masks",
                        "What a method removes: masks[i] is a vector of bool, True for each point "
                        "of scan i that is removed. It takes about a bit for each point.")
      .def("__len__", [](const HeldMasks& held) { return held.masks.size(); })
      .def("__getitem__", &get, py::arg("index"))
      .def("__iter__", &iterator_over)
      .def_property_readonly(
          "removed_count", [](const HeldMasks& held) { return held.masks.removed_count(); },
          "Points that are removed, of all scans.")
      .def_property_readonly(
          "nbytes",
          [](const HeldMasks& held) { return held.masks.bytes() + held.left_out.bytes(); },
          "What the masks take in memory.")
      .def("__repr__", [](const HeldMasks& held) {
        return "<raymoval.Masks of " + counted_text(held.masks.size(), "scan") + ": " +
               counted_text(held.masks.removed_count(), "point") + " removed>";
      });
}

}  // namespace raymoval::python
