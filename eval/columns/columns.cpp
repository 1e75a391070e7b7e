// SPDX-License-Identifier: MIT
#include "eval/columns/columns.h"

namespace raymoval {
namespace {

/// What of a class a column looks at.
using Part = std::function<PointTally(const ClassTally&)>;

PointTally sum_of(const RemovalTally& tally, bool moving, const Part& part) {
  PointTally sum;
  for (const auto& [id, of_class] : tally.classes) {
    if (of_class.moving == moving) sum += part(of_class);
  }
  return sum;
}

PointTally whole_class(const ClassTally& tally) {
  return tally.all();
}

Share removed_share(const PointTally& points) {
  return {points.removed, points.points};
}

Share kept_share(const PointTally& points) {
  return {points.kept(), points.points};
}

Column precision() {
  return {"precision", "Removed points that move, of all removed points.", Better::kHigher,
          "no point was removed", [](const RemovalTally& tally) {
            const PointTally moving = sum_of(tally, true, whole_class);
            const PointTally still = sum_of(tally, false, whole_class);
            return Share{moving.removed, moving.removed + still.removed};
          }};
}

Column recall() {
  return {"recall", "Moving points that are removed, of all moving points.", Better::kHigher,
          "no point moves", [](const RemovalTally& tally) {
            return removed_share(sum_of(tally, true, whole_class));
          }};
}

Column residue() {
  return {"residue", "Kept points that move, of all kept points.", Better::kLower,
          "no point was kept", [](const RemovalTally& tally) {
            const PointTally moving = sum_of(tally, true, whole_class);
            const PointTally still = sum_of(tally, false, whole_class);
            return Share{moving.kept(), moving.kept() + still.kept()};
          }};
}

/// @param where "", or " [0-10 m]"
Column rejection(const std::string& where, const Part& part) {
  return {"rejection" + where, "Moving points that are removed" + where + ".", Better::kHigher,
          "no point moves there",
          [part](const RemovalTally& tally) { return removed_share(sum_of(tally, true, part)); }};
}

Column preservation(const std::string& where, const Part& part) {
  return {"preservation" + where, "Static points that are kept" + where + ".", Better::kHigher,
          "no static point is there",
          [part](const RemovalTally& tally) { return kept_share(sum_of(tally, false, part)); }};
}

struct Band {
  std::string name;
  Part part;
};

/// Range bands, then height bands.
const std::vector<Band>& bands() {
  static const std::vector<Band> all = [] {
    std::vector<Band> list;
    for (std::size_t i = 0; i < kRangeBands; ++i) {
      list.push_back({"range " + range_band_name(i),
                      [i](const ClassTally& tally) { return tally.by_range[i]; }});
    }
    for (std::size_t i = 0; i < kHeightBands; ++i) {
      list.push_back({"height " + height_band_name(i),
                      [i](const ClassTally& tally) { return tally.by_height[i]; }});
    }
    return list;
  }();
  return all;
}

Column class_column(std::uint16_t id, const std::string& where, bool moving, const Part& part) {
  const std::string reason = "no point of this class is there";
  const auto share = [id, moving, part](const RemovalTally& tally) {
    const auto found = tally.classes.find(id);
    const PointTally points = found == tally.classes.end() ? PointTally{} : part(found->second);
    return moving ? removed_share(points) : kept_share(points);
  };
  const std::string verb = moving ? "are removed" : "are kept";
  return {(moving ? "rejection [" : "preservation [") + where + "]",
          "Points [" + where + "] that " + verb + ".", Better::kHigher, reason, share};
}

std::vector<Column> make_general_columns() {
  std::vector<Column> columns = {precision(), recall(), residue(), rejection("", whole_class),
                                 preservation("", whole_class)};
  for (const Band& band : bands()) columns.push_back(rejection(" [" + band.name + "]", band.part));
  for (const Band& band : bands()) {
    columns.push_back(preservation(" [" + band.name + "]", band.part));
  }
  return columns;
}

}  // namespace

std::string ColumnName::text() const {
  std::string where = group;
  if (!axis.empty()) where += (group.empty() ? "" : ", ") + axis + " " + band;
  return where.empty() ? kind : kind + " [" + where + "]";
}

ColumnName parse_column_name(const std::string& name) {
  const std::size_t open = name.find(" [");
  ColumnName parts{name.substr(0, open)};
  if (open == std::string::npos) return parts;
  parts.group = name.substr(open + 2, name.size() - open - 3);
  for (const std::string axis : {"range", "height"}) {
    // Alone, or behind the class; a class may have any name.
    const std::size_t comma = parts.group.rfind(", " + axis + " ");
    const bool alone = parts.group.starts_with(axis + " ");
    if (!alone && comma == std::string::npos) continue;
    const std::size_t at = comma == std::string::npos ? 0 : comma + 2;
    parts.axis = axis;
    parts.band = parts.group.substr(at + axis.size() + 1);
    parts.group = comma == std::string::npos ? "" : parts.group.substr(0, comma);
    break;
  }
  return parts;
}

std::optional<double> Share::percent() const {
  if (whole == 0) return std::nullopt;
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

const std::vector<Column>& general_columns() {
  static const std::vector<Column> columns = make_general_columns();
  return columns;
}

std::vector<Column> class_columns(const RemovalTally& tally) {
  std::vector<Column> columns;
  for (const bool moving : {true, false}) {
    for (const auto& [id, of_class] : tally.classes) {
      if (of_class.moving != moving) continue;
      const std::string name = tally.label_rule.class_name(id);
      columns.push_back(class_column(id, name, moving, whole_class));
      for (const Band& band : bands()) {
        if (band.part(of_class).points == 0) continue;
        columns.push_back(class_column(id, name + ", " + band.name, moving, band.part));
      }
    }
  }
  return columns;
}

std::vector<ColumnValue> column_values(const RemovalTally& tally) {
  std::vector<ColumnValue> values;
  const auto add = [&](const std::vector<Column>& columns) {
    for (const Column& column : columns) {
      values.push_back({column.name, column.share(tally), column.undefined_reason});
    }
  };
  add(general_columns());
  add(class_columns(tally));
  return values;
}

}  // namespace raymoval
