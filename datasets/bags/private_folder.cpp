// SPDX-License-Identifier: MIT
#include "datasets/bags/private_folder.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "core/error.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrivateFolder = "raymoval-recording";

fs::path root_of_private_folders() {
  const char* named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/tmp";
}

}  // namespace

PrivateFolder::PrivateFolder() {
  const fs::path root = root_of_private_folders();
  part_ = new_part_folder(root / kPrivateFolder, 0700);
  if (part_.held.valid()) return;
  throw DataError(root.string() + ": no folder can be made here to unpack a recording to (" +
                  std::generic_category().message(errno) +
                  "). Set TMPDIR to a folder with room for it.");
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(part_.place, ignored);
}

void remove_abandoned_private_folders() {
  for (const fs::path& part : parts_of(root_of_private_folders() / kPrivateFolder)) {
    remove_abandoned_part(part);
  }
}

}  // namespace raymoval
