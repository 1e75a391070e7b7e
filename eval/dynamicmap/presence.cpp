// SPDX-License-Identifier: MIT
#include "eval/dynamicmap/presence.h"

#include <algorithm>
#include <atomic>

#include "core/parallel.h"
#include "eval/nearby_points.h"

namespace raymoval::dynamicmap {
namespace {

/// Points of the truth that stay in memory, scan after scan.
struct Collected {
  std::vector<Eigen::Vector3d> points;  ///< World frame.
  std::vector<std::uint8_t> moving;
  std::vector<std::size_t> first;  ///< Of each scan, and the end.
};

Eigen::Vector3d placed(const Scan& scan, std::size_t point) {
  return scan.T_world_sensor * scan.points[point].cast<double>();
}

class Measurement {
 public:
  Measurement(const TruthPoints& truth, const MaskStore& masks, const Options& options)
      : truth_(truth), masks_(masks), options_(options), scans_(truth.input().scans->size()) {}

  std::vector<ScanPresence> run() {
    std::size_t points = 0;
    for (std::size_t i = 0; i < masks_.size(); ++i) points += masks_.point_count(i);
    const bool flagged_stay = 2 * masks_.removed_count() <= points;
    const Collected stay = collect(flagged_stay);
    const NearbyPoints<Eigen::Vector3d> near(stay.points, options_.distance);
    if (flagged_stay) {
      add_marked(stay, mark_near_kept(stay, near));
    } else {
      search_flagged(near);
    }
    return std::move(scans_);
  }

 private:
  /// Reads all scans once, counts what needs no search, and keeps the flagged or the kept points.
  Collected collect(bool flagged) {
    struct Part {
      std::vector<Eigen::Vector3d> points;
      std::vector<std::uint8_t> moving;
    };
    Collected all;
    all.first.push_back(0);
    begin("points that are gone");
    const auto batch = static_cast<std::size_t>(std::max(1, truth_.input().threads)) * 4;
    for (std::size_t first = 0; first < scans_.size(); first += batch) {
      std::vector<Part> parts(std::min(batch, scans_.size() - first));
      parallel_for(truth_.input().threads, parts.size(), 1, [&](std::size_t i) {
        ScanPresence& counts = scans_[first + i];
        const auto visit = [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
          if (kind == Kind::kStatic && !removed) ++counts.kept_static;
          if (kind == Kind::kDynamic && removed) ++counts.flagged_dynamic;
          if (flagged ? !(removed && is_truth(kind)) : !in_estimate(kind, removed)) return;
          parts[i].points.push_back(placed(scan, p));
          parts[i].moving.push_back(kind == Kind::kDynamic ? 1 : 0);
        };
        counts.points = truth_.read(first + i, &masks_, visit);
        advance();
      });
      for (const Part& part : parts) {
        all.points.insert(all.points.end(), part.points.begin(), part.points.end());
        all.moving.insert(all.moving.end(), part.moving.begin(), part.moving.end());
        all.first.push_back(all.points.size());
      }
    }
    end();
    for (ScanPresence& counts : scans_) {
      counts.present_static = counts.kept_static;
      counts.removed_dynamic = counts.flagged_dynamic;
    }
    return all;
  }

  /// For each flagged point whether a kept one is near. Threads only ever write a 1.
  std::vector<std::uint8_t> mark_near_kept(const Collected& flagged,
                                           const NearbyPoints<Eigen::Vector3d>& near) {
    std::vector<std::uint8_t> marks(flagged.points.size(), 0);
    if (marks.empty()) return marks;
    begin("points near kept ones");
    parallel_for(truth_.input().threads, scans_.size(), 1, [&](std::size_t i) {
      truth_.read(i, &masks_, [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
        if (!in_estimate(kind, removed)) return;
        near.visit(placed(scan, p), [&](std::uint32_t found) {
          std::atomic_ref<std::uint8_t>(marks[found]).store(1, std::memory_order_relaxed);
          return true;
        });
      });
      advance();
    });
    end();
    return marks;
  }

  void add_marked(const Collected& flagged, const std::vector<std::uint8_t>& marks) {
    for (std::size_t scan = 0; scan < scans_.size(); ++scan) {
      for (std::size_t i = flagged.first[scan]; i < flagged.first[scan + 1]; ++i) {
        if (marks[i] != 0) add_present(scans_[scan], flagged.moving[i] != 0);
      }
    }
  }

  void search_flagged(const NearbyPoints<Eigen::Vector3d>& kept) {
    begin("points near kept ones");
    parallel_for(truth_.input().threads, scans_.size(), 1, [&](std::size_t i) {
      truth_.read(i, &masks_, [&](std::size_t p, const Scan& scan, Kind kind, bool removed) {
        if (!removed || !is_truth(kind) || !kept.has_near(placed(scan, p))) return;
        add_present(scans_[i], kind == Kind::kDynamic);
      });
      advance();
    });
    end();
  }

  /// Whether a point stands in the map that is scored; its label is not looked at.
  [[nodiscard]] bool in_estimate(Kind kind, bool removed) const {
    return !removed && (is_truth(kind) || options_.ignored_in_estimate);
  }

  /// A flagged point that is there all the same.
  static void add_present(ScanPresence& counts, bool moving) {
    if (moving) {
      --counts.removed_dynamic;
    } else {
      ++counts.present_static;
    }
  }

  void begin(const char* task) const {
    if (truth_.input().progress != nullptr) truth_.input().progress->begin(task, scans_.size());
  }
  void advance() const {
    if (truth_.input().progress != nullptr) truth_.input().progress->advance();
  }
  void end() const {
    if (truth_.input().progress != nullptr) truth_.input().progress->end();
  }

  const TruthPoints& truth_;
  const MaskStore& masks_;
  const Options& options_;
  std::vector<ScanPresence> scans_;
};

}  // namespace

ScanPresence& ScanPresence::operator+=(const ScanPresence& other) {
  points += other.points;
  kept_static += other.kept_static;
  flagged_dynamic += other.flagged_dynamic;
  present_static += other.present_static;
  removed_dynamic += other.removed_dynamic;
  return *this;
}

std::vector<ScanPresence> presence_by_index(const TruthPoints& truth, const MaskStore& masks) {
  const EvaluationInput& input = truth.input();
  std::vector<ScanPresence> scans(input.scans->size());
  parallel_for(input.threads, scans.size(), 1, [&](std::size_t i) {
    ScanPresence& counts = scans[i];
    const auto visit = [&](std::size_t, const Scan&, Kind kind, bool removed) {
      if (kind == Kind::kStatic && !removed) ++counts.kept_static;
      if (kind == Kind::kDynamic && removed) ++counts.flagged_dynamic;
    };
    counts.points = truth.read(i, &masks, visit);
    counts.present_static = counts.kept_static;
    counts.removed_dynamic = counts.flagged_dynamic;
  });
  return scans;
}

std::vector<ScanPresence> measure_presence(const TruthPoints& truth, const MaskStore& masks,
                                           const Options& options) {
  return Measurement(truth, masks, options).run();
}

}  // namespace raymoval::dynamicmap
