// SPDX-License-Identifier: MIT
#include "datasets/bags/chunks/chunk_store.h"

#include <algorithm>

namespace raymoval {
namespace {

/// Chunks that are being unpacked count as nothing yet, so their number is limited, too.
constexpr std::size_t kMostChunks = 64;

}  // namespace

std::shared_ptr<ChunkStore::Slot> ChunkStore::slot_of(std::uint64_t number) {
  const std::scoped_lock lock(mutex_);
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const Kept& kept) { return kept.number == number; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
  } else {
    kept_.push_front({number, std::make_shared<Slot>(), 0});
    if (kept_.size() > kMostChunks) kept_.pop_back();
  }
  return kept_.front().slot;
}

void ChunkStore::note_size(std::uint64_t number, std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  std::size_t total = 0;
  for (auto kept = kept_.begin(); kept != kept_.end();) {
    if (kept->number == number) kept->bytes = bytes;
    total += kept->bytes;
    const bool drop = total > most_bytes_ && kept != kept_.begin() && kept->bytes > 0;
    if (drop) total -= kept->bytes;
    kept = drop ? kept_.erase(kept) : std::next(kept);
  }
}

ChunkStore::Chunk ChunkStore::get(std::uint64_t number, const Unpack& unpack) {
  const std::shared_ptr<Slot> slot = slot_of(number);
  const std::scoped_lock unpacking(slot->unpacking);
  if (!slot->chunk) {
    slot->chunk = std::make_shared<const std::string>(unpack());
    note_size(number, slot->chunk->size());
  }
  return slot->chunk;
}

}  // namespace raymoval
