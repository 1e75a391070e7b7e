// SPDX-License-Identifier: MIT
#include "datasets/clouds/numpy/npy_file.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/numpy/npy_array.h"
#include "datasets/clouds/numpy/npy_type.h"
#include "datasets/clouds/numpy/zip_archive.h"

namespace raymoval {
namespace {

Cloud read_npy_cloud(const CloudBytes& file, const Eigen::Vector3d& origin) {
  return cloud_of(npy_points(file).stored, origin, file.path.string());
}

PointRecords read_npy_records(const CloudBytes& file) {
  const NpyPoints points = npy_points(file);
  PointRecords records = records_of(points.stored);
  records.layout.unnamed = points.unnamed;
  records.width = points.width;
  records.height = points.height;
  (void)position_fields(records.layout, file.path.string());
  return records;
}

/// The array of an archive that holds the points.
/// @param unpacked is filled with its bytes, and `form` with what it is among
CloudBytes chosen_array(const CloudBytes& file, std::filesystem::path& name, std::string& unpacked,
                        StoredForm& form) {
  const std::string where = file.path.string();
  std::vector<ZipMember> arrays;
  std::vector<std::string> names;
  for (ZipMember& member : zip_members(file.text, where)) {
    if (!member.name.ends_with(".npy")) continue;
    member.name.resize(member.name.size() - 4);
    names.push_back(member.name);
    arrays.push_back(std::move(member));
  }
  const ZipMember* chosen = arrays.size() == 1 ? &arrays.front() : nullptr;
  for (const char* usual : {"arr_0", "points"}) {
    for (const ZipMember& array : arrays) {
      if (array.name == usual) chosen = &array;
    }
  }
  if (chosen == nullptr) {
    names.resize(std::min<std::size_t>(names.size(), 20));
    throw DataError(where + ": holds " +
                    (names.empty() ? "no array" : "the arrays " + join(names)) +
                    "; expected one array, or one named points or arr_0. Save the points under "
                    "such a name.");
  }
  name = where + ": " + chosen->name;
  form.packed = chosen->method != 0;
  form.array = chosen->name;
  std::erase(names, chosen->name);
  form.others = names;
  unpacked = zip_content(file.text, *chosen, name.string());
  return {name, unpacked, file.reading};
}

Cloud read_npz_cloud(const CloudBytes& file, const Eigen::Vector3d& origin) {
  std::filesystem::path name;
  std::string unpacked;
  StoredForm form;
  return read_npy_cloud(chosen_array(file, name, unpacked, form), origin);
}

PointRecords read_npz_records(const CloudBytes& file) {
  std::filesystem::path name;
  std::string unpacked;
  StoredForm form;
  PointRecords records = read_npy_records(chosen_array(file, name, unpacked, form));
  records.form = form;
  return records;
}

std::string npz_of(const std::string& npy, const StoredForm& form) {
  const std::string name = form.array.empty() ? "points" : form.array;
  return zip_archive_of(name + ".npy", npy, form.packed);
}

NameRules npy_names() {
  NameRules rules;
  rules.with_blanks = true;
  return rules;
}

bool is_ascii(const std::string& text) {
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0x80U) != 0) return false;
  }
  return true;
}

class NpyEncoder : public RecordEncoder {
 public:
  void start(const PointRecords& first) override {
    descr_ = npy_descr(first.layout, fitting_names(names_of(first.layout), npy_names()));
    if (is_plain_array(first.layout)) {
      columns_ = first.layout.row_bytes / static_cast<std::size_t>(first.layout.fields[0].size);
    }
    // The longest shape there can be leaves room for all others.
    const std::size_t longest =
        dictionary("4294967295, 4294967295, " + std::to_string(columns_) + ", ").size();
    const bool long_head = longest + 64 > 65535;
    version_ = !is_ascii(descr_) ? 3 : long_head ? 2 : 1;
    // The head ends with a line and at a multiple of 64 bytes.
    const std::size_t before = version_ == 1 ? 10 : 12;
    head_bytes_ = (before + longest + 1 + 63) / 64 * 64 - before;
  }

  std::string head(std::uint64_t points) const override {
    const auto [width, height] = shape_.of(points);
    std::string shape = height == 1 ? "" : std::to_string(height) + ", ";
    shape += std::to_string(width) + ", " + (columns_ == 0 ? "" : std::to_string(columns_) + ", ");
    std::string text = dictionary(shape);
    text.resize(head_bytes_ - 1, ' ');
    std::string begin("\x93NUMPY");
    begin += static_cast<char>(version_);
    begin += '\0';
    for (std::size_t i = 0; i < (version_ == 1 ? 2U : 4U); ++i) {
      begin += static_cast<char>((head_bytes_ >> (8 * i)) & 0xFFU);
    }
    return begin + text + "\n";
  }

  std::string rows(const PointRecords& more) override {
    shape_.add(more);
    return {reinterpret_cast<const char*>(more.bytes.data()), more.bytes.size()};
  }

 private:
  [[nodiscard]] std::string dictionary(const std::string& shape) const {
    return "{'descr': " + descr_ + ", 'fortran_order': False, 'shape': (" + shape + "), }";
  }

  std::string descr_;
  std::size_t columns_ = 0;  ///< Of an array of numbers of one type, else 0.
  int version_ = 1;
  std::size_t head_bytes_ = 0;
  WrittenShape shape_;
};

std::unique_ptr<RecordEncoder> npy_encoder(const std::filesystem::path&, const RecordWriting&) {
  return std::make_unique<NpyEncoder>();
}

std::vector<std::string> lost_in_npy(const RecordLayout& layout) {
  const std::vector<std::string> wanted = names_of(layout);
  return renamed_sentences(wanted, fitting_names(wanted, npy_names()));
}

}  // namespace

CloudFormat npy_format() {
  return {".npy", read_npy_cloud, read_npy_records, npy_encoder, lost_in_npy};
}

CloudFormat npz_format() {
  CloudFormat format{".npz", read_npz_cloud, read_npz_records, npy_encoder, lost_in_npy};
  format.wrap = npz_of;
  return format;
}

}  // namespace raymoval
