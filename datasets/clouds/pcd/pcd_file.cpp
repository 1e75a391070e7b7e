// SPDX-License-Identifier: MIT
#include "datasets/clouds/pcd/pcd_file.h"

#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "datasets/clouds/format/ascii_rows.h"
#include "datasets/clouds/format/header_rows.h"
#include "datasets/clouds/format/stored_points.h"
#include "datasets/clouds/pcd/lzf_block.h"
#include "datasets/clouds/pcd/pcd_encoder.h"
#include "datasets/clouds/pcd/pcd_header.h"

// PCL's own readers are not used. They trust counts in a header (a damaged file ends the program),
// read garbage in ASCII files as zero, and report on the console; and the library loads VTK, which
// takes longer to start than this program. What it compresses is LZF.

namespace raymoval {
namespace {

/// The points of a compressed body: all values of a field after one another, padding left out.
/// @param data is filled with what is unpacked
StoredPoints compressed_points(const CloudHeader& header, std::string_view body,
                               const std::filesystem::path& path, std::string& data) {
  StoredPoints stored{{}, {}, header.points, header.row_bytes()};
  std::uint64_t bytes = 0;
  for (const PointField& field : header.fields) {
    if (is_padding(field)) continue;
    stored.columns.push_back({field, bytes, field.bytes(), false});
    bytes += field.bytes() * header.points;
  }
  data = unpack_lzf_block(body, bytes, path);
  stored.bytes = data;
  return stored;
}

Cloud read_pcd_cloud(const CloudBytes& file, const Eigen::Vector3d& origin) {
  const CloudHeader header = parse_pcd_header(file.text, file.path);
  const std::string_view body = file.text.substr(header.body_offset);
  if (header.encoding == CloudEncoding::kAscii) {
    return ascii_cloud(header, body, file.path, origin);
  }
  std::string unpacked;
  const StoredPoints stored = header.encoding == CloudEncoding::kBinary
                                  ? binary_points(header, body, file.path)
                                  : compressed_points(header, body, file.path, unpacked);
  return cloud_of(stored, origin, file.path.string());
}

PointRecords read_pcd_records(const CloudBytes& file) {
  const CloudHeader header = parse_pcd_header(file.text, file.path);
  const std::string_view body = file.text.substr(header.body_offset);
  PointRecords records;
  if (header.encoding == CloudEncoding::kAscii) {
    records = ascii_records(header, body, file.path);
  } else if (header.encoding == CloudEncoding::kBinary) {
    records = records_of(binary_points(header, body, file.path));
  } else {
    std::string unpacked;
    records = records_of(compressed_points(header, body, file.path, unpacked));
  }
  records.width = header.width;
  records.height = header.height;
  records.viewpoint = header.viewpoint;
  records.form.text = header.encoding == CloudEncoding::kAscii;
  records.form.packed = header.encoding == CloudEncoding::kCompressed;
  return records;
}

RecordLayout read_pcd_layout(const std::filesystem::path& path, const RecordReading&) {
  constexpr std::size_t kUsualHead = 4096;
  std::string text = read_piece(path, 0, kUsualHead);
  auto header = if_whole([&] { return parse_pcd_header(text, path); });
  if (!header) {
    text = read_text(path);
    header = parse_pcd_header(text, path);
  }
  RecordLayout layout;
  layout.row_bytes = header->row_bytes();
  for (const PointField& field : header->fields) {
    if (!is_padding(field)) layout.fields.push_back(field);
  }
  return layout;
}

}  // namespace

CloudFormat pcd_format() {
  const auto encoder = [](const std::filesystem::path&, const RecordWriting& writing) {
    return pcd_encoder(writing.form);
  };
  CloudFormat format{".pcd", read_pcd_cloud, read_pcd_records, encoder, lost_in_pcd};
  format.read_layout = read_pcd_layout;
  return format;
}

}  // namespace raymoval
