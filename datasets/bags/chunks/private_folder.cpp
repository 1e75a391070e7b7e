// SPDX-License-Identifier: MIT
#include "datasets/bags/chunks/private_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "core/error.h"

namespace raymoval {

PrivateFolder::PrivateFolder() {
  const char* named = ::getenv("TMPDIR");
  const std::filesystem::path root = named != nullptr && *named != '\0' ? named : "/tmp";
  std::string folder = (root / "raymoval-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) {
    throw DataError(root.string() + ": no folder can be made here to unpack a recording to (" +
                    std::generic_category().message(errno) +
                    "). Set TMPDIR to a folder with room for it.");
  }
  path_ = folder;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace raymoval
