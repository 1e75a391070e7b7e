// SPDX-License-Identifier: MIT
#include "datasets/ego/ego_region.h"

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/sampling.h"
#include "core/text.h"
#include "datasets/clouds/returns.h"
#include "datasets/ego/ego_estimate.h"
#include "datasets/world_axes/up_direction.h"

namespace raymoval {
namespace {

constexpr double kOpen = std::numeric_limits<double>::infinity();

[[noreturn]] void throw_ego_form(const std::string& text) {
  throw UsageError("'" + text +
                   "' is not a region of the ego vehicle; expected auto, none, a radius in metres "
                   "(2.4), or a box XMIN:XMAX,YMIN:YMAX,ZMIN:ZMAX in the sensor frame "
                   "(-1:2,-0.9:0.9,-1.5:0.2; x ahead, y left, z up for most sensors).");
}

double box_side(std::string_view part, double open, const std::string& text) {
  if (part.empty()) return open;
  const auto value = parse_number<double>(part);
  if (!value || !std::isfinite(*value)) throw_ego_form(text);
  return *value;
}

EgoRegion parse_box(const std::string& text) {
  EgoRegion region;
  region.kind = EgoRegion::Kind::kBox;
  const auto axes = split(text, ',');
  if (axes.size() != 3) throw_ego_form(text);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto sides = split(axes[k], ':');
    if (sides.size() != 2) throw_ego_form(text);
    const auto axis = static_cast<Eigen::Index>(k);
    region.box.min()[axis] = box_side(sides[0], -kOpen, text);
    region.box.max()[axis] = box_side(sides[1], kOpen, text);
    if (!(region.box.min()[axis] < region.box.max()[axis])) throw_ego_form(text);
  }
  // A box that is open on all sides would leave no point.
  if (region.box.min().maxCoeff() == -kOpen && region.box.max().minCoeff() == kOpen) {
    throw_ego_form(text);
  }
  return region;
}

std::string side_text(double value) {
  return std::isfinite(value) ? number_text(value) : "";
}

}  // namespace

EgoRegion parse_ego_region(const std::string& text) {
  EgoRegion region;
  if (text == "none") return region;
  if (text == "auto") {
    region.kind = EgoRegion::Kind::kEstimated;
    return region;
  }
  if (text.find(':') != std::string::npos) return parse_box(text);
  const auto radius = parse_number<double>(text);
  if (!radius || !(*radius > 0.0) || !std::isfinite(*radius)) throw_ego_form(text);
  region.kind = EgoRegion::Kind::kRadius;
  region.radius = *radius;
  return region;
}

std::string ego_region_text(const EgoRegion& region) {
  if (region.kind == EgoRegion::Kind::kNone) return "none";
  if (region.kind == EgoRegion::Kind::kEstimated) return "auto";
  if (region.kind == EgoRegion::Kind::kRadius) return number_text(region.radius);
  std::string text;
  for (Eigen::Index k = 0; k < 3; ++k) {
    text +=
        (k > 0 ? "," : "") + side_text(region.box.min()[k]) + ":" + side_text(region.box.max()[k]);
  }
  return text;
}

namespace {

EgoRegion estimated_region(const ScanSource& source, const std::optional<Eigen::Vector3d>& up) {
  constexpr std::size_t kCandidates = 400, kMostScans = 20;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < source.size(); ++i) poses.push_back(source.pose(i));
  std::vector<Scan> scans;
  for (const std::size_t i :
       poses_apart(poses, evenly_spread(poses.size(), kCandidates), kMostScans)) {
    scans.push_back(source.load(i));
  }
  std::vector<const Scan*> chosen;
  std::vector<std::vector<Surfel>> surfels;
  for (const Scan& scan : scans) {
    chosen.push_back(&scan);
    surfels.push_back(find_surfels(without_near(scan.points)));
  }
  const EgoEstimate estimate = estimate_ego(
      chosen, [&](std::size_t k) -> const std::vector<Surfel>& { return surfels[k]; },
      UpChoice(up).get(source).direction);
  if (!estimate.has_enough_motion()) {
    throw DataError(
        "--drop-ego auto: only " + counted_text(estimate.scans, "scan") +
        " a metre or more apart, but it takes five to find points that move with the sensor. "
        "Choose more --frames, or give the region: --drop-ego RADIUS or a box.");
  }
  return estimate.region();
}

}  // namespace

EgoFreeSource::EgoFreeSource(std::shared_ptr<const ScanSource> whole, EgoRegion asked,
                             std::optional<Eigen::Vector3d> up)
    : DerivedSource(std::move(whole)),
      asked_(asked),
      up_(std::move(up)),
      sensor_(std::nullopt),
      tally_(whole_->size()) {}

const EgoRegion& EgoFreeSource::region() const {
  if (asked_.kind != EgoRegion::Kind::kEstimated) return asked_;
  std::call_once(once_, [&] { region_ = estimated_region(*whole_, up_); });
  return region_;
}

const SensorModel& EgoFreeSource::sensor() const {
  const SensorModel& model = whole_->sensor();
  if (model.name != "estimated") return model;
  return sensor_.get(size(), [this](std::size_t index) { return load(index); });
}

Scan EgoFreeSource::load(std::size_t index) const {
  const EgoRegion& own = region();
  Scan scan = whole_->load(index);
  std::vector<std::uint32_t> kept;
  kept.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (!own.contains(scan.points[i].cast<double>())) kept.push_back(static_cast<std::uint32_t>(i));
  }
  tally_.set(index, scan.stored_point_count, scan.size() - kept.size());
  if (kept.empty() && scan.size() > 0) {
    throw DataError("scan " + scan.name + ": all of its " + counted_text(scan.size(), "point") +
                    " lie in the region that --drop-ego leaves out (" + ego_region_text(own) +
                    "). Choose a smaller region.");
  }
  keep_points(scan, std::move(kept));
  return scan;
}

}  // namespace raymoval
