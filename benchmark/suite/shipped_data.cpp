// SPDX-License-Identifier: MIT
#include "benchmark/suite/shipped_data.h"

#include <system_error>
#include <vector>

#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> places_of(const std::string& name) {
  std::vector<fs::path> places;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path folder = program.parent_path();
    // Installed first: a build folder has no share/ beside it.
    places = {folder.parent_path() / "share/raymoval" / name, folder / "share/raymoval" / name};
  }
  places.push_back(fs::path(RAYMOVAL_INSTALLED_DATA) / name);
  // The Debian package's folder, whatever prefix the build was configured with.
  places.push_back(fs::path("/usr/share/raymoval") / name);
  return places;
}

}  // namespace

fs::path shipped_data(const std::string& name) {
  for (const fs::path& place : places_of(name)) {
    if (is_folder(place)) return place;
  }
  return {};
}

std::string missing_data(const std::string& name) {
  std::vector<std::string> texts;
  for (const fs::path& place : places_of(name)) texts.push_back(place.string());
  return "none of " + join(texts) + " is there. Install raymoval again.";
}

}  // namespace raymoval
