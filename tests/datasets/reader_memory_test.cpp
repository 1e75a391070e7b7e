// SPDX-License-Identifier: MIT
// Readers need no more memory than a stated number of times the size of the file, whatever its
// header says. The numbers are those of SECURITY.md.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/poses.h"
#include "datasets/trajectories/pose_file.h"
#include "datasets/trajectories/stamps.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;

namespace {

constexpr std::size_t kMegabyte = 1 << 20;

std::size_t address_space() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Whether `read` gets along with `bytes` more than the program has already. It may refuse its
/// file.
bool suffices(std::size_t bytes, const std::function<void()>& read) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const rlim_t most = address_space() + bytes;
    const rlimit limit{most, most};
    if (::setrlimit(RLIMIT_AS, &limit) != 0) ::_exit(3);
    try {
      read();
    } catch (const std::bad_alloc&) {
      ::_exit(1);
    } catch (const Error&) {
      ::_exit(0);
    }
    ::_exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  REQUIRE(WEXITSTATUS(status) <= 1);
  return WEXITSTATUS(status) == 0;
}

/// The sanitizers take address space for themselves, as if there were no end of it.
bool can_be_limited() {
  return address_space() < (std::size_t{1} << 40);
}

/// @param times how much memory the reader may take, in sizes of the file
void check_memory(const std::filesystem::path& file, double times,
                  const std::function<void()>& read) {
  constexpr std::size_t kForItself = 2 * kMegabyte;
  if (!can_be_limited()) return;
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  INFO(file.filename() << " of " << size << " bytes");
  CHECK(suffices(static_cast<std::size_t>(times * size) + kForItself, read));
}

std::string repeated(const std::string& text, std::size_t bytes) {
  std::string whole;
  while (whole.size() + text.size() <= bytes) whole += text;
  return whole;
}

std::string pcd(const std::string& size, const std::string& type, std::size_t points,
                const std::string& data) {
  const std::string count = std::to_string(points);
  return "FIELDS x y z\nSIZE " + size + "\nTYPE " + type + "\nCOUNT 1 1 1\nWIDTH " + count +
         "\nHEIGHT 1\nPOINTS " + count + "\nDATA " + data + "\n";
}

/// Zeros in the fewest bytes: three as they are, and references of three bytes to 264 of them.
std::string lzf_bomb(std::size_t references) {
  const auto unpacked = static_cast<std::uint32_t>(3 + 264 * references);
  std::string packed("\x02\0\0\0", 4);
  for (std::size_t i = 0; i < references; ++i) packed += std::string("\xE0\xFF\x00", 3);
  std::string sizes;
  for (const auto size : {static_cast<std::uint32_t>(packed.size()), unpacked}) {
    sizes.append(reinterpret_cast<const char*>(&size), sizeof size);
  }
  return sizes + packed;
}

}  // namespace

TEST_CASE("a limit of memory is noticed") {
  if (!can_be_limited()) return;
  const auto hungry = [] {
    std::string text(64 * kMegabyte, 'x');
    const volatile char* seen = text.data();  // Else a compiler may leave the text out.
    if (seen[text.size() / 2] == 'y') throw DataError("never");
  };
  CHECK_FALSE(suffices(32 * kMegabyte, hungry));
  CHECK(suffices(96 * kMegabyte, hungry));
}

TEST_CASE("readers of scans need a bounded number of times their file") {
  const test::TemporaryFolder folder;
  const auto check_cloud = [&](const std::string& name, double times, const std::string& content) {
    const auto file = folder.write(name, content);
    check_memory(file, times, [&] { (void)read_cloud(file); });
  };
  check_cloud("zeros.bin", 3, std::string(kMegabyte, '\0'));
  const std::string body(kMegabyte, '\0');
  check_cloud("bytes.pcd", 6, pcd("1 1 1", "I I I", body.size() / 3, "binary") + body);
  check_cloud("none.pcd", 6, pcd("1 1 1", "I I I", 2000000000, "binary") + body);
  const std::string rows = repeated("0 0 0\n", kMegabyte);
  check_cloud("rows.pcd", 6, pcd("4 4 4", "F F F", rows.size() / 6, "ascii") + rows);
  check_cloud("few.pcd", 6, pcd("4 4 4", "F F F", 2000000000, "ascii") + rows);
  check_cloud("blank.pcd", 6,
              pcd("4 4 4", "F F F", 2000000000, "ascii") + std::string(kMegabyte, '\n'));
  const std::string ply = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string properties =
      "\nproperty char x\nproperty char y\nproperty char z\nend_header\n";
  check_cloud("bytes.ply", 6, ply + std::to_string(body.size() / 3) + properties + body);
  check_cloud("none.ply", 6, ply + "2000000000" + properties + body);
  constexpr std::size_t kReferences = 50000;
  constexpr std::size_t kPoints = 1 + 88 * kReferences;
  const auto packed = lzf_bomb(kReferences);
  const auto bomb =
      folder.write("bomb.pcd", pcd("1 1 1", "I I I", kPoints, "binary_compressed") + packed);
  CHECK(read_cloud(bomb).points.size() == kPoints);  // It goes off.
  check_memory(bomb, 450, [&] { (void)read_cloud(bomb); });
  check_cloud("lies.pcd", 450, pcd("1 1 1", "I I I", kPoints + 1, "binary_compressed") + packed);
  check_cloud("far.pcd", 450, pcd("1 1 1", "I I I", 2000000000, "binary_compressed") + packed);
}

TEST_CASE("readers of what stands beside scans need a bounded number of times their file") {
  const test::TemporaryFolder folder;
  const auto text = [&](const std::string& name, const std::string& line) {
    return folder.write(name, repeated(line, kMegabyte / 2));
  };
  const auto check_poses = [&](const std::filesystem::path& file) {
    check_memory(file, 32, [&] { (void)read_pose_file(file); });
  };
  check_poses(text("kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n"));
  check_poses(text("tum.txt", "0 0 0 0 0 0 0 1\n"));
  check_poses(text("blank.txt", "\n"));
  check_poses(text("line.txt", "0 "));
  const auto times = text("times.txt", "0\n");
  check_memory(times, 32, [&] { (void)read_stamp_file(times); });
  for (const std::string line : {":\n", "a:\n", "\n", "Tr: ", "Tr: 0\n"}) {
    const auto file = text("calib.txt", line);
    check_memory(file, 100, [&] { (void)read_calibration(file, "Tr"); });
  }
}

TEST_CASE("readers of JSON need a bounded number of times their file") {
  const test::TemporaryFolder folder;
  for (const std::string item : {"[],", "0,", "\"\",", "{},", "{\"\":0},", "[[[[[]]]]],"}) {
    const auto file = folder.write(
        "list.json", "[" + repeated(item, kMegabyte / 4) + item.substr(0, item.size() - 1) + "]");
    check_memory(file, 100, [&] { (void)read_json(file); });
  }
  for (const char open : {'[', '{'}) {
    const auto file = folder.write("deep.json", std::string(kMegabyte / 4, open));
    check_memory(file, 100, [&] { (void)read_json(file); });
  }
}
