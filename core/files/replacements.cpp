// SPDX-License-Identifier: MIT
#include "core/files/replacements.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <set>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

bool renames(const fs::path& from, const fs::path& to, unsigned how = 0) {
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), how) == 0;
}

/// Whether one can replace the other. An entry of an unexpected kind is not the program's.
/// Else errno has the reason.
bool may_replace(const fs::path& part, const fs::path& target) {
  struct stat ours {};
  struct stat there {};
  if (::lstat(part.c_str(), &ours) != 0) return false;
  if (::lstat(target.c_str(), &there) != 0) return errno == ENOENT;
  if (S_ISDIR(ours.st_mode) == S_ISDIR(there.st_mode)) return true;
  errno = S_ISDIR(there.st_mode) ? EISDIR : ENOTDIR;
  return false;
}

}  // namespace

Replacements::~Replacements() {
  std::error_code ignored;
  for (const One& one : all_) {
    if (one.way == Way::kNone) fs::remove_all(one.part.place, ignored);
  }
}

void Replacements::add(Part part, fs::path target) {
  all_.push_back({std::move(part), std::move(target), {}, Way::kNone});
}

/// @return false, with the reason in errno, if the target is as it was
bool Replacements::give_name(One& one) {
  if (!may_replace(one.part.place, one.target)) return false;
  // In one step where the file system can do that, so that each name always leads to one of both.
  if (renames(one.part.place, one.target, RENAME_EXCHANGE)) {
    one.way = Way::kExchanged;
    return true;
  }
  if (errno == ENOENT) {
    if (!renames(one.part.place, one.target)) return false;
    one.way = Way::kNew;
    return true;
  }
  if (errno != EINVAL && errno != ENOSYS) return false;
  // A second name keeps the file before; a folder can have only one.
  // Not under a part's name: if this process ends here, no process takes it for an unfinished file.
  one.aside = new_part_name(one.target).replace_extension(".before");
  const bool linked = ::link(one.target.c_str(), one.aside.c_str()) == 0;
  if (!linked && !renames(one.target, one.aside)) return false;
  if (renames(one.part.place, one.target)) {
    one.way = Way::kAside;
    return true;
  }
  const int reason = errno;
  if (linked) {
    ::unlink(one.aside.c_str());
  } else {
    renames(one.aside, one.target);
  }
  errno = reason;
  return false;
}

/// @return whether the target is as it was
bool Replacements::take_back(One& one) {
  bool done = true;
  if (one.way == Way::kNew) done = renames(one.target, one.part.place);
  if (one.way == Way::kExchanged) done = renames(one.part.place, one.target, RENAME_EXCHANGE);
  if (one.way == Way::kAside) {
    done = renames(one.target, one.part.place) && renames(one.aside, one.target);
  }
  if (done) one.way = Way::kNone;
  return done;
}

void Replacements::give_up(const One& failed, int reason) {
  std::string changed;
  for (One& one : all_) {
    if (one.way == Way::kNone || take_back(one)) continue;
    changed += " " + one.target.string() + " was replaced and cannot be restored (" +
               std::generic_category().message(errno) + ")";
    const fs::path& before = one.way == Way::kExchanged ? one.part.place : one.aside;
    changed += one.way == Way::kNew ? "." : "; its old content is in " + before.string() + ".";
  }
  throw DataError(failed.target.string() + ": cannot be written (" +
                  std::generic_category().message(reason) + ")." +
                  (changed.empty() ? " Nothing was changed; choose another place." : changed));
}

void Replacements::commit() {
  for (One& one : all_) {
    if (!give_name(one)) give_up(one, errno);
  }
  std::error_code ignored;
  std::set<fs::path> folders;
  for (One& one : all_) {
    if (one.way == Way::kExchanged) fs::remove_all(one.part.place, ignored);
    if (one.way == Way::kAside) fs::remove_all(one.aside, ignored);
    one.part.held.close();  // Its lock was needed as long as it had the name of a part.
    folders.insert(folder_of(one.target));
  }
  for (const fs::path& folder : folders) sync_folder(folder);
}

}  // namespace raymoval
