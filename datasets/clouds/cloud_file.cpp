// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_file.h"

#include <map>
#include <utility>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"
#include "datasets/clouds/poses.h"

namespace raymoval {
namespace {

[[noreturn]] void throw_unknown(const std::filesystem::path& path,
                                const std::vector<std::string>& known) {
  if (const std::string text = conversion_text(path); !text.empty()) {
    throw UsageError(path.string() + ": " + text);
  }
  throw UsageError(path.string() + ": '" + path.extension().string() +
                   "' is not a known cloud format. Supported are: " + join(known) + ".");
}

/// The known formats, the usual first.
const std::vector<CloudFormat>& cloud_formats() {
  static const std::vector<CloudFormat> formats = {pcd_format(), ply_format(), bin_format(),
                                                   las_format(), npy_format(), npz_format()};
  return formats;
}

/// Refuses the pointer file of git-lfs for a file that was not fetched.
void check_no_pointer(const std::filesystem::path& path, std::string_view text) {
  if (!text.starts_with("version https://git-lfs.github.com/spec/")) return;
  throw DataError(path.string() +
                  ": is a pointer of git-lfs to the file, which was not fetched. Fetch it: `git "
                  "lfs pull`.");
}

/// Calls `read` with the content of a file of points.
template <class Read>
auto read_whole(const std::filesystem::path& path, const RecordReading& reading, Read&& read) {
  const std::vector<std::byte> bytes = read_bytes(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  check_no_pointer(path, text);
  return read(CloudBytes{path, text, reading});
}

}  // namespace

std::string conversion_text(const std::filesystem::path& path) {
  const auto each_scan = [](const std::string& ending) {
    return "CloudCompare writes each of its scans as a file: CloudCompare -SILENT -C_EXPORT_FMT "
           "PLY -O in." +
           ending + " -SAVE_CLOUDS.";
  };
  static const std::string kTable =
      "clouds as text are not read or written. NumPy converts them: numpy.save(\"out.npy\", "
      "numpy.loadtxt(\"in.txt\", \"f4\")), with delimiter=\",\" for commas and skiprows=1 for a "
      "line of names.";
  static const std::map<std::string, std::string> texts = {
      {".laz",
       "LAZ, compressed LAS, is not read or written. Decompress it first: laszip -i in.laz -o "
       "out.las, or pdal translate in.laz out.las."},
      {".gz", "compressed files are not read. Decompress them: gunzip in.gz."},
      {".e57", "E57 is not read. " + each_scan("e57")},
      {".ptx", "PTX is not read. " + each_scan("ptx")},
      {".pts", "PTS is not read. " + each_scan("pts")},
      {".pcap",
       "the packets of a sensor are not read. Ouster's SDK makes a recording of them (ouster-cli "
       "source in.pcap save out.bag), for other sensors their ROS driver with `rosbag record`."},
      {".osf",
       "OSF is not read. Ouster's SDK makes a recording of it: ouster-cli source in.osf save "
       "out.bag."},
      {".feather",
       "feather (Argoverse 2) is not read. pandas converts it: pandas.read_feather(\"in.feather\")"
       "[[\"x\", \"y\", \"z\", \"intensity\"]].to_numpy(\"f4\").tofile(\"out.bin\")."},
      {".xyz", kTable},
      {".asc", kTable},
      {".txt", kTable},
      {".csv", kTable}};
  const std::string extension = in_lower_case(path.extension().string());
  // Other tables have names, such as poses.txt.
  const bool is_table = extension == ".txt" || extension == ".csv";
  if (is_table && !all_digits(path.stem().string())) return "";
  if (extension == ".gz" && cloud_extension(path.stem()).empty()) return "";
  const auto found = texts.find(extension);
  return found == texts.end() ? "" : found->second;
}

const std::vector<std::string>& cloud_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> all;
    for (const CloudFormat& format : cloud_formats()) all.push_back(format.extension);
    return all;
  }();
  return extensions;
}

const std::vector<std::string>& written_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> all;
    for (const CloudFormat& format : cloud_formats()) {
      if (format.encoder != nullptr) all.push_back(format.extension);
    }
    return all;
  }();
  return extensions;
}

std::string cloud_extension(const std::filesystem::path& path) {
  const std::string name = in_lower_case(path.filename().string());
  for (const std::string& extension : cloud_extensions()) {
    if (name.size() > extension.size() && name.ends_with(extension)) return extension;
  }
  return "";
}

std::string cloud_stem(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const std::string extension = cloud_extension(path);
  return extension.empty() ? path.stem().string() : name.substr(0, name.size() - extension.size());
}

namespace {

/// @throws UsageError naming the supported endings if the ending of `path` is not among them
const CloudFormat& format_read(const std::filesystem::path& path) {
  const std::string extension = cloud_extension(path);
  for (const CloudFormat& format : cloud_formats()) {
    if (format.extension == extension) return format;
  }
  throw_unknown(path, cloud_extensions());
}

/// @throws UsageError naming the supported endings if the ending of `path` is not among them
const CloudFormat& format_written(const std::filesystem::path& path) {
  for (const CloudFormat& format : cloud_formats()) {
    if (format.encoder != nullptr && path.extension() == format.extension) return format;
  }
  throw_unknown(path, written_extensions());
}

}  // namespace

Cloud read_cloud(const std::filesystem::path& path, const Eigen::Vector3d& origin,
                 const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  return read_whole(path, reading,
                    [&](const CloudBytes& file) { return format.read_cloud(file, origin); });
}

PointRecords read_records(const std::filesystem::path& path, const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  return read_whole(path, reading,
                    [&](const CloudBytes& file) { return format.read_records(file); });
}

RecordLayout read_layout(const std::filesystem::path& path, const RecordReading& reading) {
  const CloudFormat& format = format_read(path);
  return format.read_layout != nullptr ? format.read_layout(path, reading)
                                       : read_records(path, reading).layout;
}

Pose read_viewpoint(const std::filesystem::path& path) {
  const auto viewpoint = parse_pcd_header(read_piece(path, 0, 65536), path).viewpoint;
  if (!viewpoint) {
    throw DataError(path.string() + ": the header has no VIEWPOINT; expected the sensor pose as " +
                    "tx ty tz qw qx qy qz.");
  }
  return rigid_pose(viewpoint->head<3>(), viewpoint->tail<4>(), path.string() + ": VIEWPOINT");
}

std::vector<std::string> format_losses(const std::filesystem::path& path,
                                       const RecordLayout& layout) {
  return format_written(path).lost(layout);
}

void check_coordinates(const std::filesystem::path& path, Coordinates coordinates) {
  if (coordinates == Coordinates::kFloat || path.extension() != ".bin") return;
  throw UsageError(path.string() +
                   ": a .bin file holds float32 numbers only, which lose more than a millimetre "
                   "more than 8 km from the world's origin, where this map lies. Name a .pcd or "
                   ".ply file, which then holds float64, or shift the poses.");
}

std::string whole_file(const std::filesystem::path& path, const PointRecords& records) {
  (void)position_fields(records.layout, path.string());
  const auto encoder = format_written(path).encoder(path);
  encoder->start(records);
  const std::string body = encoder->rows(records);
  return encoder->head(records.size()) + body;
}

PointRecordWriter::PointRecordWriter(const std::filesystem::path& path)
    : encoder_(format_written(path).encoder(path)), file_(path) {}

void PointRecordWriter::start(const RecordLayout& layout) {
  (void)position_fields(layout, file_.path().string());
  layout_ = layout;
}

/// The head may depend on the first points.
void PointRecordWriter::begin(const PointRecords& first) {
  if (std::exchange(begun_, true)) return;
  encoder_->start(first);
  file_.append(encoder_->head(0));
}

void PointRecordWriter::add(const PointRecords& rows) {
  if (rows.layout.fields != layout_.fields || rows.layout.row_bytes != layout_.row_bytes) {
    throw InternalError("points of another layout are written to " + file_.path().string());
  }
  points_ += rows.size();
  if (points_ > kMostCloudPoints) {
    throw DataError(file_.path().string() + ": more than " + grouped_text(kMostCloudPoints) +
                    " points, which no reader takes. Nothing was changed; choose fewer frames or "
                    "a voxel size.");
  }
  begin(rows);
  file_.append(encoder_->rows(rows));
}

void PointRecordWriter::finish() {
  PointRecords none;
  none.layout = layout_;
  begin(none);
  file_.overwrite(0, encoder_->head(points_));
  file_.sync();
}

}  // namespace raymoval
