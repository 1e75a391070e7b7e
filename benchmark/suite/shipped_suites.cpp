// SPDX-License-Identifier: MIT
#include "benchmark/suite/shipped_suites.h"

#include <algorithm>
#include <system_error>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"
#include "datasets/clouds/frames.h"

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
  // The Debian package's folder, which does not depend on the install prefix.
  places.push_back(fs::path("/usr/share/raymoval") / name);
  return places;
}

std::filesystem::path suite_folder() {
  return shipped_data("suites");
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

std::vector<std::string> shipped_suite_names() {
  const std::filesystem::path folder = suite_folder();
  std::vector<std::string> names;
  if (folder.empty()) return names;
  for (const auto& path : list_files(folder, {".json"})) names.push_back(path.stem().string());
  std::sort(names.begin(), names.end());  // "simulated" before "simulated-long"
  return names;
}

std::string suite_sentence(const std::string& name) {
  const std::string text = read_text(find_suite(name));
  const std::string first = text.substr(0, text.find('\n'));
  return first.starts_with("// ") ? first.substr(3) : "";
}

std::filesystem::path find_suite(const std::string& name_or_path) {
  if (is_file(name_or_path)) return name_or_path;
  const std::vector<std::string> names = shipped_suite_names();
  for (const std::string& name : names) {
    if (name == name_or_path) return suite_folder() / (name + ".json");
  }
  if (names.empty()) {
    throw UsageError(name_or_path + ": no such suite file, and the shipped suites are not there: " +
                     missing_data("suites"));
  }
  throw UsageError(name_or_path + ": no such suite file, and no shipped suite has this name." +
                   suggestion(name_or_path, names));
}

}  // namespace raymoval
