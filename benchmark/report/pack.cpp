// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <span>

#include "benchmark/report/pack.h"
#include "benchmark/report/scene.h"
#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

using nlohmann::ordered_json;

/// Bits of a point's coordinate.
constexpr int kBits = 16;

/// The points that a page unpacks, and draws, at once.
constexpr std::size_t kChunkPoints = 16384;

/// Appends each number as its difference from the number before it (modulo 2^16), with the sign in
/// the lowest bit: first all low bytes, then all high ones. In this form, numbers that vary little
/// compress well.
void append_differences(const std::vector<std::uint16_t>& values, std::string& bytes) {
  const std::size_t start = bytes.size();
  bytes.resize(start + 2 * values.size());
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto difference =
        static_cast<std::int16_t>(static_cast<std::uint16_t>(values[i] - before));
    before = values[i];
    const auto folded =
        static_cast<std::uint16_t>(difference < 0 ? -2 * difference - 1 : 2 * difference);
    bytes[start + i] = static_cast<char>(folded & 0xFFU);
    bytes[start + values.size() + i] = static_cast<char>(folded >> 8U);
  }
}

/// The points in chunks of `kChunkPoints`. In each chunk x, y, z, scans, then the labels' places.
std::string geometry_bytes(const Scene& scene, const PageFrame& frame) {
  std::string bytes;
  for (std::size_t begin = 0; begin < scene.points.size(); begin += kChunkPoints) {
    const std::size_t count = std::min(kChunkPoints, scene.points.size() - begin);
    const std::span points(scene.points.data() + begin, count);
    std::vector<std::uint16_t> values(count);
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t origin = std::int64_t{frame.origin[axis]} * kStepsPerVoxel;
      std::ranges::transform(points, values.begin(), [&](const ShownPoint& p) {
        return static_cast<std::uint16_t>((p.step[axis] - origin) >> frame.shift);
      });
      append_differences(values, bytes);
    }
    std::ranges::transform(points, values.begin(), [](const ShownPoint& point) {
      return static_cast<std::uint16_t>(point.scan);
    });
    append_differences(values, bytes);
    for (const ShownPoint& point : points) {
      const auto label = std::ranges::find(scene.labels, point.label, &SceneLabel::id);
      bytes += static_cast<char>(std::min<std::ptrdiff_t>(label - scene.labels.begin(), 255));
    }
  }
  return bytes;
}

ordered_json labels_record(const Scene& scene) {
  ordered_json record = ordered_json::array();
  for (const SceneLabel& label : scene.labels) {
    record.push_back(
        {{"id", label.id}, {"name", label.name}, {"kind", static_cast<int>(label.kind)}});
  }
  return record;
}

ordered_json cell_record(const SceneCell& cell, const VerdictCounts& counts) {
  ordered_json record;
  record["name"] = cell.name;
  record["control"] = cell.control;
  record["counts"] = {counts.kept_static, counts.false_positive, counts.true_positive,
                      counts.false_negative};
  record["reasons"] = cell.sentences;
  return record;
}

/// The trajectory in centimetres' precision, from the frame's origin.
ordered_json trajectory_record(const Scene& scene, const PageFrame& frame) {
  ordered_json record = ordered_json::array();
  for (const Eigen::Vector3d& position : scene.trajectory) {
    for (int axis = 0; axis < 3; ++axis) {
      const double metres = position[axis] - frame.origin[axis] * kPageVoxel;
      record.push_back(std::round(metres * 100.0) / 100.0);
    }
  }
  return record;
}

}  // namespace

std::string deflated(std::string_view bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string packed(size, '\0');
  const int status =
      ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_BEST_COMPRESSION);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK) throw InternalError(fmt::format("zlib gave status {}", status));
  packed.resize(size);
  return packed;
}

std::string printable(std::string_view bytes) {
  constexpr std::uint32_t kDigits = 91;
  std::string text;
  const auto put = [&](std::uint32_t digit) {
    const char letter = static_cast<char>('#' + digit);
    text += letter == '<' ? '!' : letter;
  };
  const auto put_pair = [&](std::uint32_t value) {
    put(value % kDigits);
    put(value / kDigits);
  };
  text.reserve(bytes.size() * 16 / 13 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char byte : bytes) {
    bits |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(byte)) << count;
    count += 8;
    if (count < 13) continue;
    put_pair(bits & 0x1FFFU);
    bits >>= 13;
    count -= 13;
  }
  if (count > 6) {
    put_pair(bits);
  } else if (count > 0) {
    put(bits);
  }
  return text;
}

std::string script_json(const ordered_json& json) {
  const std::string text = json.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  const std::vector<std::string_view> pieces = split(text, '<');  // Only texts contain '<'.
  return fmt::format("{}", fmt::join(pieces, "\\u003c"));
}

std::string page_data(const std::vector<std::string>& heads) {
  return fmt::format("{{\"scenes\":[{}]}}", fmt::join(heads, ","));
}

PageFrame page_frame(const std::vector<ShownPoint>& points, int shift) {
  PageFrame frame;
  frame.shift = shift;
  for (;; ++frame.shift) {
    // The corner is a whole number of units, so that units and cells of several units have common
    // borders.
    const std::int64_t edge =
        std::max<std::int64_t>(kStepsPerVoxel, std::int64_t{1} << frame.shift);
    std::int64_t widest = 0;
    for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
      const auto [low, high] = std::ranges::minmax(
          points, {}, [axis](const ShownPoint& point) { return point.step[axis]; });
      const std::int64_t corner = low.step[axis] - (low.step[axis] % edge + edge) % edge;
      frame.origin[axis] = static_cast<std::int32_t>(corner / kStepsPerVoxel);
      widest = std::max(widest, high.step[axis] - corner);
    }
    if (widest >> frame.shift < 1 << kBits) return frame;
  }
}

PackedScene pack_scene(const Scene& scene, std::size_t number) {
  ordered_json head;
  const PageFrame frame = page_frame(scene.points, scene.shift);
  const std::string prefix = "scene-" + std::to_string(number);
  head["sequence"] = scene.sequence;
  head["stream"] = prefix;
  if (scene.is_unlabelled) head["unlabelled"] = true;
  head["points"] = scene.points.size();
  head["chunk"] = kChunkPoints;
  head["points_in_range"] = scene.points_in_range;
  head["voxel"] = kPageVoxel;
  head["steps_per_voxel"] = kStepsPerVoxel;
  head["shift"] = frame.shift;
  head["origin"] = frame.origin;
  if (!scene.T_upright_world.linear().isIdentity(0.0)) {
    // The rows of the rotation back to the world, with which the page shows positions.
    head["turn"] = ordered_json::array();
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        head["turn"].push_back(scene.T_upright_world.linear()(row, column));
      }
    }
  }
  head["error_cell"] = scene.error_cell * kPageVoxel / kStepsPerVoxel;
  head["other_cell"] = scene.other_cell * kPageVoxel / kStepsPerVoxel;
  head["labels"] = labels_record(scene);
  head["scans"] = scene.scans;
  head["trajectory"] = trajectory_record(scene, frame);
  head["cells"] = ordered_json::array();
  PackedScene packed;
  packed.streams.emplace_back(prefix, printable(deflated(geometry_bytes(scene, frame))));
  for (std::size_t i = 0; i < scene.cells.size(); ++i) {
    head["cells"].push_back(cell_record(scene.cells[i], scene.counts[i]));
  }
  if (scene.is_unlabelled) {
    const std::string review = script_json(to_json(scene.review));
    packed.streams.emplace_back(prefix + "-review", printable(deflated(review)));
    head["confidences"] = scene.confidences;
  }
  for (std::size_t i = 0; i < scene.verdicts.size(); ++i) {
    const std::vector<std::uint8_t>& bytes = scene.verdicts[i];
    packed.streams.emplace_back(
        prefix + "-" + std::to_string(i),
        printable(deflated({reinterpret_cast<const char*>(bytes.data()), bytes.size()})));
  }
  packed.head = script_json(head);
  return packed;
}

}  // namespace raymoval
