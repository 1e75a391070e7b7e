// SPDX-License-Identifier: MIT
#include "core/files/files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "core/error.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
using test::TemporaryFolder;

namespace {

std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace

TEST_CASE("An atomic write replaces the file and leaves nothing beside it") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.txt";
  write_atomically(path, "a long first text");
  write_atomically(path, "short");
  CHECK(read_text(path) == "short");
  write_atomically(path, "");
  CHECK(read_text(path).empty());
  const std::string binary("a\0b\r\n\xFF", 6);
  write_atomically(path, binary);
  CHECK(read_text(path) == binary);
  CHECK(read_bytes(path).size() == 6);
  CHECK(entries(folder.path()) == 1);
}

TEST_CASE("A write that fails changes nothing and says why") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(write_atomically(folder.path() / "no/a.txt", "x"),
                    Contains("no/a.txt: cannot be written") && Contains("No such file"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "no"));
  // A folder that holds something cannot be replaced: the write fails at its last step.
  std::filesystem::create_directories(folder.path() / "taken/inside");
  CHECK_THROWS_AS(write_atomically(folder.path() / "taken", "x"), DataError);
  CHECK(entries(folder.path()) == 1);
}

TEST_CASE("A file that cannot be read is named with the reason") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_text(folder.path() / "no.txt"),
                    Contains("no.txt: cannot be read") && Contains("No such file"));
  CHECK_THROWS_WITH(read_bytes(folder.path()), Contains("is a folder, expected a file"));
}

TEST_CASE("JSON may have comments, and an error tells line and column") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.json";
  write_atomically(path, "// one\n{\"a\": /* two */ [1, 2]}\n");
  CHECK(read_json(path)["a"].size() == 2);
  write_atomically(path, "{\n  \"a\": 1,\n  \"b\" 2\n}\n");  // The colon is missing before the 2.
  CHECK_THROWS_WITH(read_json(path), Contains("a.json: line 3, column 7"));
  write_atomically(path, "[1,]");
  CHECK_THROWS_WITH(read_json(path), Contains("line 1, column 4"));
  for (const char* bad : {"", "{", "[1]x", "\n\n", "{\"a\": nan}", "\"\xFF\""}) {
    write_atomically(path, bad);
    CHECK_THROWS_AS(read_json(path), ConfigurationError);
  }
}

TEST_CASE("Unknown keys suggest the near one") {
  check_keys({{"moving", 1}}, {"moving", "ignored"}, "rule");
  check_keys(nlohmann::json::object(), {"moving"}, "rule");
  CHECK_THROWS_WITH(check_keys({{"movin", 1}}, {"moving", "ignored"}, "rule"),
                    Contains("rule: unknown key 'movin'. Did you mean 'moving'?"));
  CHECK_THROWS_WITH(check_keys(nlohmann::json::array(), {"moving"}, "rule"),
                    Contains("expected an object") && Contains("moving"));
}

TEST_CASE("The content hash is XXH3 of 128 bits, the same in pieces as at once") {
  CHECK(content_hash("") == "99aa06d3014798d86001c324468d497f");  // Of the XXH3 test vectors.
  CHECK(content_hash("a") != content_hash("b"));
  std::mt19937 random(4);
  for (const std::size_t size : {0, 1, 3, 16, 17, 128, 240, 241, 1024, 5000}) {
    std::string text(size, ' ');
    for (char& c : text) c = static_cast<char>(random());
    ContentHasher hasher;
    for (std::size_t at = 0; at < size;) {
      const std::size_t piece = std::min<std::size_t>(1 + random() % 300, size - at);
      hasher.add(std::string_view(text).substr(at, piece));
      at += piece;
    }
    CHECK(hasher.digest() == content_hash(text));
    CHECK(hasher.digest().size() == 32);
    text += '\0';
    CHECK(hasher.digest() != content_hash(text));
  }
}
