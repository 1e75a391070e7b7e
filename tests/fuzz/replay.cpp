// SPDX-License-Identifier: MIT
// Plays stored inputs back: test_fuzz TARGET FILE_OR_FOLDER... Or, as a libFuzzer program, tries
// what libFuzzer makes up on the target RAYMOVAL_LIBFUZZER.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <vector>

#include "tests/fuzz/target.h"

namespace raymoval::fuzz {
namespace {

std::map<std::string, Target>& targets() {
  static std::map<std::string, Target> all;
  return all;
}

}  // namespace

bool add_target(const char* name, Target target) {
  return targets().emplace(name, target).second;
}

}  // namespace raymoval::fuzz

#ifdef RAYMOVAL_LIBFUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const raymoval::fuzz::Target target = raymoval::fuzz::targets().at(RAYMOVAL_LIBFUZZER);
  target(std::string_view(reinterpret_cast<const char*>(data), size));
  return 0;
}
#else
namespace raymoval::fuzz {
namespace {

std::vector<std::filesystem::path> inputs_of(const std::filesystem::path& given) {
  if (!std::filesystem::is_directory(given)) return {given};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(given)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Each name is printed before its input is tried, so that the last name is that of a crash.
void replay(Target target, const std::filesystem::path& path) {
  std::cout << path.filename().string() << std::endl;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  target(bytes);
}

int run(const std::vector<std::string>& arguments) {
  const auto found = arguments.empty() ? targets().end() : targets().find(arguments.front());
  if (found == targets().end() || arguments.size() < 2) {
    std::cerr << "test_fuzz: expected TARGET FILE_OR_FOLDER...; targets are";
    for (const auto& [name, target] : targets()) std::cerr << ' ' << name;
    std::cerr << '\n';
    return 2;
  }
  std::size_t done = 0;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    for (const auto& path : inputs_of(arguments[i])) {
      replay(found->second, path);
      ++done;
    }
  }
  std::cout << done << " inputs\n";
  if (done == 0) std::cerr << "test_fuzz: there is no input\n";
  return done > 0 ? 0 : 1;
}

}  // namespace
}  // namespace raymoval::fuzz

int main(int count, char** arguments) {
  try {
    return raymoval::fuzz::run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    std::cerr << "test_fuzz: " << error.what() << '\n';
    return 1;
  }
}
#endif
