// SPDX-License-Identifier: MIT
#include "methods/external/working_folder.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "core/error.h"
#include "methods/external/external.h"

namespace raymoval {
namespace external_method {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "raymoval-external";

fs::path temporary_root() {
  std::error_code error;
  const fs::path root = fs::temp_directory_path(error);
  if (!error) return root;
  throw DataError("there is no folder for temporary files (" + error.message() +
                  "); set TMPDIR to one that exists.");
}

/// A folder whose name says nothing of being unfinished.
Part kept_folder(const fs::path& root) {
  std::string name = (root / (std::string(kName) + "-XXXXXX")).string();
  const bool made = ::mkdtemp(name.data()) != nullptr;
  Part folder{name};
  if (made) folder.held = Descriptor(::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return folder;
}

}  // namespace

WorkingFolder::WorkingFolder(bool is_kept) : is_kept_(is_kept) {
  const fs::path root = temporary_root();
  part_ = is_kept ? kept_folder(root) : new_part_folder(root / kName, 0700);
  if (part_.held.valid()) return;
  throw DataError(fmt::format(
      "{}: no working folder can be made there ({}); set TMPDIR to a folder with space.",
      root.string(), std::generic_category().message(errno)));
}

WorkingFolder::~WorkingFolder() {
  std::error_code ignored;
  if (!is_kept_) fs::remove_all(part_.place, ignored);
}

}  // namespace external_method

void remove_abandoned_working_folders() {
  std::error_code error;
  const std::filesystem::path root = std::filesystem::temp_directory_path(error);
  if (error) return;
  for (const std::filesystem::path& part : parts_of(root / external_method::kName)) {
    remove_abandoned_part(part);
  }
}

}  // namespace raymoval
