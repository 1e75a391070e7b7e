// SPDX-License-Identifier: MIT
// "BeautyMap"; the sections are those of beautymap.h.
#include "methods/beautymap/beautymap.h"

#include <algorithm>
#include <limits>

#include "methods/beautymap/column_map.h"
#include "methods/common/answers.h"
#include "methods/common/prepared_scans.h"
#include "methods/common/remover_from.h"

namespace raymoval::beautymap_method {
namespace {

/// One pass, timed as a stage: `find(scan, work)` computes what does not depend on other scans, on
/// any thread, and `take(work)` uses it, in order of time.
template <class Work, class Find, class Take>
void for_scans_in_order(const char* what, const char* stage, const ScanSource& scans,
                        const RunContext& context, Find&& find, Take&& take) {
  for_prepared_scans<Work>(
      what, stage, scans, context,
      [&](const Scan& scan, Work& work, const RunContext& here) {
        const StageScope timed(here.times, stage);
        find(scan, work);
      },
      [&](const Work& work, const RunContext& here) {
        const StageScope timed(here.times, stage);
        take(work);
      });
}

/// The lattice of columns: it begins at the map's least x and y, or at the world's origin.
Lattice place_lattice(const Parameters& parameters, const ScanSource& scans,
                      const RunContext& context) {
  Lattice lattice(parameters);
  if (!parameters.public_lattice) return lattice;
  using Corner = Eigen::Vector2d;
  Corner least = Corner::Constant(std::numeric_limits<double>::infinity());
  for_scans_in_order<Corner>(
      "beautymap, extent", "extent", scans, context,
      [](const Scan& scan, Corner& corner) {
        corner.setConstant(std::numeric_limits<double>::infinity());
        for (const Eigen::Vector3f& point : scan.points) {
          corner = corner.cwiseMin((scan.T_world_sensor * point.cast<double>()).head<2>());
        }
      },
      [&](const Corner& corner) { least = least.cwiseMin(corner); });
  if (least.allFinite()) lattice.origin = least;
  return lattice;
}

/// Section A.
ColumnMap build_map(const Parameters& parameters, const ScanSource& scans,
                    const RunContext& context) {
  const Lattice lattice = place_lattice(parameters, scans, context);
  LowestPoints lowest;
  for_scans_in_order<LowestPoints>(
      "beautymap, columns", "columns", scans, context,
      [&](const Scan& scan, LowestPoints& of_scan) { of_scan = lowest_points(scan, lattice); },
      [&](const LowestPoints& of_scan) { add_lowest(of_scan, lowest); });
  ColumnMap map(parameters, lattice, lowest);
  for_scans_in_order<std::vector<PlacedPoint>>(
      "beautymap, slices", "slices", scans, context,
      [&](const Scan& scan, auto& placed) { map.place(scan, placed); },
      [&](const auto& placed) { map.add(placed); });
  map.finish();
  return map;
}

/// Section B.
void judge_map(const Parameters& parameters, const ScanSource& scans, const RunContext& context,
               ColumnMap& map) {
  for_scans_in_order<Marks>(
      "beautymap, judgement", "judgement", scans, context,
      [&](const Scan& scan, Marks& marks) {
        std::vector<PlacedPoint> placed;
        map.place(scan, placed);
        marks = judge(parameters, map, scan, placed);
      },
      [&](const Marks& marks) { add_marks(marks, map); });
}

void run(const Parameters& parameters, const ScanSource& scans, RemovalSink& sink,
         const RunContext& context) {
  ColumnMap map = build_map(parameters, scans, context);
  judge_map(parameters, scans, context, map);
  answer_scans("beautymap, answers", scans, sink, context, [&](const Scan& scan) {  // Section C.
    std::vector<PlacedPoint> placed;
    map.place(scan, placed);
    Mask mask(scan.size());
    std::transform(placed.begin(), placed.end(), mask.begin(),
                   [&](const PlacedPoint& point) { return map.is_removed(point) ? 1 : 0; });
    return mask;
  });
}

}  // namespace

std::unique_ptr<Remover> make_beautymap(const Parameters& parameters) {
  return remover_from(parameters, run);
}

}  // namespace raymoval::beautymap_method
