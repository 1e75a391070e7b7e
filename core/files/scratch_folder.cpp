// SPDX-License-Identifier: MIT
#include "core/files/scratch_folder.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "core/error.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// A folder whose name does not mark it as unfinished.
Part kept_folder(const fs::path& target) {
  std::string name = target.string() + "-XXXXXX";
  const bool made = ::mkdtemp(name.data()) != nullptr;
  Part folder{name};
  if (made) folder.held = Descriptor(::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return folder;
}

}  // namespace

fs::path scratch_root() {
  const char* named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/tmp";
}

ScratchFolder::ScratchFolder(const char* purpose, bool is_kept) : is_kept_(is_kept) {
  const fs::path target = scratch_root() / purpose;
  part_ = is_kept ? kept_folder(target) : new_part_folder(target, 0700);
  if (part_.held.valid()) return;
  throw DataError(fmt::format(
      "{}: no temporary folder can be made there ({}). Set TMPDIR to a folder with space.",
      scratch_root().string(), std::generic_category().message(errno)));
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!is_kept_) fs::remove_all(part_.place, ignored);
}

void remove_abandoned_scratch_folders() {
  for (const char* purpose : {kRecordingFolder, kMethodFolder}) {
    for (const fs::path& part : parts_of(scratch_root() / purpose)) remove_abandoned_part(part);
  }
}

}  // namespace raymoval
