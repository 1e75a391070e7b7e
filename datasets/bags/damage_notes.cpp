// SPDX-License-Identifier: MIT
#include "datasets/bags/damage_notes.h"

#include <algorithm>
#include <utility>

#include "core/text.h"

namespace raymoval {

void DamageNotes::add(std::string sentence) {
  const std::lock_guard lock(mutex_);
  if (std::find(kept_.begin(), kept_.end(), sentence) != kept_.end()) return;
  if (kept_.size() < kMost) {
    kept_.push_back(std::move(sentence));
  } else {
    ++more_;
  }
}

std::vector<std::string> DamageNotes::sentences() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all = kept_;
  if (more_ > 0) {
    all.push_back("Further damage was found in " + counted_text(more_, "place") +
                  ", not listed here.");
  }
  return all;
}

bool DamageNotes::empty() const {
  const std::lock_guard lock(mutex_);
  return kept_.empty();
}

}  // namespace raymoval
