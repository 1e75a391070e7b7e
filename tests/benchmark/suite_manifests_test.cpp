// SPDX-License-Identifier: MIT
#include "benchmark/suite/suite_manifests.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using nlohmann::json;

TEST_CASE("manifests are looked up beside the suite file first") {
  const test::TemporaryFolder folder;
  (void)folder.write("own/manifest.json", "{}");
  const json suite = json::parse(R"({"methods": ["external:own/manifest.json",
      {"method": "external:own/manifest.json", "as": "a"}, "external:elsewhere.json", "raymoval"]})");
  const json located = with_located_manifests(suite, folder.text());
  const std::string found = "external:" + folder.text() + "/own/manifest.json";
  CHECK(located["methods"] ==
        json({found, {{"method", found}, {"as", "a"}}, "external:elsewhere.json", "raymoval"}));
}

TEST_CASE("what is no suite is left for who reads it to complain") {
  for (const char* text : {"[]", "3", R"({"methods": 3})", R"({"methods": [3, {"method": 4}]})"}) {
    CHECK(with_located_manifests(json::parse(text), ".") == json::parse(text));
  }
}
