// SPDX-License-Identifier: MIT
#include <zip.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/field_names.h"
#include "datasets/clouds/format/stored_points.h"
#include "datasets/clouds/numpy/npy_head.h"

namespace raymoval {
namespace {

/// The points of an array.
struct NpyPoints {
  StoredPoints stored;
  std::uint64_t width = 0, height = 1;
  bool unnamed = false;  ///< As in `RecordLayout`.
};

/// The names and counts of `columns` columns of an array.
std::vector<PointField> column_fields(const CloudBytes& file, std::uint64_t columns) {
  if (file.reading.point_layout) {
    std::vector<PointField> fields = point_layout_fields(*file.reading.point_layout);
    std::uint64_t values = 0;
    for (const PointField& field : fields) values += static_cast<std::uint64_t>(field.count);
    if (values != columns) {
      throw UsageError(file.path.string() + ": the point layout \"" + *file.reading.point_layout +
                       "\" names " + grouped_text(values) + " columns, but the array has " +
                       grouped_text(columns) + ".");
    }
    return fields;
  }
  std::vector<PointField> fields;
  for (std::uint64_t i = 0; i < columns; ++i) {
    static constexpr const char* kNames[] = {"x", "y", "z", "intensity"};
    fields.push_back({i < 4 ? kNames[i] : "field_" + std::to_string(i)});
  }
  return fields;
}

/// Columns of an array of numbers of one type.
void add_number_columns(const CloudBytes& file, const NpyHead& head, std::uint64_t columns,
                        StoredPoints& stored) {
  const NpyField& number = head.type.fields.front();
  const auto size = static_cast<std::size_t>(number.field.size);
  std::size_t at = 0;
  for (const PointField& named : column_fields(file, columns)) {
    PointField field{named.name, number.field.type, number.field.size, named.count, size * at};
    if (head.by_columns && field.count != 1) {
      throw UsageError(file.path.string() +
                       ": the array is stored by columns; name each of them in the point layout.");
    }
    if (field.name == "_") field.name.clear();
    stored.columns.push_back({field, field.offset * (head.by_columns ? stored.points : 1),
                              head.by_columns ? size : stored.row_bytes, number.big_endian});
    at += static_cast<std::size_t>(field.count);
  }
}

void check_plain_shape(const CloudBytes& file, const NpyHead& head) {
  const bool rows = head.shape.size() == 2 || (head.shape.size() == 3 && !head.by_columns);
  const bool one_number = head.type.fields.size() == 1 && head.type.fields[0].field.count == 1;
  if (rows && one_number && head.shape.back() >= 3 && head.shape.back() <= 4096) return;
  throw DataError(file.path.string() + ": the array is " + head.shape_text() +
                  (head.by_columns ? " (by columns)" : "") +
                  "; expected N x 3 numbers or more (x y z intensity), or N items with the fields "
                  "x, y and z. Transpose it, or stack its columns.");
}

/// @throws DataError if the size of the array is not the number of bytes
void check_bytes(const CloudBytes& file, const NpyHead& head, std::uint64_t points,
                 std::uint64_t row_bytes) {
  const std::uint64_t bytes = head.body.size();
  if (points <= kMostCloudPoints && points * row_bytes == bytes) return;
  const bool cut = points > bytes / row_bytes;
  throw DataError(
      file.path.string() + ": the array is " + head.shape_text() + ", " +
      std::to_string(row_bytes) + " bytes a point, but " + grouped_text(bytes) +
      " bytes follow its head; the file looks " +
      (cut ? std::string("truncated.") + kRereadRemedy : "like several, and only one is read."));
}

/// @throws DataError naming an invalid part of the head, or a wrong number of bytes; UsageError if
///   the point layout does not fit the array
NpyPoints npy_points(const CloudBytes& file) {
  const NpyHead head = npy_head(file);
  const bool structured = head.type.structured;
  std::vector<std::uint64_t> lengths = head.shape;
  std::uint64_t columns = 1;
  if (!structured) {
    check_plain_shape(file, head);
    columns = lengths.back();
    lengths.pop_back();
  } else if (lengths.empty() || lengths.size() > 2 || (lengths.size() == 2 && head.by_columns)) {
    throw DataError(file.path.string() + ": the array of fields is " + head.shape_text() +
                    (head.by_columns ? " by columns" : "") +
                    "; expected N items, or rows of them.");
  }
  NpyPoints result;
  result.unnamed = !structured;
  result.width = lengths.back();
  result.height = lengths.size() == 2 ? lengths[0] : 1;
  StoredPoints& stored = result.stored;
  stored.bytes = head.body;
  stored.points = result.width * result.height;
  stored.row_bytes = head.type.bytes * columns;
  if (stored.row_bytes == 0) {
    throw DataError(file.path.string() + ": the items of the array have no bytes.");
  }
  check_bytes(file, head, stored.points, stored.row_bytes);
  if (structured) {
    for (const NpyField& field : head.type.fields) {
      stored.columns.push_back(
          {field.field, field.field.offset, stored.row_bytes, field.big_endian});
    }
  } else {
    add_number_columns(file, head, columns, stored);
  }
  return result;
}

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

/// Limit of the decompressed size. Deflate cannot give more than 1,032 times its bytes.
std::uint64_t most_decompressed(std::uint64_t packed) {
  return std::min<std::uint64_t>(std::uint64_t{1} << 30, packed * 1000 + (1 << 20));
}

/// @throws DataError if `packed` deflated bytes cannot decompress to `unpacked` bytes within the
///   limit: 1 GiB, and 1,000 times the compressed bytes plus 1 MiB
/// @param where begins the message
void check_decompressed(std::uint64_t packed, std::uint64_t unpacked, const std::string& where) {
  if (unpacked <= most_decompressed(packed)) return;
  throw DataError(where + ": decompresses to more than " + grouped_text(most_decompressed(packed)) +
                  " bytes, the limit for " + grouped_text(packed) +
                  " compressed ones (1,000 times as many and 1 MiB, at most 1 GiB). Decompress it "
                  "yourself if you trust it.");
}

/// A zip archive in memory, by libzip.
class ZipArchive {
 public:
  /// @throws DataError if it is no whole archive
  ZipArchive(std::string_view bytes, const std::string& where) : where_(where) {
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
    if (source == nullptr) throw std::bad_alloc();
    archive_ = zip_open_from_source(source, ZIP_RDONLY, &error);
    if (archive_ != nullptr) return;
    zip_source_free(source);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw DataError(where_ + ": the zip archive cannot be read (" + reason +
                    "); it looks truncated, or is not a zip archive." + kRereadRemedy);
  }
  ~ZipArchive() { zip_discard(archive_); }
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (zip_uint64_t i = 0; zip_int64_t(i) < zip_get_num_entries(archive_, 0); ++i) {
      const char* name = zip_get_name(archive_, i, ZIP_FL_ENC_RAW);
      names.emplace_back(name == nullptr ? "" : name);
    }
    return names;
  }

  /// The content of the file `name`.
  /// @throws DataError if it is damaged (its checksum is compared), encrypted, or compressed in a
  ///   way that is not supported; as `check_decompressed`
  [[nodiscard]] std::string content(const std::string& name) const {
    zip_stat_t about;
    if (zip_stat(archive_, name.c_str(), ZIP_FL_ENC_RAW, &about) != 0) fail(name);
    if (about.encryption_method != ZIP_EM_NONE) {
      throw DataError(where_ + ": " + name + " is encrypted. Save it without a password.");
    }
    check_decompressed(about.comp_size, about.size, where_ + ": " + name);
    const auto close = [](zip_file_t* file) { zip_fclose(file); };
    const std::unique_ptr<zip_file_t, decltype(close)> file(
        zip_fopen_index(archive_, about.index, 0));
    if (!file) fail(name);
    std::string content(about.size, '\0');
    char beyond = 0;  // Reading beyond the end compares the checksum.
    const bool whole = zip_fread(file.get(), content.data(), content.size()) ==
                           static_cast<zip_int64_t>(content.size()) &&
                       zip_fread(file.get(), &beyond, 1) == 0;
    if (!whole) fail(name);
    return content;
  }

 private:
  [[noreturn]] void fail(const std::string& name) const {
    throw DataError(where_ + ": " + name +
                    " in the zip archive is damaged, or has an unsupported compression. Copy it "
                    "again, or save it again by numpy.savez.");
  }

  std::string where_;
  zip_t* archive_ = nullptr;
};

/// Calls `read` with the array of an archive that holds the points.
template <class Read>
auto read_chosen(const CloudBytes& file, Read&& read) {
  const std::string where = file.path.string();
  const ZipArchive archive(file.text, where);
  std::vector<std::string> names;
  for (std::string& name : archive.names()) {
    if (name.ends_with(".npy")) names.push_back(name.substr(0, name.size() - 4));
  }
  std::string chosen = names.size() == 1 ? names.front() : "";
  for (const char* usual : {"arr_0", "points"}) {
    if (std::find(names.begin(), names.end(), usual) != names.end()) chosen = usual;
  }
  if (chosen.empty()) {
    names.resize(std::min<std::size_t>(names.size(), 20));
    throw DataError(where + ": holds " +
                    (names.empty() ? "no array" : "the arrays " + join(names)) +
                    "; expected one array, or one named points or arr_0. Save the points under "
                    "such a name.");
  }
  const std::string content = archive.content(chosen + ".npy");
  const std::filesystem::path place = where + ": " + chosen;
  return read(CloudBytes{place, content, file.reading});
}

std::string type_text(const PointField& field) {
  return (field.size == 1 ? "'|" : "'<") +
         std::string(1, static_cast<char>(field.type - 'A' + 'a')) + std::to_string(field.size) +
         "'";
}

std::string quoted(const std::string& name) {
  std::string text = "'";
  for (const char c : name) {
    if (c == '\'' || c == '\\') text += '\\';
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') {
      char escape[5];
      (void)std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned>(c) & 0xFFU);
      text += escape;
    } else {
      text += c;
    }
  }
  return text + "'";
}

/// Whether rows of `layout` are numbers of one type without stored names.
bool is_plain_array(const RecordLayout& layout) {
  if (!layout.unnamed || layout.fields.empty()) return false;
  std::size_t at = 0;
  for (const PointField& field : layout.fields) {
    const PointField& first = layout.fields.front();
    if (field.type != first.type || field.size != first.size || field.offset != at) return false;
    at += field.bytes();
  }
  return at == layout.row_bytes;
}

/// The text of "descr" for rows of `layout`: a plain type for a plain array, else a list of fields.
/// @param names of the fields in the file
std::string npy_descr(const RecordLayout& layout, const std::vector<std::string>& names) {
  if (is_plain_array(layout)) return type_text(layout.fields.front());
  std::string text = "[";
  std::size_t at = 0;
  const auto fill = [&](std::size_t end) {
    if (end > at) text += "('', '|V" + std::to_string(end - at) + "'), ";
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PointField& field = layout.fields[i];
    fill(field.offset);
    text += "(" + quoted(names[i]) + ", " + type_text(field) +
            (field.count == 1 ? "" : ", (" + std::to_string(field.count) + ",)") + "), ";
    at = field.offset + field.bytes();
  }
  fill(layout.row_bytes);
  return text.substr(0, text.size() - 2) + "]";
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
    // The longest possible shape leaves room for all others.
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
    return RecordEncoder::rows(more);
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

std::vector<std::string> lost_in_npy(const RecordLayout& layout) {
  const std::vector<std::string> wanted = names_of(layout);
  return renamed_sentences(wanted, fitting_names(wanted, npy_names()));
}

}  // namespace

CloudFormat npy_format() {
  CloudFormat format{".npy", read_npy_cloud, read_npy_records};
  format.encoder = [](const std::filesystem::path&) -> std::unique_ptr<RecordEncoder> {
    return std::make_unique<NpyEncoder>();
  };
  format.lost = lost_in_npy;
  return format;
}

CloudFormat npz_format() {
  CloudFormat format{".npz"};
  format.read_cloud = [](const CloudBytes& file, const Eigen::Vector3d& origin) {
    return read_chosen(file,
                       [&](const CloudBytes& array) { return read_npy_cloud(array, origin); });
  };
  format.read_records = [](const CloudBytes& file) { return read_chosen(file, read_npy_records); };
  return format;
}

}  // namespace raymoval
