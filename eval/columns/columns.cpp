// SPDX-License-Identifier: MIT
#include "eval/columns/columns.h"

#include <set>
#include <utility>

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

/// Tenths of the scans.
std::vector<Band> time_bands() {
  std::vector<Band> list;
  for (std::size_t i = 0; i < kTimeBands; ++i) {
    list.push_back(
        {"time " + time_band_name(i), [i](const ClassTally& tally) { return tally.by_time[i]; }});
  }
  return list;
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
  std::vector<Band> all = bands();
  for (Band& band : time_bands()) all.push_back(std::move(band));
  for (const Band& band : all) columns.push_back(rejection(" [" + band.name + "]", band.part));
  for (const Band& band : all) columns.push_back(preservation(" [" + band.name + "]", band.part));
  return columns;
}

/// The objects that are large enough: parked ones, or moving ones.
std::vector<PointTally> objects_of(const RemovalTally& tally, bool moving) {
  std::set<std::pair<std::uint16_t, std::string>> known;  // Instance and class.
  for (const auto& [word, points] : tally.objects) {
    known.emplace(instance_id(word), tally.label_rule.class_name(semantic_id(word)));
  }
  std::vector<PointTally> objects;
  for (const auto& [word, points] : tally.objects) {
    if (points.points < kFewestObjectPoints) continue;
    if ((tally.label_rule.classify(word) == LabelClass::kMoving) != moving) continue;
    const std::string when_moving = "moving-" + tally.label_rule.class_name(semantic_id(word));
    if (moving || known.count({instance_id(word), when_moving}) == 0) objects.push_back(points);
  }
  return objects;
}

Share mean_kept(const std::vector<PointTally>& objects) {
  constexpr std::int64_t kMillion = 1'000'000;
  Share mean;
  for (const PointTally& object : objects) {
    mean.part += (kMillion * object.kept() + object.points / 2) / object.points;
    mean.whole += kMillion;
  }
  return mean;
}

Share worst_kept(const std::vector<PointTally>& objects) {
  Share worst;
  for (const PointTally& object : objects) {
    const Share kept = kept_share(object);
    if (worst.whole == 0 || *kept.percent() < *worst.percent()) worst = kept;
  }
  return worst;
}

/// The objects of which `part` is a share of at least `kWholeObject`.
Share whole_objects(const std::vector<PointTally>& objects,
                    std::int64_t (*part)(const PointTally& object)) {
  Share whole{0, static_cast<std::int64_t>(objects.size())};
  for (const PointTally& object : objects) {
    const auto least = kWholeObject * static_cast<double>(object.points);
    if (static_cast<double>(part(object)) >= least) ++whole.part;
  }
  return whole;
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
  for (const std::string axis : {"range", "height", "time"}) {
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

std::vector<Column> object_columns(const RemovalTally& tally) {
  std::vector<Column> columns;
  if (!objects_of(tally, false).empty()) {
    const std::string reason = "there is no parked object";
    columns = {
        {kParked, "Points of a parked object that are kept, mean over objects.", Better::kHigher,
         reason, [](const RemovalTally& all) { return mean_kept(objects_of(all, false)); }},
        {kWorstParked, "Points kept of the parked object that loses most.", Better::kHigher, reason,
         [](const RemovalTally& all) { return worst_kept(objects_of(all, false)); }},
        {"parked below 95 %", "Parked objects of which less than 95 % is kept.", Better::kLower,
         reason, [](const RemovalTally& all) {
           Share below = whole_objects(objects_of(all, false),
                                       [](const PointTally& object) { return object.kept(); });
           below.part = below.whole - below.part;
           return below;
         }}};
  }
  if (!objects_of(tally, true).empty()) {
    columns.push_back({kTrails, "Moving objects of which at least 95 % is removed.",
                       Better::kHigher, "there is no moving object", [](const RemovalTally& all) {
                         return whole_objects(objects_of(all, true), [](const PointTally& object) {
                           return object.removed;
                         });
                       }});
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
  add(object_columns(tally));
  add(class_columns(tally));
  return values;
}

}  // namespace raymoval
