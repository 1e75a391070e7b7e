// SPDX-License-Identifier: MIT
#include "datasets/reading/loading_ahead.h"

#include <sched.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace raymoval {
namespace {

/// Lets the calling thread run only where a processor would be idle. It is only a courtesy.
void yield_to_everybody() {
  const sched_param none{};
  (void)::sched_setscheduler(0, SCHED_IDLE, &none);
}

}  // namespace

LoadingAhead::~LoadingAhead() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  if (loader_.joinable()) loader_.join();
}

std::size_t LoadingAhead::used() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

Scan LoadingAhead::load(std::size_t index) const {
  std::optional<Loaded> loaded;
  {
    Lock lock(mutex_);
    if (std::this_thread::get_id() != owner_) {
      last_.reset();
    } else {
      wish_after(index);
      loaded = take(index, lock);
    }
  }
  if (!loaded) return source_.load(index);
  if (loaded->error) std::rethrow_exception(loaded->error);
  return std::move(loaded->scan);
}

void LoadingAhead::wish_after(std::size_t index) const {
  const auto at = static_cast<std::ptrdiff_t>(index);
  const std::ptrdiff_t step = last_ ? at - static_cast<std::ptrdiff_t>(*last_) : 0;
  const bool is_even = step != 0 && step == std::exchange(step_, step);
  last_ = index;
  wishes_.clear();
  if (is_even) {
    for (std::size_t i = 1; i <= kScansAhead; ++i) {
      const std::ptrdiff_t next = at + static_cast<std::ptrdiff_t>(i) * step;
      if (next < 0 || next >= static_cast<std::ptrdiff_t>(size())) break;
      wishes_.push_back(static_cast<std::size_t>(next));
    }
  }
  // What is neither asked for nor wished for any more came from a wrong guess.
  std::erase_if(loaded_, [&](const auto& one) {
    return one.first != index &&
           std::find(wishes_.begin(), wishes_.end(), one.first) == wishes_.end();
  });
  std::erase_if(wishes_, [&](std::size_t one) { return one == loading_ || loaded_.contains(one); });
  if (wishes_.empty()) return;
  start_loader();
  changed_.notify_all();
}

std::optional<LoadingAhead::Loaded> LoadingAhead::take(std::size_t index, Lock& lock) const {
  is_waited_for_ = true;
  changed_.wait_for(lock, patience_, [&] { return loading_ != index; });
  is_waited_for_ = false;
  const auto found = loaded_.find(index);
  if (found == loaded_.end()) return std::nullopt;
  Loaded taken = std::move(found->second);
  loaded_.erase(found);
  ++used_;
  return taken;
}

void LoadingAhead::start_loader() const {
  if (std::exchange(has_loader_, true)) return;
  try {
    loader_ = std::thread([this] { load_wishes(); });
  } catch (const std::system_error&) {
    // It goes without: the owner loads what it asks for.
  }
}

void LoadingAhead::load_wishes() const {
  yield_to_everybody();
  Lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_ending_ || !wishes_.empty(); });
    if (is_ending_) return;
    const std::size_t index = wishes_.front();
    wishes_.pop_front();
    loading_ = index;
    lock.unlock();
    Loaded loaded;
    try {
      loaded.scan = source_.load(index);
    } catch (...) {
      loaded.error = std::current_exception();
    }
    lock.lock();
    loading_.reset();
    // Then the owner has waited in vain, and has loaded it itself.
    const bool is_late = last_ == index && !is_waited_for_;
    if (!is_late) loaded_[index] = std::move(loaded);
    changed_.notify_all();
  }
}

}  // namespace raymoval
