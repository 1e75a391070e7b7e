// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/scan/voxel_key.h"
#include "core/text.h"
#include "datasets/inspection/checks/checks.h"

namespace raymoval::inspection {
namespace {

using Words = std::vector<std::uint32_t>;

bool in_label_file(const Samples& samples, std::size_t scan) {
  return !samples.files().empty() && !samples.files()[scan].label_path.empty();
}

/// Words as stored, even if their number does not fit the scan.
Words stored_words(const Samples& samples, std::size_t scan) {
  if (in_label_file(samples, scan)) {
    const auto bytes = read_bytes(samples.files()[scan].label_path);
    Words words(bytes.size() / sizeof(std::uint32_t));
    if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * sizeof words[0]);
    return words;
  }
  const auto found = samples.scans().find(scan);
  if (found != samples.scans().end()) return samples.sequence().labels->labels(found->second);
  return samples.sequence().labels->labels(samples.sequence().scans->load(scan));
}

/// Whether the label file of a scan ends with a part of a label.
bool ends_in_part(const Samples& samples, std::size_t scan) {
  if (!in_label_file(samples, scan)) return false;
  return plain_file_size(samples.files()[scan].label_path) % sizeof(std::uint32_t) != 0;
}

/// How often close points have different labels, among pairs with a label that is not the most
/// common label of the scan; 0 = never. Labels of another scan are scattered in space.
double confusion(const Scan& scan, const Words& words) {
  constexpr double kCell = 0.4, kFar = 25.0;
  std::map<std::uint16_t, std::size_t> total;
  std::vector<std::pair<VoxelKey, std::uint16_t>> points;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const std::size_t stored = scan.stored_position(i);
    const Eigen::Vector3d p = scan.points[i].cast<double>();
    if (stored >= words.size() || p.norm() > kFar) continue;
    points.emplace_back(voxel_key(voxel_index(p, 1.0 / kCell)), semantic_id(words[stored]));
    ++total[points.back().second];
  }
  if (total.size() < 2) return 0.0;
  const auto by_count = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto common = std::max_element(total.begin(), total.end(), by_count)->first;
  std::sort(points.begin(), points.end());
  std::size_t looked_at = 0, odd = 0;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    std::size_t most = 0, run = 0;
    for (end = begin; end < points.size() && points[end].first == points[begin].first; ++end) {
      run = end > begin && points[end].second == points[end - 1].second ? run + 1 : 1;
      most = std::max(most, run);
    }
    if (most == end - begin && points[begin].second == common) continue;
    looked_at += end - begin;
    odd += end - begin - most;
  }
  return looked_at < 50 ? 0.0 : static_cast<double>(odd) / static_cast<double>(looked_at);
}

struct CountsSeen {
  std::size_t frames = 0, wrong = 0, first_wrong = 0;
  std::size_t labels = 0, points = 0;  ///< Of the first wrong scan.
  bool cut = false;                    ///< Its label file ends with a part of a label.
  std::size_t as_next = 0, as_previous = 0;
};

/// Compares label counts with the points of each scan and of its neighbours.
CountsSeen look_at_counts(const Samples& samples) {
  CountsSeen seen;
  std::map<std::size_t, std::size_t> points;
  for (const auto& [index, scan] : samples.scans()) points[index] = scan.stored_point_count;
  const auto fits = [&](std::size_t scan, std::size_t labels) {
    const auto found = points.find(scan);
    return found != points.end() && found->second == labels;
  };
  for (const auto& [index, count] : points) {
    const std::size_t labels = stored_words(samples, index).size();
    ++seen.frames;
    const bool cut = ends_in_part(samples, index);
    if (labels == count && !cut) continue;
    if (seen.wrong++ == 0) {
      seen.cut = cut;
      seen.first_wrong = index;
      seen.labels = labels;
      seen.points = count;
    }
    if (fits(index + 1, labels)) ++seen.as_next;
    if (index > 0 && fits(index - 1, labels)) ++seen.as_previous;
  }
  return seen;
}

/// Mean confusion of scans of pairs. @param shift -1, 1: labels of the scan before, after
double mean_confusion(const Samples& samples, int shift) {
  double sum = 0.0;
  std::size_t count = 0;
  std::set<std::size_t> done;
  for (const ScanPair& pair : samples.pairs()) {
    if (pair.to != pair.from + 1 || !done.insert(pair.from).second || done.size() > 4) continue;
    // In a pair of neighbours, each scan can use the labels of the other.
    const std::size_t scan = shift < 0 ? pair.to : pair.from;
    const std::size_t other = shift < 0 ? pair.from : (shift > 0 ? pair.to : pair.from);
    sum += confusion(samples.scans().at(scan), stored_words(samples, other));
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

std::string label_place(const Samples& samples, std::size_t scan) {
  return in_label_file(samples, scan)
             ? "labels/" + samples.files()[scan].label_path.filename().string()
             : "labels of " + samples.scan_name(scan);
}

bool has_words(const Samples& samples) {
  return samples.sequence().labels != nullptr && !samples.layout().labels_in_intensity;
}

Finding shifted_finding(const Samples& samples, bool next, const std::string& what) {
  return {.where = label_place(samples, 0) + " and the others",
          .what = fmt::format("labels of frame N belong to the scan {} it: {}",
                              next ? "after" : "before", what)};
}

std::vector<Finding> look_for_shift(Samples& samples) {
  constexpr double kClear = 0.05, kTimes = 1.5;
  if (!has_words(samples) || samples.size() < 2) return {};
  const CountsSeen counts = look_at_counts(samples);
  if (counts.wrong > 0) {
    const std::size_t most = std::max(counts.as_next, counts.as_previous);
    if (most < 2 || 3 * most < counts.wrong) return {};
    return {shifted_finding(
        samples, counts.as_next >= counts.as_previous,
        fmt::format("in {} of the {} scans whose count of labels is not their own it is that of "
                    "this neighbour (not every neighbour was read)",
                    grouped_text(most), grouped_text(counts.wrong)))};
  }
  const double given = mean_confusion(samples, 0);
  const double next = mean_confusion(samples, -1), previous = mean_confusion(samples, 1);
  samples.measures.emplace_back("label_confusion", given);
  samples.measures.emplace_back("label_confusion_of_scan_before", next);
  samples.measures.emplace_back("label_confusion_of_scan_after", previous);
  const double best = std::min(next, previous);
  if (given < best + kClear || given < kTimes * best) return {};
  return {shifted_finding(samples, next <= previous,
                          fmt::format("neighbouring points differ in label {} % of the time, and "
                                      "{} % with the labels moved by one frame",
                                      fixed_text(100.0 * given, 1), fixed_text(100.0 * best, 1)))};
}

std::vector<Finding> look_for_counts(Samples& samples) {
  if (!has_words(samples)) return {};
  const CountsSeen counts = look_at_counts(samples);
  if (counts.wrong == 0 || !look_for_shift(samples).empty()) return {};
  const std::string more =
      counts.wrong > 1 ? fmt::format("; the counts differ in {} of {} scans looked at",
                                     grouped_text(counts.wrong), grouped_text(counts.frames))
                       : "";
  return {{.where = label_place(samples, counts.first_wrong),
           .what = fmt::format("{} labels{} for {} points{}", grouped_text(counts.labels),
                               counts.cut ? " and a part of one" : "", grouped_text(counts.points),
                               more)}};
}

/// Intensity of up to three scans as stored.
std::vector<float> stored_intensity(const Samples& samples) {
  std::vector<float> all;
  const std::size_t last = samples.size() - 1;
  for (const std::size_t scan : std::set<std::size_t>{0, last / 2, last}) {
    if (samples.sequence().records != nullptr) {
      const PointRecords records = samples.sequence().records->records(scan);
      const PointField* intensity = records.layout.find(intensity_names());
      for (std::size_t i = 0; intensity != nullptr && i < records.size(); ++i) {
        all.push_back(static_cast<float>(records.value(i, *intensity)));
      }
    } else if (samples.scans().count(scan) > 0) {
      const std::vector<float>& values = samples.scans().at(scan).reflectance;
      all.insert(all.end(), values.begin(), values.end());
    }
  }
  return all;
}

/// Intensity has many values; labels are few whole numbers from a known list.
std::vector<Finding> look_for_values(Samples& samples) {
  if (samples.layout().labels_in_intensity && samples.sequence().labels != nullptr) return {};
  std::set<std::uint32_t> values;
  for (const float value : stored_intensity(samples)) {
    if (!(value >= 0.0F && value < 16777216.0F) || value != std::floor(value)) return {};
    const auto word = static_cast<std::uint32_t>(value);
    if (!semantickitti_class_names().contains(semantic_id(word))) return {};
    values.insert(word);
  }
  const bool zero_or_one = values == std::set<std::uint32_t>{0, 1};
  if (!zero_or_one && values.size() < 3) return {};
  std::vector<std::string> seen;
  for (const std::uint32_t value : values) {
    if (seen.size() < 6) seen.push_back(grouped_text(value));
  }
  const std::string remedy =
      samples.layout().labels_in_intensity
          ? fmt::format(
                "Give a label rule: \"labels\": {{\"moving\": [{}]}} in sequence.json (or "
                "--label-rule); without one there are no labels.",
                zero_or_one ? "1" : "252, 253, 254, 255, 256, 257, 258, 259")
          : "Write the labels to labels/NAME.label (uint32 a point) and the strength of the "
            "return, or 0, in their place: methods get intensity and must not get the labels.";
  return {{.where = "intensity of the scan files",
           .what = fmt::format("all values are labels ({}{})", join(seen),
                               values.size() > 6 ? ", ..." : ""),
           .remedy = remedy}};
}

}  // namespace

std::vector<Check> label_checks() {
  return {
      {"labels-shifted", "labels are those of the scan before or after",
       "labels/N.label with the labels of scan N", "Rename the label files by one frame.",
       look_for_shift, Consequence::kUnused},
      {"label-count", "a scan has more or fewer labels than points",
       "one label for each stored point",
       "Copy scan and labels again from one source, or move the label file away: scans without one "
       "are not scored.",
       look_for_counts, Consequence::kUnused},
      {"labels-in-intensity-by-value", "labels are stored in the intensity of the points",
       "the strength of the return", "Write the labels to labels/NAME.label.", look_for_values,
       Consequence::kUnused},
  };
}

}  // namespace raymoval::inspection
