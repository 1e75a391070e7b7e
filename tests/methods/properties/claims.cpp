// SPDX-License-Identifier: MIT
#include "tests/methods/properties/claims.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "methods/registry.h"

namespace raymoval::toy {
namespace {

// A variant without a line has only the claims of all: an online method answers each scan the same
// if the last scans are left out. The columns: an empty scan at the end, one between, a scan in two
// halves, points in another order, points doubled, the world moved, the last scans left out, scans
// in another order, a scan given twice. = the same answer, ~ the same except for rounding,
// + more may be removed, - more may be kept, ? anything.
struct Line {
  std::string_view variant, about;
};

constexpr std::string_view kOffline = "? ? ? ? ? ? ? ? ?";
constexpr std::string_view kOnline = "? ? ? ? ? ? = ? ?";

constexpr Line kLines[] = {
    {"noop:default", "= = = = = = = = ="},
    {"remove-all:default", "= = = = = = = = ="},

    // Bins hold least ranges and maps hold sets of voxels, so the order of points is nothing. What
    // a scan sees through depends on its own returns beside the ray, and a cluster on how many
    // points it has: halves and doubled points count. Scans are taken in turn, and what one erases
    // is gone for the next.
    {"raymoval:offline", "= = ? = ? = ? ? ?"},
    {"raymoval:online", "= = ? = ? = = ? ?"},
    {"raymoval:table1", "= = ? = ? = ? ? ?"},
    {"raymoval:table1-online", "= = ? = ? = = ? ?"},

    // First and last passes, gaps of tracks and kept scans count scans, empty ones too. Means and
    // deviations of voxels and of objects are sums, which round, and parts of cells lie otherwise
    // in a world that is turned.
    {"raymoval_plus:offline", "= ? ? ~ ? ~ ? ? ?"},
    {"raymoval_plus:online", "= ? ? ~ ? ~ = ? ?"},
    {"raymoval_plus:online-lag", "= ? ? ~ ? ~ = ? ?"},
    {"raymoval_plus:online-map", "= ? ? ~ ? ~ ? ? ?"},

    // A scan is a set of cells, hit or crossed once. Clamping makes the order of scans count. The
    // ground plane and the outliers come from the list of points.
    {"octomap:r20", "= = ? = = = ? ? ?"},
    {"octomap:r05", "= = ? = = = ? ? ?"},
    {"octomap:kth", "= = ? = = = ? ? ?"},
    {"octomap:ground", "= = ? ? ? = ? ? ?"},
    {"octomap:ground-noise", "= = ? ? ? = ? ? ?"},

    // A voxel is freed by a single beam of a scan that has no point in it, for good. Without
    // normals a beam does not depend on other points. Whole scans, not voxels, lose the points near
    // a freed voxel, unless subvoxel_accuracy is off.
    {"peopleremover:normals", "= = ? ~ ? = - = ="},
    {"peopleremover:fine", "= = ? ~ ? = - = ="},
    {"peopleremover:none", "= = ? = = = - = ="},
    {"peopleremover:plain", "= = + = = = - = ="},

    // A single scan removes a map point that it sees behind, and half a scan sees at least as far.
    // The map's points are means of all points in a cell, which other points shift, in single
    // precision.
    {"removert:rm3", "= = + ~ ? ~ ? ~ ?"},
    {"removert:rm3-rv1", "= = ? ~ ? ~ ? ~ ?"},
    {"removert:code", "= = + ~ ? ~ ? ~ ?"},
    {"removert:port", "= = + ~ ? ~ ? ~ ?"},

    // Every n-th scan is a query, so that empty scans count, except for n = 1.
    {"erasor:general", "= ? ? ~ ? = ? ? ?"},
    {"erasor:kitti00", "= ? ? ~ ? = ? ? ?"},
    {"erasor:kitti01", "= = ? ~ ? = ? ? ?"},
    {"erasor:kitti02", "= ? ? ~ ? = ? ? ?"},
    {"erasor:kitti05", "= ? ? ~ ? = ? ? ?"},
    {"erasor:kitti07", "= ? ? ~ ? = ? ? ?"},
    {"erasor:fine", "= ? ? ~ ? = ? ? ?"},
    {"erasor:version2", "= ? ? ~ ? = ? ? ?"},
    {"erasor:auto", "= ? ? ~ ? = ? ? ?"},

    // Voids are united over scans, and a scan is a set of voxels. The points of one half do not
    // protect their voxels from the beams of the other half, and each half has fewer neighbours.
    {"dufomap:offline", "= = ? = = = - = ="},
    {"dufomap:online", "= = ? = = = = ? ="},
    {"dufomap:offline-dp2", "= = ? = = = - = ="},
    {"dufomap:online-dp2", "= = ? = = = = ? ="},

    // The map and a scan are sets of slices, but the ground's share counts points.
    {"beautymap:published", "= = ? = ? ? ? = ?"},
    {"beautymap:semi-indoor", "= = ? = ? ? ? = ?"},
    {"beautymap:sound", "= = ? = ? ? ? = ?"},
    {"beautymap:wide", "= = ? = ? ? ? = ?"},

    // A scan is a set of sub-voxels with the mean points of its voxels, and is counted. The blocks
    // that are skipped lie on a lattice of their own.
    {"freedom:published", "= = ? = = = ? ? ?"},
    {"freedom:few-counts", "= = ? = = = ? ? ?"},

    // A scan is a set of voxels, and scans are taken in turn. An empty one is the scan before of
    // the next. The public lattice is cut off towards the origin.
    {"hmm_mos:published", "= ? ? = = ? = ? ?"},
    {"hmm_mos:fine", "= ? ? = = ? = ? ?"},
    {"hmm_mos:offline", "= ? ? = = = ? ? ?"},

    // Scans are counted, empty ones too. A pixel has its nearest return and a voxel is hit or not,
    // but a cluster has a least number of points. The last scan is judged before it is integrated,
    // and free space is evaluated again with an empty scan.
    {"dynablox:published", "= ? ? = ? ~ = ? ?"},
    {"dynablox:wide", "= ? ? = ? ~ = ? ?"},
    {"dynablox:offline", "? ? ? = = ~ ? ? ?"},
    {"dynablox:offline-wide", "? ? ? = = ~ ? ? ?"},

    // Thresholds of the ground adapt from scan to scan, and the majority of the scans decides.
    // Means of heights and of voxels are sums, which round. The public program's images hold the
    // last point of a pixel, but no two of these points share one.
    {"mapcleaner:published", "= = ? ~ ? = ? ? ?"},
    {"mapcleaner:sound", "= = ? ~ ? = ? ? ?"},
};

Claims claims_of(const Line& line) {
  Claims claims{std::string(line.variant), {}};
  for (const char about : line.about) {
    if (about != ' ') claims.about.push_back(static_cast<Claim>(about));
  }
  return claims;
}

}  // namespace

const std::vector<Claims>& claims() {
  static const std::vector<Claims> all = [] {
    std::vector<Claims> made;
    for (const Line& line : kLines) made.push_back(claims_of(line));
    for (const auto& entry : MethodRegistry::built_in().entries()) {
      if (entry->needs_truth) continue;  // It answers from labels, which random worlds have not.
      for (const MethodVariant& variant : entry->variants) {
        const std::string name = entry->name + ":" + variant.name;
        const auto has_line = [&](const Line& line) { return line.variant == name; };
        if (std::any_of(std::begin(kLines), std::end(kLines), has_line)) continue;
        made.push_back(claims_of({name, variant.online ? kOnline : kOffline}));
      }
    }
    return made;
  }();
  return all;
}

}  // namespace raymoval::toy
