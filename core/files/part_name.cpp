// SPDX-License-Identifier: MIT
#include "core/files/part_name.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/files/file_kind.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".raymoval-";
constexpr std::string_view kEnd = ".part";
constexpr std::string_view kDigits = "0123456789abcdef";
constexpr std::size_t kKernelDigits = 8;
constexpr std::size_t kRandomDigits = 16;
constexpr std::size_t kAllDigits = kKernelDigits + kRandomDigits;
constexpr std::size_t kTail = kMark.size() + kAllDigits + kEnd.size();

/// Digits of the running kernel since its start. Containers of one machine share them. Empty if
/// unknown.
const std::string& running_kernel() {
  static const std::string digits = [] {
    std::ifstream boot("/proc/sys/kernel/random/boot_id");
    std::string text;  // "1be0a73c-5f0c-...", made at random
    std::getline(boot, text);
    const bool known = text.find_first_not_of(kDigits) == kKernelDigits;
    return known ? text.substr(0, kKernelDigits) : "";
  }();
  return digits;
}

/// The digits of a part name; empty if it has another form.
std::string digits_of(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (name.size() <= kTail) return "";
  const std::string_view tail = std::string_view(name).substr(name.size() - kTail);
  if (!tail.starts_with(kMark) || !tail.ends_with(kEnd)) return "";
  const std::string_view digits = tail.substr(kMark.size(), kAllDigits);
  if (digits.find_first_not_of(kDigits) != std::string_view::npos) return "";
  return std::string(digits);
}

bool locks(int file) {
  return ::flock(file, LOCK_EX | LOCK_NB) == 0;
}

/// The state of a part before it was locked.
enum class Kept {
  kYes,
  kLost,     ///< Another process removed it as abandoned.
  kUnknown,  ///< The system reported an error, in errno.
};

/// Locks a new part. On a file system without locks, no process can take it.
Kept keep(int file) {
  if (!locks(file) && errno == EWOULDBLOCK) return Kept::kLost;
  struct stat status {};
  if (::fstat(file, &status) != 0) return Kept::kUnknown;
  return status.st_nlink > 0 ? Kept::kYes : Kept::kLost;
}

/// Removes a part that cannot be used; the reason stays in errno.
void discard(Part& part) {
  const int reason = errno;
  ::remove(part.place.c_str());
  part.held.close();
  errno = reason;
}

/// The entries of a folder; none if it cannot be listed, so that its old parts stay.
std::vector<fs::path> entries_or_none(const fs::path& folder) {
  try {
    return entries_of(folder);
  } catch (const DataError&) {
    return {};
  }
}

/// The part names in a folder.
std::vector<fs::path> parts_in(const fs::path& folder) {
  std::vector<fs::path> parts = entries_or_none(folder);
  std::erase_if(parts, [](const fs::path& entry) { return !is_part_name(entry); });
  return parts;
}

/// The part names in a folder at the first call of this process.
const std::vector<fs::path>& earlier_parts(const fs::path& folder) {
  static std::mutex mutex;
  static std::map<fs::path, std::vector<fs::path>> known;
  const std::lock_guard lock(mutex);
  const auto [place, is_new] = known.try_emplace(folder);
  if (is_new) place->second = parts_in(folder);
  return place->second;
}

bool is_part_of(const fs::path& part, const fs::path& target) {
  return name_of_part(part) == without_slash(target).filename();
}

/// Removes parts of `target` that dead processes left before the first call for its folder.
void remove_earlier_parts(const fs::path& target) {
  for (const fs::path& part : earlier_parts(folder_of(target))) {
    if (is_part_of(part, target)) remove_abandoned_part(part);
  }
}

}  // namespace

std::filesystem::path new_part_name(const std::filesystem::path& path) {
  std::random_device random;  // From the system: not from time or process number.
  std::string name = without_slash(path).string();
  name += kMark;
  name += running_kernel().empty() ? std::string(kKernelDigits, '0') : running_kernel();
  for (std::size_t i = 0; i < kRandomDigits; ++i) name += kDigits[random() & 15U];
  name += kEnd;
  return name;
}

std::filesystem::path name_of_part(const std::filesystem::path& path) {
  if (digits_of(path).empty()) return {};
  const std::string name = path.filename().string();
  return name.substr(0, name.size() - kTail);
}

bool is_part_name(const std::filesystem::path& path) {
  return !digits_of(path).empty();
}

std::vector<std::filesystem::path> parts_of(const std::filesystem::path& target) {
  std::vector<fs::path> parts = parts_in(folder_of(target));
  std::erase_if(parts, [&](const fs::path& part) { return !is_part_of(part, target); });
  return parts;
}

Part new_part_file(const std::filesystem::path& target, mode_t mode) {
  constexpr int kFlags = O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  remove_earlier_parts(target);
  while (true) {
    Part part{new_part_name(target)};
    part.held = Descriptor(::open(part.place.c_str(), kFlags, mode));
    if (!part.held.valid()) return part;
    const Kept kept = keep(part.held.get());
    if (kept == Kept::kUnknown) discard(part);
    if (kept != Kept::kLost) return part;
  }
}

Part new_part_folder(const std::filesystem::path& target, mode_t mode) {
  remove_earlier_parts(target);
  while (true) {
    Part part{new_part_name(target)};
    if (::mkdir(part.place.c_str(), mode) != 0) return part;
    part.held =
        Descriptor(::open(part.place.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    const Kept kept = part.held.valid() ? keep(part.held.get()) : Kept::kUnknown;
    if (kept == Kept::kUnknown) discard(part);
    if (kept != Kept::kLost) return part;
  }
}

Descriptor take_abandoned_part(const std::filesystem::path& part) {
  const std::string& kernel = running_kernel();
  if (kernel.empty() || !digits_of(part).starts_with(kernel)) return Descriptor();
  constexpr int kFlags = O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
  Descriptor opened(::open(part.c_str(), kFlags));
  if (opened.valid() && locks(opened.get())) return opened;
  return Descriptor();
}

void remove_abandoned_part(const std::filesystem::path& part) {
  struct stat status {};
  if (::lstat(part.c_str(), &status) != 0 || status.st_uid != ::geteuid()) return;
  const Descriptor held = take_abandoned_part(part);
  std::error_code ignored;
  if (held.valid()) fs::remove_all(part, ignored);
}

}  // namespace raymoval
