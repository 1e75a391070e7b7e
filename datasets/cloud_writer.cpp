// SPDX-License-Identifier: MIT
#include "datasets/cloud_writer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/error.h"
#include "core/text.h"
#include "datasets/cloud_file.h"
#include "datasets/cloud_header.h"

namespace raymoval {
namespace {

static_assert(std::endian::native == std::endian::little, "cloud files are little-endian");

constexpr std::size_t kMostDigits = 10;

/// As many blanks as `count` lacks digits, `times` over.
std::string filler(std::uint64_t count, std::size_t times) {
  return std::string((kMostDigits - std::to_string(count).size()) * times, ' ');
}

std::string pcd_header(std::uint64_t points, bool with_intensity) {
  const std::string count = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\n# Written by raymoval" + filler(points, 2) +
         "\nVERSION 0.7\nFIELDS x y z" +
         (with_intensity ? " intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
                         : "\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n") +
         "WIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count +
         "\nDATA binary\n";
}

std::string ply_header(std::uint64_t points, bool with_intensity) {
  return "ply\nformat binary_little_endian 1.0\ncomment Written by raymoval" + filler(points, 1) +
         "\nelement vertex " + std::to_string(points) +
         "\nproperty float x\nproperty float y\nproperty float z\n" +
         (with_intensity ? "property float intensity\n" : "") + "end_header\n";
}

const std::filesystem::path& checked(const std::filesystem::path& path) {
  const std::vector<std::string>& known = cloud_extensions();
  if (std::find(known.begin(), known.end(), path.extension().string()) != known.end()) return path;
  throw UsageError(path.string() + ": '" + path.extension().string() +
                   "' is no known cloud format. Supported are: " + join(known) + ".");
}

void append(std::string& bytes, float value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace

CloudWriter::CloudWriter(const std::filesystem::path& path)
    : file_(checked(path)), extension_(path.extension().string()) {}

std::string CloudWriter::header() const {
  if (extension_ == ".pcd") return pcd_header(points_, with_intensity_);
  return extension_ == ".ply" ? ply_header(points_, with_intensity_) : "";
}

void CloudWriter::start(bool with_intensity) {
  with_intensity_ = with_intensity || extension_ == ".bin";
  file_.append(header());
}

void CloudWriter::add(const std::vector<Eigen::Vector3f>& points,
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
  bytes.reserve(points.size() * 4 * sizeof(float));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const float coordinate : points[i]) append(bytes, coordinate);
    if (with_intensity_) append(bytes, intensity.empty() ? 0.0F : intensity[i]);
  }
  file_.append(bytes);
}

void CloudWriter::finish() {
  file_.overwrite(0, header());
  file_.sync();
}

}  // namespace raymoval
