// SPDX-License-Identifier: MIT
#include "datasets/clouds/formats.h"

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/bin/bin_file.h"
#include "datasets/clouds/las/las_file.h"
#include "datasets/clouds/numpy/npy_file.h"
#include "datasets/clouds/pcd/pcd_file.h"
#include "datasets/clouds/ply/ply_file.h"

namespace raymoval {
namespace {

/// Behind the ending of a file that is packed with gzip.
constexpr const char* kPacked = ".gz";

[[noreturn]] void throw_unknown(const std::filesystem::path& path,
                                const std::vector<std::string>& known) {
  if (path.extension() == ".laz") {
    throw UsageError(path.string() +
                     ": LAZ, compressed LAS, is not read or written. Unpack it first: laszip -i "
                     "in.laz -o out.las, or pdal translate in.laz out.las.");
  }
  throw UsageError(path.string() + ": '" + path.extension().string() +
                   "' is no known cloud format. Supported are: " + join(known) + ".");
}

}  // namespace

const std::vector<CloudFormat>& cloud_formats() {
  // A line for each format.
  static const std::vector<CloudFormat> formats = {pcd_format(), ply_format(), bin_format(),
                                                   las_format(), npy_format(), npz_format()};
  return formats;
}

const std::vector<std::string>& cloud_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> all;
    for (const CloudFormat& format : cloud_formats()) all.push_back(format.extension);
    for (const CloudFormat& format : cloud_formats()) all.push_back(format.extension + kPacked);
    return all;
  }();
  return extensions;
}

const std::vector<std::string>& written_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> all;
    for (const CloudFormat& format : cloud_formats()) {
      if (format.wrap == nullptr) all.push_back(format.extension);
    }
    return all;
  }();
  return extensions;
}

std::string cloud_extension(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
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

bool is_packed(const std::filesystem::path& path) {
  return cloud_extension(path).ends_with(kPacked);
}

const CloudFormat& format_read(const std::filesystem::path& path) {
  std::string extension = cloud_extension(path);
  if (is_packed(path)) extension.resize(extension.size() - std::string_view(kPacked).size());
  for (const CloudFormat& format : cloud_formats()) {
    if (format.extension == extension) return format;
  }
  throw_unknown(path, cloud_extensions());
}

const CloudFormat& format_written(const std::filesystem::path& path) {
  for (const CloudFormat& format : cloud_formats()) {
    if (format.wrap == nullptr && path.extension() == format.extension) return format;
  }
  throw_unknown(path, written_extensions());
}

}  // namespace raymoval
