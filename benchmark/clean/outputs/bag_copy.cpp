// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/bag_copy.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/descriptor_io.h"
#include "core/files/part_name.h"
#include "core/scan/packed_mask.h"
#include "datasets/bags/messages/cut_points.h"
#include "datasets/bags/rewriting/rewrite_bag.h"

namespace raymoval {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what) {
  throw DataError(path.string() + ": the file for masks beside it " + what + " (" +
                  std::generic_category().message(errno) +
                  "). Nothing was changed; free space or choose another place for --scans.");
}

}  // namespace

const BagScanSource* bag_source(const Sequence& sequence) {
  return dynamic_cast<const BagScanSource*>(sequence.records.get());
}

void check_bag_copy(const Sequence& sequence, const std::filesystem::path& path) {
  check_rewriting(bag_source(sequence)->bag().path(), path);
}

BagCopy::BagCopy(const std::filesystem::path& path, const Sequence& sequence,
                 const std::atomic<bool>& cancel)
    : path_(path), source_(*bag_source(sequence)), cancel_(cancel) {
  check_bag_copy(sequence, path);
  Part part = new_part_file(path, 0600);
  if (!part.held.valid()) fail(path_, "cannot be made");
  bits_ = std::move(part.held);
  ::unlink(part.place.c_str());  // It lives as long as it is open, however the program ends.
}

void BagCopy::add(const CleanedScan& scan) {
  Mask keep(scan.scan.stored_point_count, 0);
  for (std::size_t i = 0; i < scan.mask.size(); ++i) {
    if (scan.mask[i] == 0) keep[scan.scan.stored_position(i)] = 1;
  }
  const std::string bits = packed_mask(keep);
  if (!write_at(bits_.get(), bits, size_)) fail(path_, "cannot be written");
  kept_.push_back({source_.message(scan.scan.index), size_, keep.size()});
  size_ += bits.size();
}

void BagCopy::finish() {
  std::sort(kept_.begin(), kept_.end(),
            [](const Kept& a, const Kept& b) { return a.message < b.message; });
}

std::vector<std::uint8_t> BagCopy::kept_points(const Kept& kept) const {
  const std::size_t bytes = (kept.points + 7) / 8;
  const std::string bits = read_at(bits_.get(), bytes, kept.offset);
  if (bits.size() < bytes) fail(path_, "cannot be read");
  return unpacked_mask(bits, kept.points);
}

void BagCopy::commit_with(Replacements& together) {
  const Bag& bag = source_.bag();
  const BagTopic& points = bag.topics()[source_.topic()];
  const auto change = [&](std::size_t topic, std::size_t index,
                          const std::string& message) -> std::optional<std::string> {
    if (cancel_) throw Cancelled();
    if (topic != source_.topic()) return message;
    const auto found =
        std::lower_bound(kept_.begin(), kept_.end(), index,
                         [](const Kept& kept, std::size_t at) { return kept.message < at; });
    if (found == kept_.end() || found->message != index) return message;
    return without_points(
        message, points.type, points.encoding, kept_points(*found),
        bag.path().string() + ": " + points.name + ", message " + std::to_string(index));
  };
  rewrite_bag(bag.path(), path_, change, &together);
}

}  // namespace raymoval
