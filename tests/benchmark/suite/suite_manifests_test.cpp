// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "benchmark/suite/suite.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using Catch::Matchers::Contains;

TEST_CASE("manifests are looked up beside the suite file first") {
  const test::TemporaryFolder folder;
  (void)folder.write("own/manifest.json", R"({"name": "own", "sentence": "Tests.", "version": "1",
      "online": true, "command": ["true"]})");
  const auto suite_of = [&](const std::string& methods) {
    const auto file =
        folder.write("suite.json", R"({"sequences": ["street"], "methods": [)" + methods + "]}");
    return read_suite(file, MethodRegistry::built_in());
  };
  const Suite suite = suite_of(R"("external:own/manifest.json",
      {"method": "external:own/manifest.json", "as": "a"}, "raymoval")");
  const std::string found = std::filesystem::canonical(folder / "own/manifest.json").string();
  REQUIRE(suite.methods.size() == 3);
  CHECK(suite.methods[0].method.address() == "external:" + found);
  CHECK(suite.methods[1].method.address() == "external:" + found);
  CHECK(suite.methods[1].name == "a");
  CHECK(suite.methods[2].method.address() == "raymoval:offline");
  // A missing file is searched from the working folder.
  CHECK_THROWS_WITH(
      suite_of(R"("external:elsewhere.json")"),
      Contains("elsewhere.json: there is no such manifest") && !Contains(folder.text()));
}

TEST_CASE("what is no suite is refused") {
  const test::TemporaryFolder folder;
  for (const char* text : {"[]", "3", R"({"methods": 3})", R"({"methods": [3, {"method": 4}]})"}) {
    const auto file = folder.write("suite.json", text);
    CHECK_THROWS_AS(read_suite(file, MethodRegistry::built_in()), ConfigurationError);
  }
}
