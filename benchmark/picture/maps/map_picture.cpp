// SPDX-License-Identifier: MIT
#include "benchmark/picture/maps/map_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "benchmark/suite/cell_selection.h"
#include "benchmark/tables/table_options.h"
#include "core/error.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "eval/protocol_registry.h"

namespace raymoval {
namespace {

constexpr int kMapMargin = 20;
constexpr int kMapGap = 14;
constexpr int kMapHeading = 26;  ///< Height above the panels of a row, for the sequence's name.
constexpr int kCaption = 22;     ///< Height below a panel, for its rates.
constexpr double kMapAround = 30.0;

/// One panel: a raster, or a reason why there is none.
struct MapPanel {
  std::string caption;
  std::string reason;
  std::optional<TopDownRaster> raster;
};

struct MapRow {
  std::string sequence;
  std::vector<MapPanel> panels;  ///< One for each column.
  double resolution = 1.0;
  int width = 0, height = 0;  ///< Of a panel.
  bool has_points = false;    ///< Whether one of its points lies within the panels.
  std::optional<WorldWindow> around = std::nullopt;  ///< Around the sensor's path, if it was read.
};

/// The cells that the picture shows.
std::vector<const KeptCell*> chosen_cells(const KeptRun& run, const MapPictureOptions& options) {
  std::vector<std::string> names;
  for (const KeptCell& cell : run.cells()) names.push_back(cell.sequence + "/" + cell.name);
  const std::vector<bool> fits = select_cells(options.only, names, "run");
  std::vector<const KeptCell*> chosen;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool wanted = options.only.empty() ? !run.cells()[i].control : fits[i];
    if (wanted) chosen.push_back(&run.cells()[i]);
  }
  if (chosen.empty()) {
    throw UsageError("this run has nothing but controls. Name them with --only.");
  }
  return chosen;
}

void check_something_kept(const std::vector<const KeptCell*>& cells) {
  const KeptCell* without = nullptr;
  for (const KeptCell* cell : cells) {
    if (cell->has_removals()) return;
    if (cell->has_result() && without == nullptr) without = cell;
  }
  if (without != nullptr) throw UsageError(keep_removals_remedy(*without));
}

std::string reason_of(const KeptCell* cell) {
  if (cell == nullptr) return "not chosen";
  if (!cell->has_result()) return cell->status + (cell->reason.empty() ? "" : ": " + cell->reason);
  return cell->has_removals() ? "" : "its removals were not stored (run --keep-removals)";
}

/// "PR 98.1  RR 90.0  F1 0.939" by the first protocol of the run.
std::string caption_of(const RunResults& results, const KeptCell& cell) {
  if (results.protocols.empty()) return "";
  std::string text;
  for (const RateSpec& spec : rate_specs()) {
    if (spec.role == RateRole::kMean || spec.role == RateRole::kSecondary) continue;
    const auto value = results.rate(cell.sequence, cell.name, results.protocols.front(), spec.name);
    if (!value) continue;
    text += (text.empty() ? "" : "   ") + spec.name + " " +
            fixed_text(*value, spec.unit == RateUnit::kFraction ? 3 : 1);
  }
  return text;
}

/// Sets the size of the panels of a sequence.
void set_scale(const MapPictureOptions& options, const WorldWindow& window, MapRow& row) {
  row.resolution = options.resolution > 0.0
                       ? options.resolution
                       : std::max(window.width(), window.height()) / options.panel_pixels;
  const double width = std::ceil(window.width() / row.resolution - 1e-6);
  const double height = std::ceil(window.height() / row.resolution - 1e-6);
  if (!(width * height * static_cast<double>(row.panels.size()) <= Canvas::kMostPixels)) {
    throw UsageError("the maps of sequence '" + row.sequence + "' would have " +
                     fixed_text(width, 0) + " x " + fixed_text(height, 0) +
                     " pixels each. Choose a coarser --resolution or a smaller --crop.");
  }
  row.width = std::max(1, static_cast<int>(width));
  row.height = std::max(1, static_cast<int>(height));
}

void fill_row(const KeptRun& run, const std::vector<const KeptCell*>& cells,
              const MapPictureOptions& options, const OpenContext& context, MapRow& row) {
  const bool any = std::any_of(cells.begin(), cells.end(), [](const KeptCell* cell) {
    return cell != nullptr && cell->has_removals();
  });
  if (!any) {
    row.width = options.panel_pixels;
    row.height = std::max(60, options.panel_pixels / 3);
    return;
  }
  const Sequence sequence = run.open(row.sequence, context);
  const LocalFrameSource upright(*sequence.scans, sequence.upright_frame());
  row.around = window_around_way(upright);
  const WorldWindow window = options.crop.value_or(*row.around);
  set_scale(options, window, row);
  std::vector<MaskStore> masks;
  std::vector<TopDownRaster*> rasters;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!row.panels[i].reason.empty()) continue;
    masks.push_back(run.masks(*cells[i], sequence));
    row.panels[i].raster.emplace(window, row.resolution);
    rasters.push_back(&*row.panels[i].raster);
  }
  for_each_shown_point(sequence, upright, masks, "drawing " + sequence.name, context,
                       [&](std::size_t mask, const PointOutcome& point) {
                         rasters[mask]->add(point.world, point.outcome);
                         row.has_points = row.has_points || window.contains(point.world);
                       });
}

void draw_row(Canvas& canvas, const MapRow& row, int column_width, int top) {
  canvas.text(kMapMargin, top + 17, row.sequence, 15, kInk);
  bool scale_shown = false;
  for (std::size_t i = 0; i < row.panels.size(); ++i) {
    const MapPanel& panel = row.panels[i];
    const int left = kMapMargin + static_cast<int>(i) * (column_width + kMapGap) +
                     (column_width - row.width) / 2;
    const int y = top + kMapHeading;
    if (panel.raster) {
      panel.raster->draw(canvas, left, y);
    } else {
      canvas.hatch(left, y, row.width, row.height);
      const std::string reason = canvas.fitted(panel.reason, 13, row.width - 24);
      const int width = canvas.text_width(reason, 13);
      canvas.fill(left + (row.width - width) / 2 - 6, y + row.height / 2 - 16, width + 12, 24,
                  kPaper);
      canvas.text(left + row.width / 2, y + row.height / 2, reason, 13, kSoftInk, Align::kCentre);
    }
    canvas.frame(left, y, row.width, row.height, kBorder);
    if (panel.raster && !scale_shown) {
      draw_scale_bar(canvas, left + 10, y + row.height - 12, row.resolution, row.width / 3);
      scale_shown = true;
    }
    canvas.text(left + row.width / 2, y + row.height + 16,
                canvas.fitted(panel.caption, 12, column_width), 12, kSoftInk, Align::kCentre);
  }
}

/// @param around the window around the sensor's path
[[noreturn]] void throw_empty_crop(const WorldWindow& crop, const WorldWindow& around) {
  const auto text = [](const WorldWindow& window) {
    return fixed_text(window.x_min, 0) + ":" + fixed_text(window.x_max, 0) + ":" +
           fixed_text(window.y_min, 0) + ":" + fixed_text(window.y_max, 0);
  };
  throw UsageError("--crop " + text(crop) +
                   ": no point lies there. The sensor and 30 m around it are within " +
                   text(around) + " (metres of the world frame).");
}

/// @throws UsageError if no point of the rows that were read lies within `crop`
void check_crop(const WorldWindow& crop, const std::vector<MapRow>& rows) {
  std::optional<WorldWindow> around;
  for (const MapRow& row : rows) {
    if (row.has_points) return;
    if (!around) around = row.around;
  }
  if (around) throw_empty_crop(crop, *around);
}

Canvas drawn(const std::vector<MapRow>& rows, const std::vector<std::string>& methods) {
  int column_width = 1;
  int height = kMapMargin + 24 + 34 + kMapMargin;
  for (const MapRow& row : rows) {
    column_width = std::max(column_width, row.width);
    height += kMapHeading + row.height + kCaption + kMapGap;
  }
  const int columns = static_cast<int>(methods.size());
  // Wide enough for the legend below one narrow column.
  const int width = std::max(2 * kMapMargin + columns * (column_width + kMapGap) - kMapGap, 620);
  Canvas canvas(width, height);
  for (int i = 0; i < columns; ++i) {
    canvas.text(kMapMargin + i * (column_width + kMapGap) + column_width / 2, kMapMargin + 14,
                canvas.fitted(methods[static_cast<std::size_t>(i)], 16, column_width), 16, kInk,
                Align::kCentre);
  }
  int top = kMapMargin + 24;
  for (const MapRow& row : rows) {
    draw_row(canvas, row, column_width, top);
    top += kMapHeading + row.height + kCaption + kMapGap;
  }
  draw_outcome_legend(canvas, kMapMargin, top + 18, 13);
  return canvas;
}

}  // namespace

WorldWindow window_around_way(const ScanSource& scans) {
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < scans.size(); ++i) places.push_back(scans.pose(i).translation());
  return window_around(places, kMapAround);
}

Canvas map_picture(const KeptRun& run, const MapPictureOptions& options,
                   const OpenContext& context) {
  const std::vector<const KeptCell*> chosen = chosen_cells(run, options);
  check_something_kept(chosen);
  std::vector<std::string> methods, sequences;
  for (const KeptCell* cell : chosen) {
    add_once(methods, cell->name);
    add_once(sequences, cell->sequence);
  }
  std::vector<MapRow> rows;
  for (const std::string& sequence : sequences) {
    MapRow row;
    row.sequence = sequence;
    std::vector<const KeptCell*> cells;
    for (const std::string& method : methods) {
      const auto found = std::find_if(chosen.begin(), chosen.end(), [&](const KeptCell* cell) {
        return cell->sequence == sequence && cell->name == method;
      });
      const KeptCell* cell = found == chosen.end() ? nullptr : *found;
      cells.push_back(cell);
      row.panels.push_back(
          {cell != nullptr ? caption_of(run.results(), *cell) : "", reason_of(cell), std::nullopt});
    }
    fill_row(run, cells, options, context, row);
    rows.push_back(std::move(row));
  }
  if (options.crop) check_crop(*options.crop, rows);
  return drawn(rows, methods);
}

}  // namespace raymoval
