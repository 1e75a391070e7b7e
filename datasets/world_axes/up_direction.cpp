// SPDX-License-Identifier: MIT
#include "datasets/world_axes/up_direction.h"

#include <cmath>

#include "core/text.h"

namespace raymoval {
namespace {

/// "y" -> 1; nothing for what names no axis.
std::optional<Eigen::Index> axis_named(const std::string& name) {
  if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') return std::nullopt;
  return name[0] - 'x';
}

}  // namespace

std::optional<Eigen::Vector3d> parse_up(const std::string& text) {
  const bool negative = text.starts_with('-');
  const bool is_signed = negative || text.starts_with('+');
  if (const auto axis = axis_named(text.substr(is_signed ? 1 : 0))) {
    return Eigen::Vector3d(Eigen::Vector3d::Unit(*axis) * (negative ? -1.0 : 1.0));
  }
  const auto parts = split(text, ',');
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  bool good = parts.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const auto value = parse_number<double>(parts[i]);
    good = value.has_value() && std::isfinite(*value);
    if (good) up[static_cast<Eigen::Index>(i)] = *value;
  }
  // Scaled first, so that no square overflows or vanishes.
  const double largest = up.cwiseAbs().maxCoeff();
  if (!good || !(largest > 0.0)) return std::nullopt;
  return Eigen::Vector3d((up / largest).normalized());
}

std::string up_text(const Eigen::Vector3d& up) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (std::abs(up[axis]) < 1.0 - 1e-12) continue;
    return std::string(up[axis] < 0.0 ? "-" : "") + static_cast<char>('x' + axis);
  }
  return fixed_text(up.x(), 3) + "," + fixed_text(up.y(), 3) + "," + fixed_text(up.z(), 3);
}

const char* up_source_name(UpDirection::Source source) {
  if (source == UpDirection::Source::kWorldZ) return "world z";
  return source == UpDirection::Source::kGiven ? "given" : "estimated";
}

std::string up_line(const UpDirection& up) {
  if (up.is_world_z()) return "";
  return "up is " + up_text(up.direction) + " of the world (" +
         (up.source == UpDirection::Source::kGiven ? "as given"
                                                   : "estimated from the scans; --up z overrules") +
         ")";
}

}  // namespace raymoval
