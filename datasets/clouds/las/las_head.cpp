// SPDX-License-Identifier: MIT
#include "datasets/clouds/las/las_head.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {
namespace {

constexpr std::uint64_t kRecordHeadBytes = 54, kExtendedHead = 60;
constexpr std::uint16_t kExtraBytesId = 4, kWktId = 2112;

class LasHeadReader {
 public:
  explicit LasHeadReader(const CloudBytes& file) : bytes_(file.text), where_(file.path.string()) {}

  LasHead read() {
    check_version();
    const unsigned format = at<std::uint8_t>(104);
    if (format >= 0x80) fail_laz();
    if (format >= static_cast<unsigned>(kLasFormats)) {
      fail("point format " + std::to_string(format) + " is not known; expected 0 to 10");
    }
    head_.format = static_cast<int>(format);
    head_.record_bytes = at<std::uint16_t>(105);
    head_.first_point = at<std::uint32_t>(96);
    head_.notes = std::make_shared<LasNotes>();
    head_.notes->standard_gps_time = (at<std::uint16_t>(6) & 1U) != 0;
    read_grid();
    read_records();
    if (laz_) fail_laz();
    read_points();
    read_extra();
    return std::move(head_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw DataError(where_ + ": " + what + "." + kRereadRemedy);
  }
  [[noreturn]] void fail_laz() const {
    throw DataError(where_ +
                    ": is compressed (LAZ), which is not read. Decompress it: laszip -i in.laz -o "
                    "out.las, or pdal translate in.laz out.las.");
  }
  std::string_view piece(std::uint64_t offset, std::uint64_t size) const {
    if (offset > bytes_.size() || size > bytes_.size() - offset) {
      fail("it ends within its head, after " + grouped_text(bytes_.size()) +
           " bytes; it looks truncated");
    }
    return bytes_.substr(offset, size);
  }
  template <class Number>
  Number at(std::uint64_t offset) const {
    Number number{};
    std::memcpy(&number, piece(offset, sizeof number).data(), sizeof number);
    return number;
  }

  void check_version() {
    if (!bytes_.starts_with("LASF")) fail("is not a LAS file: it does not begin with LASF");
    const int major = at<std::uint8_t>(24);
    minor_ = at<std::uint8_t>(25);
    if (major != 1 || minor_ > 4) {
      fail("LAS " + std::to_string(major) + "." + std::to_string(minor_) +
           " is not known; expected 1.0 to 1.4");
    }
    (void)piece(0, minor_ == 4 ? 375 : minor_ == 3 ? 235 : 227);
  }

  void read_grid() {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::uint64_t>(8 * axis);
      head_.notes->scale[axis] = at<double>(131 + place);
      head_.notes->offset[axis] = at<double>(155 + place);
    }
    const bool usable = head_.notes->scale.allFinite() && head_.notes->offset.allFinite() &&
                        (head_.notes->scale.array() != 0.0).all();
    if (!usable) fail("its scales or offsets are not usable numbers; it is damaged");
  }

  /// The records of variable length behind the head, and the extended ones behind the points.
  void read_records() {
    std::uint64_t place = at<std::uint16_t>(94);
    for (auto left = at<std::uint32_t>(100); left > 0; --left) {
      (void)piece(place, kRecordHeadBytes);
      const std::uint64_t length = at<std::uint16_t>(place + 20);
      read_record(place, piece(place + kRecordHeadBytes, length));
      place += kRecordHeadBytes + length;
    }
    if (place > head_.first_point) {
      fail("its records reach beyond where its points begin (byte " +
           grouped_text(head_.first_point) + "); it is damaged");
    }
    end_ = bytes_.size();
    if (minor_ >= 3) end_at(at<std::uint64_t>(227));
    if (minor_ < 4 || at<std::uint32_t>(243) == 0) return;
    place = at<std::uint64_t>(235);
    end_at(place);
    for (auto left = at<std::uint32_t>(243); left > 0; --left) {
      (void)piece(place, kExtendedHead);
      const auto length = at<std::uint64_t>(place + 20);
      const std::string_view content = piece(place + kExtendedHead, length);
      read_record(place, content);
      place += kExtendedHead + length;
    }
  }
  /// Limits the points: other data begins at `place`.
  void end_at(std::uint64_t place) {
    if (place > head_.first_point) end_ = std::min<std::uint64_t>(end_, place);
  }

  void read_record(std::uint64_t place, std::string_view content) {
    const std::string_view named = piece(place + 2, 16);
    const std::string_view user = named.substr(0, named.find('\0'));
    const auto id = at<std::uint16_t>(place + 18);
    if (user == "laszip encoded") laz_ = true;
    if (user == "LASF_Spec" && id == kExtraBytesId) extra_ = content;
    if (user != "LASF_Projection") return;
    std::string& system = head_.notes->reference_system;
    if (id == kWktId) system = content.substr(0, content.find('\0'));
  }

  void read_points() {
    const std::size_t least = las_record_bytes(head_.format);
    if (head_.record_bytes < least) {
      fail("its points have " + std::to_string(head_.record_bytes) + " bytes, but format " +
           std::to_string(head_.format) + " takes " + std::to_string(least) + "; it is damaged");
    }
    head_.points = at<std::uint32_t>(107);
    if (minor_ == 4 && at<std::uint64_t>(247) != 0) head_.points = at<std::uint64_t>(247);
    if (head_.first_point > end_) fail("its points begin beyond its end; it looks truncated");
    const std::uint64_t room = (end_ - head_.first_point) / head_.record_bytes;
    if (head_.points > room || head_.points > kMostCloudPoints) {
      fail("the head announces " + grouped_text(head_.points) + " points of " +
           std::to_string(head_.record_bytes) + " bytes, but only " +
           grouped_text(end_ - head_.first_point) +
           " bytes follow it; the file looks truncated after point " + grouped_text(room));
    }
    if (head_.points < room) {
      fail("the head announces " + grouped_text(head_.points) +
           " points, but there are bytes for " + grouped_text(room) +
           "; the program that wrote it may not have finished it. Repair its head (lasinfo "
           "-repair)");
    }
  }

  void read_extra() {
    const std::size_t bytes = head_.record_bytes - las_record_bytes(head_.format);
    head_.extra = read_extra_fields(extra_, bytes, where_);
    for (const ExtraField& extra : head_.extra) {
      head_.notes->extra_bytes.emplace(extra.field.name, extra.description);
    }
  }

  std::string_view bytes_;
  std::string where_;
  LasHead head_;
  int minor_ = 0;
  bool laz_ = false;
  std::uint64_t end_ = 0;
  std::string_view extra_;
};

}  // namespace

LasHead read_las_head(const CloudBytes& file) {
  return LasHeadReader(file).read();
}

}  // namespace raymoval
