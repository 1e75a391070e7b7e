// SPDX-License-Identifier: MIT
#include "benchmark/result/removals/removal_files.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

#include "benchmark/result/removals/reasons.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/text.h"
#include "datasets/clouds/frames.h"
#include "datasets/clouds/numpy/npy_head.h"
#include "datasets/records/number_types.h"

namespace raymoval {
namespace {

static_assert(std::endian::native == std::endian::little, "label words are little-endian");

std::filesystem::path label_file(const std::filesystem::path& folder, const Scan& scan) {
  return folder / (scan.name + ".label");
}

/// The words of a file of labels.
std::vector<std::uint32_t> label_words(const std::filesystem::path& path, const Scan& scan) {
  if (!has_file(path)) {
    throw DataError(path.string() +
                    ": missing; expected a label file for each of the sequence's "
                    "scans. Choose the frames that were predicted with --frames.");
  }
  const std::vector<std::byte> bytes = read_bytes(path);
  if (bytes.size() != scan.stored_point_count * sizeof(std::uint32_t)) {
    throw DataError(path.string() + ": " + grouped_text(bytes.size()) + " bytes, expected " +
                    grouped_text(scan.stored_point_count * sizeof(std::uint32_t)) +
                    " (one 32-bit word for each of the " + grouped_text(scan.stored_point_count) +
                    " points of scan " + scan.name +
                    "). It is truncated or belongs to another scan.");
  }
  std::vector<std::uint32_t> words(scan.stored_point_count);
  if (!bytes.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
  return words;
}

/// The label words of an array: whole numbers unchanged; of shares up to 1, 0.5 and more mean
/// removed.
std::vector<std::uint32_t> array_words(const std::filesystem::path& path, const Scan& scan) {
  const std::vector<std::byte> bytes = read_bytes(path);
  const RecordReading reading;
  const NpyHead head =
      npy_head({path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, reading});
  const bool plain = head.type.fields.size() == 1 && head.type.fields.front().field.count == 1;
  const std::size_t count = plain ? head.body.size() / head.type.bytes : 0;
  if (!plain || count != scan.stored_point_count) {
    throw DataError(path.string() + ": is an array of " + head.shape_text() +
                    "; expected a number for each of the " + grouped_text(scan.stored_point_count) +
                    " points of scan " + scan.name +
                    ": bool, whole numbers, or shares from 0 to 1.");
  }
  const NpyField& number = head.type.fields.front();
  const auto size = static_cast<std::size_t>(number.field.size);
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::string value(head.body.substr(i * size, size));
    if (number.big_endian) std::reverse(value.begin(), value.end());
    with_number_type(number.field.type, number.field.size, [&](auto zero) {
      std::memcpy(&zero, value.data(), sizeof zero);
      values[i] = static_cast<double>(zero);
    });
  }
  const bool shares = number.field.type == 'F' &&
                      std::ranges::none_of(values, [](double value) { return value > 1.0; });
  std::vector<std::uint32_t> words(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double value = std::clamp(std::isnan(values[i]) ? 0.0 : values[i], 0.0, 4294967295.0);
    words[i] = !shares        ? static_cast<std::uint32_t>(value)
               : value >= 0.5 ? kRemovedLabel
                              : kKeptLabel;
  }
  return words;
}

/// If the label files are in a folder below, the message names it. @throws DataError
void check_level(const std::filesystem::path& folder, const Scan& scan) {
  if (has_file(label_file(folder, scan))) return;
  for (const char* below : {"labels", "predictions", "removals"}) {
    if (!has_file(label_file(folder / below, scan))) continue;
    throw DataError(folder.string() + ": holds no " + scan.name + ".label, but its folder " +
                    below + "/ does. Name that one.");
  }
}

/// Reads masks in which the points with one of the ids `removed` are removed.
MaskStore read_masks(const std::filesystem::path& folder, const ScanSource& scans,
                     const LabelIds& removed, const std::function<void()>& after_scan,
                     PredictedIds& found) {
  MaskStore masks(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    if (i == 0) check_level(folder, scan);
    const std::filesystem::path array = folder / (scan.name + ".npy");
    const bool is_array = has_file(array);
    const auto words =
        is_array ? array_words(array, scan) : label_words(label_file(folder, scan), scan);
    Mask mask(scan.size(), 0);
    for (std::size_t point = 0; point < scan.size(); ++point) {
      const std::uint16_t id = semantic_id(words[scan.stored_position(point)]);
      mask[point] = removed.test(id) ? 1 : 0;
      found.ids.set(id);
    }
    found.arrays = found.arrays || is_array;
    masks.set(i, mask);
    after_scan();
  }
  return masks;
}

LabelIds ids_of(const std::vector<std::uint16_t>& list) {
  LabelIds ids;
  for (const std::uint16_t id : list) ids.set(id);
  return ids;
}

/// The labels that mean removed.
LabelIds removed_labels() {
  LabelIds ids;
  for (std::size_t id = kRemovedLabel; id <= kLastRemovedLabel; ++id) ids.set(id);
  return ids;
}

}  // namespace

void write_removal(const std::filesystem::path& folder, const Scan& scan, const Mask& mask) {
  std::vector<std::uint32_t> words(scan.stored_point_count, kLeftOutLabel);
  for (std::size_t point = 0; point < mask.size(); ++point) {
    if (mask[point] == kLeftOutMask) continue;
    words[scan.stored_position(point)] = mask[point] != 0 ? kRemovedLabel : kKeptLabel;
  }
  write_atomically(label_file(folder, scan), {reinterpret_cast<const char*>(words.data()),
                                              words.size() * sizeof(std::uint32_t)});
}

void write_removals(const std::filesystem::path& folder, const ScanSource& scans,
                    const MaskStore& masks, const std::function<void()>& after_scan) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw DataError(folder.string() + ": cannot be made (" + error.message() +
                    "). Choose another folder.");
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    write_removal(folder, scans.load(i), masks.get(i));
    after_scan();
  }
}

namespace {

/// Whether a run writes files of this name into a folder of removals.
bool is_removals_file(const std::filesystem::path& entry) {
  const std::filesystem::path name = is_part_name(entry) ? name_of_part(entry) : entry.filename();
  return name.extension() == ".label" || is_reason_file(name);
}

/// The entries that must be removed before the folder; none for a link, of which only the link is
/// removed.
std::vector<std::filesystem::path> content_of(const std::filesystem::path& folder) {
  if (is_link(folder) || !has_folder(folder)) return {};
  return entries_of(folder);
}

}  // namespace

bool can_remove_removals(const std::filesystem::path& folder) {
  return std::ranges::all_of(content_of(folder), is_removals_file);
}

bool remove_removals(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> content = content_of(folder);
  if (!std::ranges::all_of(content, is_removals_file)) return false;
  for (const std::filesystem::path& entry : content) remove_if_there(entry);
  remove_if_there(folder);
  return true;
}

namespace {

void check_folder(const std::filesystem::path& folder) {
  if (!is_folder(folder)) {
    throw DataError(folder.string() +
                    (is_there(folder) ? ": is not a folder" : ": no such folder") +
                    "; expected one with a NNNNNN.label file for each scan.");
  }
}

/// The ids that mean removed in predictions without the labels 251 to 259; none if no rule applies.
/// @param note is set to the reason
LabelIds other_removed_ids(const PredictedIds& found, const LabelRule& rule, std::string& note) {
  const LabelIds small = found.ids & ~ids_of({0, 1, 2});
  const LabelIds by_rule = ids_of(rule.moving) & found.ids;
  if (by_rule.any()) {
    note = "the predictions are read by the label rule " + rule.name + ": " +
           label_ids_text(by_rule) + " means removed.";
    return by_rule;
  }
  if (small.any()) return {};
  if (found.ids.test(2)) {
    note =
        "the predictions are read as the learning ids of MOS benchmarks: 2 means removed, 1 and "
        "0 kept.";
    return ids_of({2});
  }
  if (!found.arrays || !found.ids.test(1)) return {};
  note = "the predictions are read as masks: 1 means removed, 0 kept.";
  return ids_of({1});
}

}  // namespace

MaskStore read_removals(const std::filesystem::path& folder, const ScanSource& scans,
                        const std::function<void()>& after_scan) {
  check_folder(folder);
  PredictedIds found;
  return read_masks(folder, scans, removed_labels(), after_scan, found);
}

Predictions read_predictions(const std::filesystem::path& folder, const ScanSource& scans,
                             const LabelRule& rule, const std::function<void()>& after_scan) {
  check_folder(folder);
  Predictions read;
  read.masks = read_masks(folder, scans, removed_labels(), after_scan, read.found);
  if ((read.found.ids & removed_labels()).any()) return read;
  const LabelIds removed = other_removed_ids(read.found, rule, read.note);
  if (removed.none()) return read;
  PredictedIds again;
  read.masks = read_masks(
      folder, scans, removed, [] {}, again);
  return read;
}

std::filesystem::path prediction_folder(const std::filesystem::path& folder,
                                        const std::string& sequence) {
  const std::filesystem::path all = folder / "sequences";
  if (!has_folder(all)) return folder;
  const std::vector<std::filesystem::path> there = folders_in(all);
  const bool named = has_folder(all / sequence);
  if (!named && there.size() != 1) {
    throw DataError(all.string() + ": has " + content_text(all) + ", and none for sequence " +
                    sequence + "; expected sequences/" + sequence +
                    "/predictions. Name the folder with the files.");
  }
  const std::filesystem::path one = named ? all / sequence : there.front();
  return has_folder(one / "predictions") ? one / "predictions" : one;
}

std::string label_ids_text(const LabelIds& ids) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> texts;
  for (std::size_t id = 0; id < ids.size() && texts.size() < kMost; ++id) {
    if (ids.test(id)) texts.push_back(std::to_string(id));
  }
  const std::size_t more = ids.count() - texts.size();
  return join(texts) + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

}  // namespace raymoval
