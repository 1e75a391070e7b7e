// SPDX-License-Identifier: MIT
#include "benchmark/result/removals/edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "benchmark/result/removals/removal_files.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/scan/voxel_key.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr int kEditsVersion = 1;

class MaskLabels : public LabelSource {
 public:
  explicit MaskLabels(MaskStore masks) : masks_(std::move(masks)) {}
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    const Mask mask = masks_.get(scan.index);
    std::vector<std::uint32_t> words(mask.size());
    std::transform(mask.begin(), mask.end(), words.begin(),
                   [](std::uint8_t removed) { return removed != 0 ? kRemovedLabel : kKeptLabel; });
    return words;
  }

 private:
  MaskStore masks_;
};

/// The removals as a mask. @throws ConfigurationError if runs are not ascending within the scan
Mask mask_of(const ReviewedScan& scan, const std::string& where) {
  Mask mask(scan.points, 0);
  std::uint64_t end = 0;
  for (std::size_t i = 0; i + 1 < scan.runs.size(); i += 2) {
    const std::uint64_t first = scan.runs[i], count = scan.runs[i + 1];
    if (first < end || count == 0 || first > scan.points || count > scan.points - first) {
      throw ConfigurationError(fmt::format(
          "{}: scan {}: the run of {} points from point {} does not follow the run before it, or "
          "exceeds the scan's {} points. Export the edits again.",
          where, scan.name, count, first, scan.points));
    }
    end = first + count;
    std::fill(mask.begin() + static_cast<std::ptrdiff_t>(first),
              mask.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{1});
  }
  return mask;
}

/// Whole numbers from `least` to `most`. @throws std::range_error
template <class Number>
std::vector<Number> whole_numbers(const nlohmann::json& list, std::int64_t least,
                                  std::int64_t most) {
  std::vector<Number> numbers;
  for (const nlohmann::json& entry : list) {
    const std::int64_t number = entry.is_number_integer() ? entry.get<std::int64_t>() : least - 1;
    if (number < least || number > most) {
      throw std::range_error(
          fmt::format("{} is no whole number from {} to {}", entry.dump(), least, most));
    }
    numbers.push_back(static_cast<Number>(number));
  }
  return numbers;
}

Edits::Cells cells_of(const nlohmann::json& list, bool with_scan) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  Edits::Cells cells;
  for (const nlohmann::json& entry : list) {
    std::vector<std::int32_t> numbers = whole_numbers<std::int32_t>(entry, -kMost, kMost);
    if (!with_scan) numbers.insert(numbers.begin(), -1);
    if (numbers.size() != 4) {
      throw std::range_error(
          fmt::format("{} is no cell ({} numbers)", entry.dump(), with_scan ? "scan and 3" : "3"));
    }
    cells.insert({numbers[0], numbers[1], numbers[2], numbers[3]});
  }
  return cells;
}

Edits edits_of(const nlohmann::json& content) {
  Edits edits;
  content.at("sequence").get_to(edits.sequence);
  content.at("method").get_to(edits.method);
  const auto sizes = whole_numbers<int>(
      nlohmann::json::array({content.at("removed_cell"), content.at("kept_cell")}), 1, 1 << 30);
  edits.removed_cell = sizes[0];
  edits.kept_cell = sizes[1];
  const auto turn = content.at("turn").get<std::array<double, 9>>();
  for (int i = 0; i < 9; ++i) edits.R_upright_world(i / 3, i % 3) = turn[i];
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  for (const nlohmann::json& scan : content.at("scans")) {
    const auto points = nlohmann::json::array({scan.at("points")});
    edits.scans.push_back({scan.at("name").get<std::string>(),
                           whole_numbers<std::uint64_t>(points, 0, kMost).front(),
                           scan.at("digest").get<std::string>(),
                           whole_numbers<std::uint64_t>(scan.at("removed"), 0, kMost)});
  }
  edits.keep = cells_of(content.at("keep"), true);
  edits.remove = cells_of(content.at("remove"), false);
  return edits;
}

/// Changes the mask of a scan by the corrections.
void correct(const Edits& edits, const Scan& scan, Mask& mask, EditedMasks& result) {
  const auto index = static_cast<std::int32_t>(scan.index);
  if (edits.keep.empty() && edits.remove.empty()) return;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const bool was_removed = mask[i] != 0;
    if ((was_removed ? edits.keep : edits.remove).empty()) continue;
    const Eigen::Vector3d world = scan.T_world_sensor * scan.points[i].cast<double>();
    const auto [x, y, z] = map_cell(map_steps(edits.R_upright_world * world),
                                    was_removed ? edits.removed_cell : edits.kept_cell);
    if (was_removed && edits.keep.contains({index, x, y, z})) {
      mask[i] = 0;
      ++result.kept;
    } else if (!was_removed && edits.remove.contains({-1, x, y, z})) {
      mask[i] = 1;
      ++result.removed;
    }
  }
}

}  // namespace

MapSteps map_steps(const Eigen::Vector3d& upright) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max() - kStepsPerVoxel;
  MapSteps steps{};
  for (int axis = 0; axis < 3; ++axis) {
    const double place = upright[axis] * (1.0 / kPageVoxel);
    const double voxel = std::floor(place);
    const double inside = upright[axis] / kPageVoxel - voxel;
    const double step =
        std::clamp(std::floor(inside * kStepsPerVoxel), 0.0, double{kStepsPerVoxel - 1});
    const double steps_from_zero = voxel * kStepsPerVoxel + step;
    if (!(std::abs(steps_from_zero) <= kMost)) {
      throw_voxel_out_of_range(upright.x(), upright.y(), upright.z(), kPageVoxel);
    }
    steps[axis] = static_cast<std::int32_t>(steps_from_zero);
  }
  return steps;
}

MapSteps map_cell(const MapSteps& steps, int edge) {
  const auto divided = [edge](std::int32_t value) {
    const std::int32_t quotient = value / edge;
    return value % edge < 0 ? quotient - 1 : quotient;
  };
  return {divided(steps[0]), divided(steps[1]), divided(steps[2])};
}

std::size_t Edits::CellHash::operator()(const ScanCell& cell) const {
  std::uint64_t hash = 0;
  for (const std::int32_t number : cell) {
    hash = VoxelKeyHash{}(hash * 0x9E3779B97F4A7C15ULL + static_cast<std::uint32_t>(number));
  }
  return hash;
}

ReviewedScan reviewed_scan(const Scan& scan, const Mask& mask) {
  ContentHasher hasher;
  const Eigen::Matrix4d pose = scan.T_world_sensor.matrix();
  hasher.add(pose.data(), sizeof(double) * 16);
  hasher.add(scan.points.data(), sizeof(Eigen::Vector3f) * scan.points.size());
  ReviewedScan reviewed{scan.name, scan.size(), hasher.digest().substr(0, 16), {}};
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 1) continue;
    if (i > 0 && mask[i - 1] == 1) {
      ++reviewed.runs.back();
    } else {
      reviewed.runs.insert(reviewed.runs.end(), {i, 1});
    }
  }
  return reviewed;
}

nlohmann::ordered_json to_json(const Edits& edits) {
  nlohmann::ordered_json content;
  content["raymoval_edits"] = kEditsVersion;
  content["made_by"] = "raymoval " RAYMOVAL_VERSION;
  content["sequence"] = edits.sequence;
  content["method"] = edits.method;
  content["step_m"] = kPageVoxel / kStepsPerVoxel;
  content["removed_cell"] = edits.removed_cell;
  content["kept_cell"] = edits.kept_cell;
  for (int i = 0; i < 9; ++i) content["turn"].push_back(edits.R_upright_world(i / 3, i % 3));
  content["scans"] = nlohmann::ordered_json::array();
  for (const ReviewedScan& scan : edits.scans) {
    content["scans"].push_back({{"name", scan.name},
                                {"points", scan.points},
                                {"digest", scan.digest},
                                {"removed", scan.runs}});
  }
  return content;
}

Edits read_edits(const std::filesystem::path& path) {
  const nlohmann::json content = read_json(path);
  const char* remedy =
      "Export the file with \"Export edits\" in the page of `raymoval clean --html`.";
  if (!content.is_object() || !content.contains("raymoval_edits")) {
    throw ConfigurationError(path.string() + ": is not a file of edits. " + remedy);
  }
  if (content["raymoval_edits"] != kEditsVersion) {
    throw ConfigurationError(fmt::format("{}: has version {} of the format; expected {}. {}",
                                         path.string(), content["raymoval_edits"].dump(),
                                         kEditsVersion, remedy));
  }
  try {
    return edits_of(content);
  } catch (const nlohmann::json::exception& error) {
    throw ConfigurationError(fmt::format("{}: {}. {}", path.string(), error.what(), remedy));
  } catch (const std::range_error& error) {
    throw ConfigurationError(fmt::format("{}: {}. {}", path.string(), error.what(), remedy));
  }
}

EditedMasks apply_edits(const Edits& edits, const ScanSource& scans, const std::string& where,
                        bool force, const std::function<void()>& after_scan) {
  const std::string remedy =
      "Choose the data, --frames and other reading options of the review, or review the map again";
  if (scans.size() != edits.scans.size()) {
    throw DataError(fmt::format("{}: the edits are for {} of {}, but there are {}. {}.", where,
                                counted_text(edits.scans.size(), "scan"), edits.sequence,
                                grouped_text(scans.size()), remedy));
  }
  EditedMasks result{MaskStore(scans.size())};
  std::string first;
  bool can_force = true;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    const ReviewedScan& reviewed = edits.scans[i];
    const bool fits = scan.size() == reviewed.points;
    Mask mask = fits ? mask_of(reviewed, where) : Mask(scan.size(), 0);
    if (!fits || reviewed_scan(scan, {}).digest != reviewed.digest) {
      ++result.changed_scans;
      can_force = can_force && fits;
      if (first.empty()) first = scan.name;
    }
    correct(edits, scan, mask, result);
    result.masks.set(i, mask);
    after_scan();
  }
  if (result.changed_scans == 0 || (force && can_force)) return result;
  throw DataError(fmt::format(
      "{}: the data has changed since the review: {} of {} have another pose or other points "
      "(first: {}). {}{}.",
      where, result.changed_scans, counted_text(scans.size(), "scan"), first, remedy,
      can_force ? "; --force applies the edits by the numbers of the points" : ""));
}

std::shared_ptr<const LabelSource> labels_of_masks(MaskStore masks) {
  return std::make_shared<MaskLabels>(std::move(masks));
}

}  // namespace raymoval
