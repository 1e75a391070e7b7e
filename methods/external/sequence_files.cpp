// SPDX-License-Identifier: MIT
#include "methods/external/sequence_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"

static_assert(std::endian::native == std::endian::little, "files hold little-endian numbers");

namespace raymoval::external_method {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double kGib = 1024.0 * 1024.0 * 1024.0;

void write_file(const fs::path& path, const void* data, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  file.close();
  if (!file) {
    throw DataError(path.string() +
                    ": cannot be written; the disk may be full. Set TMPDIR to a folder with space "
                    "(20 bytes a point are needed).");
  }
}

void write_file(const fs::path& path, const std::string& text) {
  write_file(path, text.data(), text.size());
}

void write_scan(const fs::path& path, const Scan& scan) {
  std::vector<float> values(4 * scan.size(), 0.0F);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    std::memcpy(values.data() + 4 * i, scan.points[i].data(), 3 * sizeof(float));
    if (!scan.reflectance.empty()) values[4 * i + 3] = scan.reflectance[i];
  }
  write_file(path, values.data(), values.size() * sizeof(float));
}

std::string row_text(const Pose& pose) {
  std::string text;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) text += (text.empty() ? "" : " ") + number_text(pose(r, c));
  }
  return text;
}

ordered_json sensor_record(const SensorModel& sensor) {
  return {{"name", sensor.name},
          {"azimuth_min_rad", sensor.azimuth_min},
          {"azimuth_max_rad", sensor.azimuth_max},
          {"elevation_min_rad", sensor.elevation_min},
          {"elevation_max_rad", sensor.elevation_max},
          {"azimuth_step_rad", sensor.azimuth_step},
          {"elevation_step_rad", sensor.elevation_step},
          {"range_min_m", sensor.range_min},
          {"range_max_m", sensor.range_max},
          {"missing_return_is_meaningful", sensor.missing_return_is_meaningful}};
}

void write_descriptions(const fs::path& folder, const SensorModel& sensor,
                        const Configuration& parameters) {
  // With these keys the folder is itself a sequence that `raymoval` opens.
  const auto known = sensor_model_names();
  const bool named = std::find(known.begin(), known.end(), sensor.name) != known.end();
  const ordered_json sequence = {{"name", "sequence"},
                                 {"poses", "poses.txt"},
                                 {"up", "z"},
                                 {"sensor", named ? sensor.name : "estimated"}};
  write_file(folder / "sequence.json", sequence.dump(2) + "\n");
  write_file(folder / "sensor.json", sensor_record(sensor).dump(2) + "\n");
  write_file(folder / "parameters.json", to_json(parameters).dump(2) + "\n");
  const std::string identity = row_text(Pose::Identity());
  std::string calib;
  for (const char* name : {"P0", "P1", "P2", "P3", "Tr"}) {
    calib += std::string(name) + ": " + identity + "\n";
  }
  write_file(folder / "calib.txt", calib);
}

void check_space(double used_bytes, const Manifest& manifest) {
  if (used_bytes <= manifest.disk_limit_gib * kGib) return;
  throw MethodError(
      fmt::format("the working folder would take more than {} GiB (20 bytes a point); "
                  "raise 'disk_limit_gib' in {} or run on fewer frames",
                  number_text(manifest.disk_limit_gib), manifest.path.string()));
}

[[noreturn]] void throw_answer(const std::string& file, const std::string& what) {
  throw MethodError(fmt::format("{}/{}: {}", kAnswerFolder, file, what));
}

/// The entries of the answer folder, in order of name.
std::vector<fs::path> answer_entries(const fs::path& folder) {
  try {
    return entries_of(folder);
  } catch (const UnreadableError&) {
    throw MethodError(std::string(kAnswerFolder) +
                      ": cannot be read; the program must leave this folder where it was made");
  }
}

/// Checks that each scan has a label file and each label file a scan.
void check_answer_files(const fs::path& folder, std::size_t scans) {
  std::vector<std::string> found;
  for (const fs::path& entry : answer_entries(folder)) {
    if (entry.extension() == ".label") found.push_back(entry.filename().string());
  }
  const std::string count =
      fmt::format("expected {} files, one per scan ({} to {}), found {}", scans,
                  scan_file_name(0, ".label"), scan_file_name(scans - 1, ".label"), found.size());
  for (std::size_t i = 0; i < scans; ++i) {
    const std::string name = scan_file_name(i, ".label");
    if (!std::binary_search(found.begin(), found.end(), name))
      throw_answer(name, "missing; " + count);
    std::erase(found, name);
  }
  if (!found.empty()) throw_answer(found.front(), "belongs to no scan; " + count);
}

Mask read_answer(const fs::path& folder, std::size_t scan, std::size_t points) {
  const std::string name = scan_file_name(scan, ".label");
  const fs::path path = folder / name;
  std::error_code error;
  // Reading a pipe would wait for a writer, and a device has no end.
  if (!fs::is_regular_file(path, error)) throw_answer(name, "expected a file of labels");
  const std::uintmax_t size = fs::file_size(path, error);
  const std::uintmax_t expected = 4 * static_cast<std::uintmax_t>(points);
  if (error || size != expected) {
    throw_answer(name,
                 fmt::format("expected {} bytes (a 32-bit word for each of {} points), found {}",
                             grouped_text(expected), grouped_text(points),
                             error ? error.message() : grouped_text(size)));
  }
  const std::vector<std::byte> bytes = read_bytes(path);
  if (bytes.size() != expected) throw_answer(name, "changed while it was read");
  Mask mask(points);
  for (std::size_t i = 0; i < points; ++i) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + 4 * i, sizeof word);
    word &= 0xFFFFU;
    if (word != kKeptWord && word != kRemovedWord) {
      throw_answer(
          name, fmt::format("point {} has label {}; expected 9 (kept) or 251 (removed)", i, word));
    }
    mask[i] = word == kRemovedWord ? 1 : 0;
  }
  return mask;
}

}  // namespace

std::string scan_file_name(std::size_t scan, const char* extension) {
  return fmt::format("{:06}{}", scan, extension);
}

std::vector<std::size_t> write_sequence_files(const fs::path& folder, const ScanSource& scans,
                                              const Manifest& manifest,
                                              const Configuration& parameters,
                                              const RunContext& context) {
  fs::create_directory(folder / "velodyne");
  fs::create_directory(folder / kAnswerFolder);
  write_descriptions(folder, scans.sensor(), parameters);
  context.begin_pass("writing scans", scans.size());
  std::vector<std::size_t> points(scans.size());
  std::string poses, times;
  double used_bytes = 0.0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    context.check_cancelled();
    const Scan scan = scans.load(i);
    points[i] = scan.size();
    used_bytes += 20.0 * static_cast<double>(scan.size());
    check_space(used_bytes, manifest);
    write_scan(folder / "velodyne" / scan_file_name(i, ".bin"), scan);
    poses += row_text(scan.T_world_sensor) + "\n";
    times += number_text(scan.time_s) + "\n";
    context.advance();
  }
  write_file(folder / "poses.txt", poses);
  write_file(folder / "times.txt", times);
  return points;
}

void read_answers(const fs::path& folder, const std::vector<std::size_t>& points, RemovalSink& sink,
                  const RunContext& context) {
  if (points.empty()) return;
  check_answer_files(folder / kAnswerFolder, points.size());
  context.begin_pass("reading answers", points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    context.check_cancelled();
    sink.accept(i, read_answer(folder / kAnswerFolder, i, points[i]));
    context.advance();
  }
}

}  // namespace raymoval::external_method
