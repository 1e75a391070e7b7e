// SPDX-License-Identifier: MIT
#include "datasets/simulation/scene/making_place.h"

#include <fcntl.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"

namespace raymoval::simulated {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw DataError(path.string() + ": cannot be made (" + reason +
                  "). Choose a folder you may write to.");
}

}  // namespace

MakingPlace::MakingPlace(fs::path target)
    : target_(std::move(target)), part_(new_part_folder(target_)) {
  if (!part_.held.valid()) fail(part_.place, std::generic_category().message(errno));
  std::error_code error, ignored;
  fs::create_directory(folder(), error);
  if (!error) return;
  fs::remove(part_.place, ignored);
  fail(folder(), error.message());
}

MakingPlace::~MakingPlace() {
  std::error_code ignored;
  fs::remove_all(part_.place, ignored);
}

bool MakingPlace::take_place() {
  if (::rename(folder().c_str(), target_.c_str()) != 0) {
    if (errno == EEXIST || errno == ENOTEMPTY || errno == ENOTDIR) return false;
    fail(target_, std::generic_category().message(errno));
  }
  sync_folder(folder_of(target_));
  return true;
}

bool MakingPlace::replace_target() {
  // In one step where the file system can do that, so that readers always find one of the two.
  if (::renameat2(AT_FDCWD, folder().c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
    sync_folder(folder_of(target_));
    return true;
  }
  const fs::path aside = part_.place / "replaced";
  if (::rename(target_.c_str(), aside.c_str()) != 0 && errno != ENOENT) {
    throw DataError(target_.string() + ": cannot be replaced (" +
                    std::generic_category().message(errno) +
                    "). Remove it, or choose another folder.");
  }
  return take_place();
}

void sweep_making_places(const fs::path& parent) {
  for (const fs::path& entry : entries_of(parent)) remove_abandoned_part(entry);
}

}  // namespace raymoval::simulated
