// SPDX-License-Identifier: MIT
#include "benchmark/result/removals/removal_files.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "benchmark/result/removals/reasons.h"
#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "core/text.h"

namespace raymoval {
namespace {

static_assert(std::endian::native == std::endian::little, "label words are little-endian");

std::filesystem::path label_file(const std::filesystem::path& folder, const Scan& scan) {
  return folder / (scan.name + ".label");
}

Mask read_mask(const std::filesystem::path& path, const Scan& scan, LabelIds* found) {
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
                    " points of scan " + scan.name + "). It is cut off or of another scan.");
  }
  Mask mask(scan.size(), 0);
  for (std::size_t point = 0; point < scan.size(); ++point) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + scan.stored_position(point) * sizeof word, sizeof word);
    const std::uint16_t id = semantic_id(word);
    mask[point] = id >= kRemovedLabel && id <= kLastRemovedLabel ? 1 : 0;
    if (found != nullptr) found->set(id);
  }
  return mask;
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

/// What has to go before the folder can; a link goes alone.
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

/// Who gives the folder above that of the label files is told.
void check_level(const std::filesystem::path& folder, const Scan& scan) {
  if (has_file(label_file(folder, scan))) return;
  for (const char* below : {"labels", "predictions", "removals"}) {
    if (!has_file(label_file(folder / below, scan))) continue;
    throw DataError(folder.string() + ": holds no " + scan.name + ".label, but its folder " +
                    below + "/ does. Name that one.");
  }
}

}  // namespace

MaskStore read_removals(const std::filesystem::path& folder, const ScanSource& scans,
                        const std::function<void()>& after_scan, LabelIds* found) {
  if (!is_folder(folder)) {
    throw DataError(folder.string() + (is_there(folder) ? ": is no folder" : ": no such folder") +
                    "; expected one with a NNNNNN.label file for each scan.");
  }
  MaskStore masks(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan scan = scans.load(i);
    if (i == 0) check_level(folder, scan);
    masks.set(i, read_mask(label_file(folder, scan), scan, found));
    after_scan();
  }
  return masks;
}

bool has_removed_label(const LabelIds& ids) {
  for (std::size_t id = kRemovedLabel; id <= kLastRemovedLabel; ++id) {
    if (ids.test(id)) return true;
  }
  return false;
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
