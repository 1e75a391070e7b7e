// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace raymoval {

/// Provides workspaces, so that there is one per working thread and not one per scan.
template <class Workspace>
class Workspaces {
 public:
  using Make = std::function<std::unique_ptr<Workspace>()>;
  explicit Workspaces(Make make) : make_(std::move(make)) {}

  /// Calls `work(workspace)` with a workspace that no other thread uses meanwhile.
  template <class Work>
  void with_one(Work&& work) {
    std::unique_ptr<Workspace> workspace = borrow();
    work(*workspace);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

 private:
  std::unique_ptr<Workspace> borrow() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Workspace> workspace = std::move(idle_.back());
        idle_.pop_back();
        return workspace;
      }
    }
    return make_();
  }

  Make make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> idle_;
};

}  // namespace raymoval
