// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/output_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// Gives `made` the owner and the rights of `before`, as far as the system allows it, if both are
/// files or both are folders.
void keep_rights(const fs::path& made, const fs::path& before) {
  struct stat now {};
  struct stat then {};
  if (::lstat(made.c_str(), &now) != 0 || ::lstat(before.c_str(), &then) != 0) return;
  if ((now.st_mode & S_IFMT) != (then.st_mode & S_IFMT)) return;
  const bool same_owner = now.st_uid == then.st_uid && now.st_gid == then.st_gid;
  const bool owned = same_owner || ::lchown(made.c_str(), then.st_uid, then.st_gid) == 0;
  // If the earlier owner cannot be set, the group and others get no rights.
  [[maybe_unused]] const int kept = ::chmod(made.c_str(), then.st_mode & (owned ? 0777U : 0700U));
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path) : path_(without_slash(fs::absolute(path))) {
  (void)make_folders(folder_of(path_));  // An error shows when the folder is made.
  part_ = new_part_folder(path_);
  if (part_.held.valid()) return;
  throw DataError(path_.string() + ": cannot be made (" + std::generic_category().message(errno) +
                  "). Nothing was changed; choose another folder.");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(part_.place, ignored);
}

void OutputFolder::commit_with(Replacements& together) {
  sync_folder(part_.place);
  if (is_there(path_)) {
    for (const fs::path& entry : fs::recursive_directory_iterator(part_.place)) {
      keep_rights(entry, path_ / entry.lexically_relative(part_.place));
    }
    keep_rights(part_.place, path_);
  }
  together.add(std::move(part_), path_);
  committed_ = true;
}

}  // namespace raymoval
