// SPDX-License-Identifier: MIT
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/las/las_fields.h"
#include "datasets/clouds/las/las_head.h"
#include "datasets/records/point_records.h"

namespace raymoval {
namespace {

constexpr double kMost = std::numeric_limits<std::int32_t>::max();
/// If points are farther from 0 than this along an axis, the offset is near the first points,
/// metres. At a scale of 0.001 m, 32 bits reach 2,147 km.
constexpr double kFar = 1e6;

/// The least and the greatest finite coordinates of points; 0 if there are none.
std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds_of(const PointRecords& points) {
  const PositionFields fields = position_fields(points.layout, "points");
  const PointField* axes[] = {&fields.x, &fields.y, &fields.z};
  Eigen::Vector3d least = Eigen::Vector3d::Zero(), most = Eigen::Vector3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    bool any = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double value = points.value(i, *axes[axis]);
      if (!std::isfinite(value)) continue;
      least[axis] = any ? std::min(least[axis], value) : value;
      most[axis] = any ? std::max(most[axis], value) : value;
      any = true;
    }
  }
  return {least, most};
}

/// Encodes coordinates for LAS: whole numbers of 32 bits, multiplied by a scale from an offset.
class LasGrid {
 public:
  /// @param where the file, for messages
  /// @param first the first points of the file
  /// @param notes the scale and offset to use if `first` lies within them, or null
  LasGrid(std::string where, const PointRecords& first, const LasNotes* notes)
      : where_(std::move(where)) {
    least_.setConstant(std::numeric_limits<double>::infinity());
    most_ = -least_;
    const auto [least, most] = bounds_of(first);
    if (notes != nullptr) {
      scale_ = notes->scale;
      const auto steps = [&](const Eigen::Vector3d& place) {
        return ((place - notes->offset).array() / scale_.array()).abs().maxCoeff();
      };
      if (steps(least) < kMost && steps(most) < kMost) {
        offset_ = notes->offset;
        return;
      }
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double reach = std::max(std::abs(least[axis]), std::abs(most[axis]));
      const bool far = reach > std::min(kFar, 0.5 * kMost * std::abs(scale_[axis]));
      if (far) offset_[axis] = std::floor(least[axis]);
    }
  }

  /// Writes the three numbers of a position to `to`.
  /// @param point number in the file, for messages
  /// @throws DataError if the position is not finite or out of range
  void encode(const Eigen::Vector3d& place, std::uint64_t point, char* to) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double steps = std::nearbyint((place[axis] - offset_[axis]) / scale_[axis]);
      if (!(std::abs(steps) <= kMost)) {
        throw DataError(where_ + ": point " + grouped_text(point) + " has " + "xyz"[axis] + " = " +
                        number_text(place[axis]) + ", but a LAS file with the scale " +
                        number_text(scale_[axis]) + " and the offset " +
                        number_text(offset_[axis]) + " reaches only " +
                        number_text(std::abs(kMost * scale_[axis])) +
                        " m from it, and has no place for what is not finite. Nothing was changed; "
                        "write .pcd or .npy.");
      }
      const auto number = static_cast<std::int32_t>(steps);
      std::memcpy(to + 4 * axis, &number, sizeof number);
      least_[axis] = std::min(least_[axis], steps);
      most_[axis] = std::max(most_[axis], steps);
    }
  }

  /// Writes scale, offset and the bounds of the encoded points into the head of a LAS file.
  void put_into(std::string& head) const {
    const auto put = [&](std::size_t at, double number) {
      std::memcpy(head.data() + at, &number, sizeof number);
    };
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::size_t>(8 * axis);
      put(131 + place, scale_[axis]);
      put(155 + place, offset_[axis]);
      if (least_[axis] > most_[axis]) continue;
      const double a = least_[axis] * scale_[axis] + offset_[axis];
      const double b = most_[axis] * scale_[axis] + offset_[axis];
      put(179 + 2 * place, std::max(a, b));
      put(187 + 2 * place, std::min(a, b));
    }
  }

 private:
  std::string where_;
  Eigen::Vector3d scale_ = Eigen::Vector3d::Constant(0.001);
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  Eigen::Array3d least_, most_;  ///< Of the numbers; least > most if there are none.
};

constexpr std::size_t kHeadBytes = 375, kRecordHead = 54;

/// The bytes of a public header block of LAS.
struct HeadBytes {
  std::string bytes;
  template <class Number>
  void put(std::size_t at, Number number) {
    std::memcpy(bytes.data() + at, &number, sizeof number);
  }
  void put_text(std::size_t at, std::string_view text) { bytes.replace(at, text.size(), text); }
};

std::string variable_record(std::string_view user, std::uint16_t id, std::string_view content) {
  HeadBytes head{std::string(kRecordHead, '\0')};
  head.put_text(2, user);
  head.put<std::uint16_t>(18, id);
  head.put<std::uint16_t>(20, static_cast<std::uint16_t>(content.size()));
  return head.bytes + std::string(content);
}

class LasEncoder : public RecordEncoder {
 public:
  explicit LasEncoder(const std::filesystem::path& path) : path_(path) {}

  void start(const PointRecords& first) override {
    layout_ = first.layout;
    mapping_ = map_to_las(layout_);
    position_ = position_fields(layout_, path_.string());
    if (mapping_.extra.size() > kMostExtraFields ||
        mapping_.record_bytes > std::numeric_limits<std::uint16_t>::max()) {
      throw DataError(path_.string() + ": points of " + grouped_text(mapping_.extra.size()) +
                      " values that LAS has no place for, " + grouped_text(mapping_.record_bytes) +
                      " bytes in all; a LAS point has at most 341 and 65,535. Write .pcd or .npy.");
    }
    const LasNotes* notes = first.las.get();
    grid_.emplace(path_.string(), first, notes);
    if (notes != nullptr) gps_standard_ = notes->standard_gps_time;
    records_ = variable_records(notes);
  }

  std::string head(std::uint64_t points) const override {
    HeadBytes head{std::string(kHeadBytes, '\0')};
    head.put_text(0, "LASF");
    constexpr unsigned kWkt = 16;
    head.put<std::uint16_t>(6, static_cast<std::uint16_t>(kWkt | (gps_standard_ ? 1U : 0U)));
    head.put<std::uint8_t>(24, 1);
    head.put<std::uint8_t>(25, 4);
    head.put_text(26, "raymoval");
    head.put_text(58, "raymoval");
    head.put<std::uint16_t>(94, kHeadBytes);
    head.put<std::uint32_t>(96, static_cast<std::uint32_t>(kHeadBytes + records_.size()));
    head.put<std::uint32_t>(100, record_count_);
    head.put<std::uint8_t>(104, static_cast<std::uint8_t>(mapping_.format));
    head.put<std::uint16_t>(105, static_cast<std::uint16_t>(mapping_.record_bytes));
    // The counts at 107 and 111 are of the formats 0 to 5 and stay 0.
    grid_->put_into(head.bytes);
    head.put<std::uint64_t>(247, points);
    for (std::size_t i = 0; i < returns_.size(); ++i) head.put(255 + 8 * i, returns_[i]);
    return head.bytes + records_;
  }

  std::string rows(const PointRecords& more) override {
    std::string bytes(more.size() * mapping_.record_bytes, '\0');
    for (std::size_t i = 0; i < more.size(); ++i) {
      encode(more, i, bytes.data() + i * mapping_.record_bytes);
    }
    points_ += more.size();
    return bytes;
  }

 private:
  std::string variable_records(const LasNotes* notes) {
    std::string records;
    if (notes != nullptr && !notes->reference_system.empty()) {
      records += variable_record("LASF_Projection", 2112, notes->reference_system + '\0');
      ++record_count_;
    }
    std::string descriptions;
    for (const LasMapping::Extra& extra : mapping_.extra) {
      std::string known;
      if (notes != nullptr && notes->extra_bytes.contains(extra.of)) {
        known = notes->extra_bytes.at(extra.of);
      }
      descriptions += extra_description(extra.from, extra.name, known);
    }
    if (!descriptions.empty()) {
      records += variable_record("LASF_Spec", 4, descriptions);
      ++record_count_;
    }
    return records;
  }

  void encode(const PointRecords& rows, std::size_t point, char* to) {
    const Eigen::Vector3d place(rows.value(point, position_.x), rows.value(point, position_.y),
                                rows.value(point, position_.z));
    grid_->encode(place, points_ + point, to);
    to[14] = static_cast<char>(mapping_.assumed_returns);
    for (const LasMapping::Standard& field : mapping_.standard)
      put_standard(rows, point, field, to);
    if (mapping_.shown_intensity != nullptr) put_intensity(rows, point, to);
    if (mapping_.shown_colour != nullptr) put_colour(rows, point, to);
    if (mapping_.shown_angle != nullptr) {
      // From degrees to steps of 0.006 degrees.
      const double steps = rows.value(point, *mapping_.shown_angle) / 0.006;
      put<std::int16_t>(to + 18, static_cast<std::int16_t>(std::lround(steps)));
    }
    std::size_t at = las_record_bytes(mapping_.format);
    for (const LasMapping::Extra& extra : mapping_.extra) {
      std::memcpy(to + at, rows.row(point) + extra.from.offset, extra.from.bytes());
      at += extra.from.bytes();
    }
    const unsigned number = static_cast<unsigned char>(to[14]) & 0xFU;
    if (number > 0) ++returns_[number - 1];
  }

  template <class Number>
  static void put(char* to, Number number) {
    std::memcpy(to, &number, sizeof number);
  }

  void put_standard(const PointRecords& rows, std::size_t point, const LasMapping::Standard& field,
                    char* to) const {
    const std::byte* from = rows.row(point) + field.from.offset;
    const auto size = static_cast<std::size_t>(field.from.size);
    if (field.to.bits == 0) {
      // Little-endian: a smaller whole number leaves the upper bytes, which a sign fills.
      std::memcpy(to + field.to.at, from, size);
      const bool negative =
          field.from.type == 'I' && (from[size - 1] & std::byte{0x80}) != std::byte{};
      for (std::size_t i = size; i < static_cast<std::size_t>(field.to.size); ++i) {
        to[field.to.at + i] = static_cast<char>(negative ? 0xFF : 0);
      }
      return;
    }
    const auto value = std::to_integer<unsigned>(*from);
    if ((value >> field.to.bits) != 0) {
      throw DataError(path_.string() + ": point " + grouped_text(points_ + point) + " has " +
                      field.from.name + " " + std::to_string(value) + ", but LAS has only " +
                      std::to_string(field.to.bits) +
                      " bits for it. Nothing was changed; write .pcd or .npy.");
    }
    to[field.to.at] =
        static_cast<char>(static_cast<unsigned char>(to[field.to.at]) | (value << field.to.bit));
  }

  void put_intensity(const PointRecords& rows, std::size_t point, char* to) const {
    const double value = rows.value(point, *mapping_.shown_intensity);
    const double shown = std::isnan(value) ? 0.0 : std::clamp(std::nearbyint(value), 0.0, 65535.0);
    put(to + 12, static_cast<std::uint16_t>(shown));
  }

  void put_colour(const PointRecords& rows, std::size_t point, char* to) const {
    std::array<std::uint8_t, 4> colour;  // Blue, green, red, alpha.
    std::memcpy(colour.data(), rows.row(point) + mapping_.shown_colour->offset, sizeof colour);
    for (std::size_t i = 0; i < 3; ++i) {
      put(to + las_record_bytes(6) + 2 * i, static_cast<std::uint16_t>(257U * colour[2 - i]));
    }
  }

  std::filesystem::path path_;
  RecordLayout layout_;
  LasMapping mapping_;
  PositionFields position_;
  std::optional<LasGrid> grid_;
  bool gps_standard_ = false;
  std::string records_;
  std::uint32_t record_count_ = 0;
  std::uint64_t points_ = 0;
  std::array<std::uint64_t, 15> returns_{};
};

}  // namespace

std::unique_ptr<RecordEncoder> las_encoder(const std::filesystem::path& path) {
  return std::make_unique<LasEncoder>(path);
}

std::vector<std::string> lost_in_las(const RecordLayout& layout) {
  const LasMapping mapping = map_to_las(layout);
  std::vector<std::string> sentences = {
      "x, y and z are rounded to whole multiples of 0.001 m, or of the scale of the LAS file that "
      "the points come from."};
  for (const LasMapping::Standard& field : mapping.standard) {
    if (field.from.size == field.to.size) continue;
    sentences.push_back("The field '" + field.from.name + "' is written with " +
                        std::to_string(8 * field.to.size) + " bits instead of " +
                        std::to_string(8 * field.from.size) + ".");
  }
  for (const LasMapping::Extra& extra : mapping.extra) {
    if (extra.name == extra.of) continue;
    sentences.push_back("The field '" + extra.of + "' is written as '" + extra.name +
                        "' in the extra bytes.");
  }
  return sentences;
}

}  // namespace raymoval
