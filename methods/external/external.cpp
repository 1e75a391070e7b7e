// SPDX-License-Identifier: MIT
#include "methods/external/external.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/files/scratch_folder.h"
#include "core/process/child_process.h"
#include "core/text.h"
#include "methods/external/manifest.h"
#include "methods/remover.h"

static_assert(std::endian::native == std::endian::little, "files hold little-endian numbers");

namespace raymoval::external_method {
namespace {

/// The folder below the working folder for the program's label files.
constexpr const char* kAnswerFolder = "predictions";

/// The label words are those of SemanticKITTI's motion segmentation.
constexpr std::uint32_t kKeptWord = 9;
constexpr std::uint32_t kRemovedWord = 251;

/// "000012.bin"
std::string scan_file_name(std::size_t scan, const char* extension) {
  return fmt::format("{:06}{}", scan, extension);
}

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

/// Writes the input of a program, in SemanticKITTI layout: velodyne/NNNNNN.bin (x y z reflectance
/// as float32, in the sensor frame, in metres; reflectance is 0 if the data has none), poses.txt (a
/// row with the 12 numbers of T_world_sensor for each scan; calib.txt holds the identity),
/// times.txt (in seconds), sequence.json, sensor.json and parameters.json. The program gets the
/// same data as every method: finite points only, no labels, and no hint at the data set.
/// @return the number of points of each scan
/// @throws MethodError if the files would take more than the manifest's disk limit; DataError if
/// the disk is full; Cancelled
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

/// Reads predictions/NNNNNN.label of every scan, which holds a 32-bit little-endian word for each
/// point. Its lower 16 bits are 9 for a kept and 251 for a removed point. Gives the masks to
/// `sink`.
/// @throws MethodError with the file, the expected content and the content found
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

constexpr std::string_view kPrefix = "external:";

/// Environment variables that limit a program to the method's threads and fix the order of Python's
/// hashes.
std::vector<std::pair<std::string, std::string>> environment_for(int threads) {
  std::vector<std::pair<std::string, std::string>> variables = {{"PYTHONHASHSEED", "0"}};
  for (const char* name : {"RAYMOVAL_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS",
                           "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"}) {
    variables.emplace_back(name, std::to_string(threads));
  }
  return variables;
}

/// Whether the working folder is kept for the author of a program.
bool is_folder_kept() {
  const char* asked = std::getenv("RAYMOVAL_KEEP_WORKING_FOLDER");
  return asked != nullptr && *asked != '\0';
}

/// The file of the program `name`, searched as by a shell.
std::string found_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* path = std::getenv("PATH");
  for (const std::string_view folder : split(path != nullptr ? path : "/usr/bin:/bin", ':')) {
    const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file, ignored)) {
      return std::filesystem::absolute(file, ignored).string();
    }
  }
  throw MethodError(fmt::format(
      "the program '{}' is not on PATH; install it, or give its path in the manifest", name));
}

/// The last output of the program, as the end of a message.
std::string printed_text(const std::string& output) {
  const std::size_t end = output.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return " and printed nothing";
  return ". It printed last:\n" + output.substr(0, end + 1);
}

/// The error, to follow the program's name; empty if there is none.
std::string fault_of(const ChildEnd& end, double time_limit_s, double disk_limit_gib) {
  switch (end.kind) {
    case ChildEnd::Kind::kCancelled:
      throw Cancelled();
    case ChildEnd::Kind::kNotStarted:
      return fmt::format("cannot be started ({})", std::generic_category().message(end.code));
    case ChildEnd::Kind::kTimeout:
      return fmt::format("did not end within {} s and was ended", number_text(time_limit_s)) +
             printed_text(end.output_tail);
    case ChildEnd::Kind::kOutOfDisk:
      return fmt::format(
                 "filled its working folder with more than {} GiB and was ended; raise "
                 "'disk_limit_gib' in the manifest or run on fewer frames",
                 number_text(disk_limit_gib)) +
             printed_text(end.output_tail);
    case ChildEnd::Kind::kOutOfMemory:
      break;  // No memory limit is set here: the caller sets it.
    case ChildEnd::Kind::kSignalled:
      return "was ended by " + signal_text(end.code) + printed_text(end.output_tail);
    case ChildEnd::Kind::kExited:
      if (end.code == 0) return "";
      return fmt::format("ended with exit code {}", end.code) + printed_text(end.output_tail);
  }
  throw InternalError("unknown end of a program");
}

class External : public Remover {
 public:
  External(Manifest manifest, Configuration parameters)
      : manifest_(std::move(manifest)), parameters_(std::move(parameters)) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    const ScratchFolder folder(kMethodFolder, is_folder_kept());
    if (is_folder_kept() && context.progress != nullptr) {
      context.progress->say("the working folder is kept: " + folder.path().string());
    }
    const auto points = write_files(folder.path(), scans, context);
    run_command(folder.path(), points.size(), context);
    const StageScope timed(context.times, "reading answers");
    read_answers(folder.path(), points, sink, context);
  }

 private:
  [[nodiscard]] std::vector<std::size_t> write_files(const std::filesystem::path& folder,
                                                     const ScanSource& scans,
                                                     const RunContext& context) const {
    const StageScope timed(context.times, "writing scans");
    return write_sequence_files(folder, scans, manifest_, parameters_, context);
  }

  /// The limit of the manifest, else 30 s for each scan but at least ten minutes.
  [[nodiscard]] double time_limit_s(std::size_t scans) const {
    if (manifest_.time_limit_s > 0.0) return manifest_.time_limit_s;
    return std::max(600.0, 30.0 * static_cast<double>(scans));
  }

  /// Runs the program to its end; its output is kept for messages only.
  void run_command(const std::filesystem::path& folder, std::size_t scans,
                   const RunContext& context) const {
    const StageScope timed(context.times, "program");
    context.begin_pass("program", 1);
    ChildSetup setup;
    setup.arguments = command_line(manifest_);
    setup.program = found_program(setup.arguments.front());
    setup.folder = folder;
    setup.environment = environment_for(context.threads);
    setup.limits.seconds = time_limit_s(scans);
    setup.limits.folder_mib = 1024.0 * manifest_.disk_limit_gib;
    setup.cancel = context.cancel;
    const std::string fault =
        fault_of(run_child(setup), setup.limits.seconds, manifest_.disk_limit_gib);
    throw_if_cancelled(context.cancel);
    if (!fault.empty()) throw MethodError(fmt::format("'{}' {}", setup.program, fault));
    context.advance();
  }

  Manifest manifest_;
  Configuration parameters_;
};

}  // namespace
}  // namespace raymoval::external_method

namespace raymoval {

std::optional<std::filesystem::path> external_manifest(const std::string& method_name) {
  if (!method_name.starts_with(external_method::kPrefix)) return std::nullopt;
  return method_name.substr(external_method::kPrefix.size());
}

MethodEntry external_entry(const std::filesystem::path& manifest) {
  external_method::Manifest read = external_method::read_manifest(manifest);
  MethodEntry entry;
  entry.name = read.name;
  entry.sentence = read.sentence;
  entry.source = read.source;
  entry.version = read.version + "+" + external_method::program_hash(read).substr(0, 16);
  entry.notes = read.notes;
  entry.parameters = read.parameters;
  entry.variants = {
      {.name = "default",
       .sentence = read.online
                       ? "Answers for a scan from it and earlier ones, according to its manifest."
                       : "Answers from all scans.",
       .online = read.online}};
  entry.manifest = read.path.string();
  entry.make = [read = std::move(read)](const Configuration& parameters) {
    return std::make_unique<external_method::External>(read, parameters);
  };
  return entry;
}

}  // namespace raymoval
