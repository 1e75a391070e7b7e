// SPDX-License-Identifier: MIT
//
// Compares how recordings and folders are read: speed and memory over their length.
//   bag_reading FOLDER [--scans N] [--points N] [--only NAME]
//   bag_reading --write FOLDER [--scans N] [--points N] [--only NAME]
// Writes a drive of N scans (default: 2,000 of 30,000 points: x y z intensity ring time, 22 bytes a
// point; up and down the same 40 m all the time, so that the map does not grow) into FOLDER, once
// as each kind of recording and once as files, and a quarter and a half of it, too. Each is read by
// a process of its own from front to back, and by another one in an order by chance, and is then
// removed. The table in Markdown that it prints has for each of them: megabytes on the disk, the
// seconds that opening takes, scans and megabytes of points a second and processor seconds while
// they are read, and the peak memory at each of the lengths. What is read was just written, so that
// it is in the memory of the system if that is large enough: the figures are of the readers, not of
// the disk. With --write the drive is only written.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "benchmark/process/machine.h"
#include "core/error.h"
#include "core/text.h"
#include "datasets/open_sequence.h"
#include "scripts/recorded_drive.h"

namespace {

namespace fs = std::filesystem;
using namespace raymoval;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// What a process that reads prints: seconds of opening, of reading, of the processor while it
/// reads, and its peak memory.
struct Reading {
  double open_s = 0, read_s = 0, processor_s = 0, peak_mib = 0;
};

void read(const fs::path& path, bool by_chance) {
  Reading reading;
  const auto begin = std::chrono::steady_clock::now();
  const Sequence sequence = open_sequence(path.string(), {});
  reading.open_s = seconds_since(begin);
  std::vector<std::size_t> order(sequence.scans->size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (by_chance) std::shuffle(order.begin(), order.end(), std::minstd_rand(7));
  const auto opened = std::chrono::steady_clock::now();
  const double before = processor_seconds();
  for (const std::size_t scan : order) {
    if (sequence.scans->load(scan).points.empty()) throw InternalError("a scan without a point");
  }
  reading.read_s = seconds_since(opened);
  reading.processor_s = processor_seconds() - before;
  fmt::print("{} {} {} {}\n", reading.open_s, reading.read_s, reading.processor_s,
             peak_memory_mib().value_or(0));
}

/// Reads `path` in a process of its own.
Reading read_apart(const fs::path& path, bool by_chance) {
  const std::string command = fmt::format("/proc/{}/exe --read '{}' {}", getpid(), path.string(),
                                          by_chance ? "chance" : "front");
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw DataError("no process can be started to read " + path.string());
  Reading reading;
  const int got = std::fscanf(pipe, "%lf %lf %lf %lf", &reading.open_s, &reading.read_s,
                              &reading.processor_s, &reading.peak_mib);
  if (pclose(pipe) != 0 || got != 4) throw DataError(path.string() + ": cannot be read");
  return reading;
}

std::uintmax_t bytes_of(const fs::path& path) {
  if (fs::is_regular_file(path)) return fs::file_size(path);
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  return bytes;
}

/// A row of the table: the whole drive's speed, and the memory at all lengths.
std::string row_of(const DriveForm& form, const Drive& drive, const fs::path& folder) {
  Reading front, chance;
  std::uintmax_t bytes = 0;
  std::string front_memory, chance_memory;
  for (const std::size_t part : {4, 2, 1}) {
    const Drive length{drive.scans / part, drive.points};
    const fs::path path = folder / form.file;
    form.write(length, path);
    bytes = bytes_of(path);
    front = read_apart(path, false);
    chance = read_apart(path, true);
    front_memory += fmt::format("{}{:.1f}", part == 4 ? "" : " / ", front.peak_mib);
    chance_memory += fmt::format("{}{:.1f}", part == 4 ? "" : " / ", chance.peak_mib);
    fs::remove_all(path);
  }
  const auto scans = static_cast<double>(drive.scans);
  const double megabytes = scans * static_cast<double>(drive.points) * 22e-6;
  const auto speed = [&](const Reading& reading) {
    return fmt::format("{:.0f} | {:.0f} | {:.2f}", scans / reading.read_s,
                       megabytes / reading.read_s, reading.processor_s);
  };
  return fmt::format("| {} | {:.0f} | {:.2f} | {} | {} | {} | {} |", form.name,
                     static_cast<double>(bytes) / 1048576.0, front.open_s, speed(front),
                     front_memory, speed(chance), chance_memory);
}

struct Wish {
  Drive drive;
  fs::path folder;
  std::string only;
  [[nodiscard]] bool wants(const DriveForm& form) const {
    return only.empty() || form.file == only;
  }
};

Wish read_wish(const std::vector<std::string>& arguments, std::size_t first) {
  Wish wish;
  wish.folder = arguments.at(first);
  for (std::size_t i = first + 1; i + 1 < arguments.size(); i += 2) {
    if (arguments[i] == "--only") wish.only = arguments[i + 1];
    if (arguments[i] == "--scans") wish.drive.scans = std::stoul(arguments[i + 1]);
    if (arguments[i] == "--points") wish.drive.points = std::stoul(arguments[i + 1]);
  }
  fs::create_directories(wish.folder);
  return wish;
}

void write_all(const Wish& wish) {
  for (const DriveForm& form : drive_forms()) {
    if (wish.wants(form)) form.write(wish.drive, wish.folder / form.file);
  }
}

void compare(const Wish& wish) {
  const std::size_t scans = wish.drive.scans;
  fmt::print(
      "{} scans of {} points; peak memory at {}, {} and {} scans\n\n"
      "| | MiB | open, s | scans/s | MB/s | processor, s | peak, MiB | by chance: scans/s | MB/s | "
      "processor, s | peak, MiB |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      grouped_text(scans), grouped_text(wish.drive.points), grouped_text(scans / 4),
      grouped_text(scans / 2), grouped_text(scans));
  for (const DriveForm& form : drive_forms()) {
    if (!wish.wants(form)) continue;
    fmt::print("{}\n", row_of(form, wish.drive, wish.folder));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 3 && arguments[0] == "--read") {
      read(arguments[1], arguments[2] == "chance");
    } else if (arguments.size() > 1 && arguments[0] == "--write") {
      write_all(read_wish(arguments, 1));
    } else if (!arguments.empty()) {
      compare(read_wish(arguments, 0));
    } else {
      std::cerr << "bag_reading [--write] FOLDER [--scans N] [--points N] [--only NAME]\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}
