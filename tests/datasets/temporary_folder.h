// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace raymoval::test {

/// A folder of its own for a test, gone at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "raymoval_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::string text() const { return path_.string(); }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  /// Writes `content` to the file `name`, making folders as needed; gives its path.
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    const auto file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// The bytes of `values` one after another.
template <class Value>
std::string bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

inline std::string floats(const std::vector<float>& values) {
  return bytes_of(values);
}
inline std::string words(const std::vector<std::uint32_t>& values) {
  return bytes_of(values);
}

/// The message of the `Wanted` error that `call` has to throw.
template <class Wanted, class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const Wanted& error) {
    return error.what();
  }
  FAIL("expected an error, but there was none");
  return "";
}

/// Checks that `message` contains each of `parts`.
inline void check_says(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) CHECK_THAT(message, Catch::Contains(part));
}

inline const std::string kIdentityRow = "1 0 0 0 0 1 0 0 0 0 1 0\n";

}  // namespace raymoval::test
