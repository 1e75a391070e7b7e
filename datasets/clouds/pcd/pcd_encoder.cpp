// SPDX-License-Identifier: MIT
#include "datasets/clouds/pcd/pcd_encoder.h"

#include <algorithm>

#include "core/text.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/format/text_rows.h"
#include "datasets/clouds/pcd/lzf_block.h"

namespace raymoval {
namespace {

/// Digits of the largest of the three counts in a head.
constexpr std::size_t kMostDigits = 10;

NameRules pcd_names() {
  NameRules rules;
  rules.taken = {"_"};  // Padding.
  return rules;
}

/// A field, or the filler between two fields.
struct HeadField {
  std::string name, type;
  std::size_t size = 1, count = 1;
};

/// The numbers of the fields in the order of their places.
std::vector<std::size_t> by_place(const RecordLayout& layout) {
  std::vector<std::size_t> order(layout.fields.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return layout.fields[a].offset < layout.fields[b].offset;
  });
  return order;
}

/// In order of their places, with filler between them if `filled`.
std::vector<HeadField> head_fields(const RecordLayout& layout, bool filled) {
  const std::vector<std::string> names = fitting_names(names_of(layout), pcd_names());
  std::vector<HeadField> fields;
  std::size_t at = 0;
  const auto fill = [&](std::size_t end) {
    // No reader takes more than 65,536 values a field for granted, ours among them.
    for (std::size_t bytes = 0; filled && at < end; at += bytes) {
      bytes = std::min<std::size_t>(end - at, 65536);
      fields.push_back({"_", "U", 1, bytes});
    }
  };
  for (const std::size_t i : by_place(layout)) {
    const PointField& field = layout.fields[i];
    fill(field.offset);
    fields.push_back({names[i], std::string(1, field.type), static_cast<std::size_t>(field.size),
                      static_cast<std::size_t>(field.count)});
    at = field.offset + field.bytes();
  }
  fill(layout.row_bytes);
  return fields;
}

std::string field_lines(const RecordLayout& layout, bool filled) {
  std::string names = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const HeadField& field : head_fields(layout, filled)) {
    names += " " + field.name;
    sizes += " " + std::to_string(field.size);
    types += " " + field.type;
    counts += " " + std::to_string(field.count);
  }
  return names + "\n" + sizes + "\n" + types + "\n" + counts + "\n";
}

std::string viewpoint_text(const Eigen::Matrix<double, 7, 1>& viewpoint) {
  std::string text;
  for (const double value : viewpoint) text += " " + number_text(value);
  return text;
}

class PcdEncoder : public RecordEncoder {
 public:
  explicit PcdEncoder(const StoredForm& form) : form_(form) {}

  void start(const PointRecords& first) override {
    fields_ = field_lines(first.layout, !form_.text && !form_.packed);
    for (const std::size_t i : by_place(first.layout)) ordered_.push_back(first.layout.fields[i]);
    kept_.layout = first.layout;
    if (first.viewpoint) viewpoint_ = viewpoint_text(*first.viewpoint);
    room_ = viewpoint_.size() + 3 * kMostDigits;
  }

  std::string head(std::uint64_t points) const override {
    const std::string width = std::to_string(shape_.of(points).first);
    const std::string height = std::to_string(shape_.of(points).second);
    const std::string count = std::to_string(points);
    const std::size_t used = viewpoint_.size() + width.size() + height.size() + count.size();
    // Blanks in a comment give room for the digits, so that the head always has the same length.
    return "# .PCD v0.7 - Point Cloud Data file format\n# Written by raymoval" +
           std::string(room_ - std::min(room_, used), ' ') + "\nVERSION 0.7\n" + fields_ +
           "WIDTH " + width + "\nHEIGHT " + height + "\nVIEWPOINT" + viewpoint_ + "\nPOINTS " +
           count + "\nDATA " +
           (form_.text     ? "ascii"
            : form_.packed ? "binary_compressed"
                           : "binary") +
           "\n";
  }

  std::string rows(const PointRecords& more) override {
    shape_.add(more);
    if (more.size() > 0 && more.viewpoint && viewpoint_text(*more.viewpoint) != viewpoint_) {
      viewpoint_ = kNone;
    }
    if (form_.text) return text_rows(more, ordered_);
    if (form_.packed) {
      kept_.bytes.insert(kept_.bytes.end(), more.bytes.begin(), more.bytes.end());
      return "";
    }
    return {reinterpret_cast<const char*>(more.bytes.data()), more.bytes.size()};
  }

  /// The values of one field after another, packed together.
  std::string rest() override {
    if (form_.text || !form_.packed) return "";
    std::string columns;
    columns.reserve(kept_.bytes.size());
    for (const PointField& field : ordered_) {
      for (std::size_t i = 0; i < kept_.size(); ++i) {
        columns.append(reinterpret_cast<const char*>(kept_.row(i) + field.offset), field.bytes());
      }
    }
    return pack_lzf_block(columns);
  }

 private:
  static constexpr const char* kNone = " 0 0 0 1 0 0 0";
  StoredForm form_;
  std::vector<PointField> ordered_;
  PointRecords kept_;  ///< All rows, of a compressed file.
  std::string fields_;
  std::string viewpoint_ = kNone;  ///< Never longer than the first one.
  std::size_t room_ = 0;
  WrittenShape shape_;
};

}  // namespace

std::unique_ptr<RecordEncoder> pcd_encoder(const StoredForm& form) {
  return std::make_unique<PcdEncoder>(form);
}

std::vector<std::string> lost_in_pcd(const RecordLayout& layout) {
  const std::vector<std::string> wanted = names_of(layout);
  return renamed_sentences(wanted, fitting_names(wanted, pcd_names()));
}

}  // namespace raymoval
