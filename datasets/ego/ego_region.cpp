// SPDX-License-Identifier: MIT
#include "datasets/ego/ego_region.h"

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr double kOpen = std::numeric_limits<double>::infinity();

[[noreturn]] void throw_ego_form(const std::string& text) {
  throw UsageError("'" + text +
                   "' says no part of the scans that is the own vehicle; expected auto, none, a "
                   "radius in metres (2.4), or a box XMIN:XMAX,YMIN:YMAX,ZMIN:ZMAX in the sensor "
                   "frame (-1:2,-0.9:0.9,-1.5:0.2; x ahead, y left, z up for most sensors).");
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
  // With all sides open nothing would be left.
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

}  // namespace raymoval
