// SPDX-License-Identifier: MIT
#include "datasets/clouds/bin/bin_file.h"

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/format/point_layout.h"
#include "datasets/clouds/format/stored_points.h"

namespace raymoval {
namespace {

StoredPoints bin_points(const CloudBytes& file) {
  const RecordLayout layout = bin_layout(file.reading.point_layout);
  check_bin_rows(file.path, file.text.size(), layout);
  StoredPoints stored{file.text, {}, file.text.size() / layout.row_bytes, layout.row_bytes};
  for (const PointField& field : layout.fields) {
    stored.columns.push_back({field, field.offset, layout.row_bytes, false});
  }
  return stored;
}

Cloud read_bin_cloud(const CloudBytes& file, const Eigen::Vector3d& origin) {
  return cloud_of(bin_points(file), origin, file.path.string());
}

PointRecords read_bin_records(const CloudBytes& file) {
  PointRecords records = records_of(bin_points(file));
  records.layout.unnamed = true;
  return records;
}

class BinEncoder : public RecordEncoder {
 public:
  void start(const PointRecords&) override {}
  std::string head(std::uint64_t) const override { return ""; }
  std::string rows(const PointRecords& more) override {
    return {reinterpret_cast<const char*>(more.bytes.data()), more.bytes.size()};
  }
};

std::vector<std::string> lost_in_bin(const RecordLayout& layout) {
  RecordLayout usual = bin_layout(std::nullopt);
  usual.unnamed = layout.unnamed;
  if (layout == usual) return {};
  return {
      "A .bin file does not hold the names and types of its fields: read it again with "
      "--point-layout \"" +
      point_layout_text(layout) + "\"."};
}

/// " Rows of 20 bytes (5 float32 numbers) or ... would fit", for sizes that the field uses.
std::string fitting_sizes(std::uintmax_t bytes) {
  std::vector<std::string> sizes;
  for (std::uintmax_t floats = 3; floats <= 8 && bytes > 0; ++floats) {
    if (bytes % (4 * floats) != 0) continue;
    sizes.push_back(std::to_string(4 * floats) + " (" + std::to_string(floats) + " float32)");
  }
  if (sizes.empty()) return "";
  return " It would fit points of " + join(sizes, " or ") +
         " bytes: if they are such, name their fields with --point-layout.";
}

}  // namespace

void check_bin_rows(const std::filesystem::path& path, std::uintmax_t bytes,
                    const RecordLayout& layout) {
  const std::size_t row = layout.row_bytes;
  if (bytes % row == 0 && bytes / row <= kMostCloudPoints) return;
  const RecordLayout usual = bin_layout(std::nullopt);
  throw DataError(path.string() + ": " + grouped_text(bytes) + " bytes is not a multiple of " +
                  std::to_string(row) + " (" +
                  (layout == usual ? "x y z reflectance as float32" : point_layout_text(layout)) +
                  "); the file looks truncated after point " + grouped_text(bytes / row) +
                  ". Copy it again, or leave it out with --frames." + fitting_sizes(bytes));
}

CloudFormat bin_format() {
  const auto encoder = [](const std::filesystem::path&,
                          const RecordWriting&) -> std::unique_ptr<RecordEncoder> {
    return std::make_unique<BinEncoder>();
  };
  CloudFormat format{".bin", read_bin_cloud, read_bin_records, encoder, lost_in_bin};
  format.read_layout = [](const std::filesystem::path&, const RecordReading& reading) {
    return bin_layout(reading.point_layout);
  };
  return format;
}

}  // namespace raymoval
