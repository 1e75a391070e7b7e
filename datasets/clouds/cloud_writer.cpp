// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_writer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {
namespace {

static_assert(std::endian::native == std::endian::little, "cloud files are little-endian");

constexpr std::size_t kMostDigits = 10;

/// As many blanks as `count` lacks digits, `times` over.
std::string filler(std::uint64_t count, std::size_t times) {
  return std::string((kMostDigits - std::to_string(count).size()) * times, ' ');
}

std::string pcd_header(std::uint64_t points, bool with_intensity, Coordinates coordinates) {
  const std::string count = std::to_string(points);
  const std::string size = coordinates == Coordinates::kDouble ? "8 8 8" : "4 4 4";
  return "# .PCD v0.7 - Point Cloud Data file format\n# Written by raymoval" + filler(points, 2) +
         "\nVERSION 0.7\nFIELDS x y z" + (with_intensity ? " intensity" : "") + "\nSIZE " + size +
         (with_intensity ? " 4\nTYPE F F F F\nCOUNT 1 1 1 1\n" : "\nTYPE F F F\nCOUNT 1 1 1\n") +
         "WIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count +
         "\nDATA binary\n";
}

std::string ply_header(std::uint64_t points, bool with_intensity, Coordinates coordinates) {
  const std::string type = coordinates == Coordinates::kDouble ? "double" : "float";
  return "ply\nformat binary_little_endian 1.0\ncomment Written by raymoval" + filler(points, 1) +
         "\nelement vertex " + std::to_string(points) + "\nproperty " + type + " x\nproperty " +
         type + " y\nproperty " + type + " z\n" +
         (with_intensity ? "property float intensity\n" : "") + "end_header\n";
}

const std::filesystem::path& checked(const std::filesystem::path& path) {
  const std::vector<std::string>& known = cloud_extensions();
  if (std::find(known.begin(), known.end(), path.extension().string()) != known.end()) return path;
  throw UsageError(path.string() + ": '" + path.extension().string() +
                   "' is no known cloud format. Supported are: " + join(known) + ".");
}

template <class Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace

void check_coordinates(const std::filesystem::path& path, Coordinates coordinates) {
  if (coordinates == Coordinates::kFloat || path.extension() != ".bin") return;
  throw UsageError(path.string() +
                   ": a .bin file holds float32 numbers only, which lose more than a millimetre "
                   "more than 8 km from the world's origin, where this map lies. Name a .pcd or "
                   ".ply file, which then holds float64, or shift the poses.");
}

CloudWriter::CloudWriter(const std::filesystem::path& path)
    : file_(checked(path)), extension_(path.extension().string()) {}

std::string CloudWriter::header() const {
  if (extension_ == ".pcd") return pcd_header(points_, with_intensity_, coordinates_);
  return extension_ == ".ply" ? ply_header(points_, with_intensity_, coordinates_) : "";
}

void CloudWriter::start(bool with_intensity, Coordinates coordinates) {
  check_coordinates(file_.path(), coordinates);
  coordinates_ = coordinates;
  with_intensity_ = with_intensity || extension_ == ".bin";
  file_.append(header());
}

template <class Point>
void CloudWriter::add_points(const std::vector<Point>& points,
                             const std::vector<float>& intensity) {
  if (!intensity.empty() && intensity.size() != points.size()) {
    throw InternalError("a cloud of " + std::to_string(points.size()) + " points has " +
                        std::to_string(intensity.size()) + " intensities");
  }
  points_ += points.size();
  if (points_ > kMostCloudPoints) {
    throw DataError(file_.path().string() + ": more than " + grouped_text(kMostCloudPoints) +
                    " points, which no reader takes. Nothing was changed; choose fewer frames or a "
                    "voxel size.");
  }
  std::string bytes;
  bytes.reserve(points.size() * (3 * sizeof(double) + sizeof(float)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const auto coordinate : points[i]) {
      if (coordinates_ == Coordinates::kDouble) {
        append(bytes, static_cast<double>(coordinate));
      } else {
        append(bytes, static_cast<float>(coordinate));
      }
    }
    if (with_intensity_) append(bytes, intensity.empty() ? 0.0F : intensity[i]);
  }
  file_.append(bytes);
}

void CloudWriter::add_exact(const std::vector<Eigen::Vector3d>& points,
                            const std::vector<float>& intensity) {
  add_points(points, intensity);
}

void CloudWriter::add(const std::vector<Eigen::Vector3f>& points,
                      const std::vector<float>& intensity) {
  add_points(points, intensity);
}

void CloudWriter::finish() {
  file_.overwrite(0, header());
  file_.sync();
}

void write_cloud(const std::filesystem::path& path, const std::vector<Eigen::Vector3f>& points,
                 const std::vector<float>& intensity) {
  CloudWriter file(path);
  file.start(!intensity.empty());
  file.add(points, intensity);
  file.finish();
  file.commit();
}

}  // namespace raymoval
