// SPDX-License-Identifier: MIT
#include "benchmark/suite/shipped_suites.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "benchmark/suite/suite.h"
#include "core/files/files.h"
#include "datasets/semantickitti/semantickitti.h"
#include "eval/protocol_registry.h"

using namespace raymoval;

namespace {

Suite shipped(const std::string& name) {
  const bool needs_data = read_text(find_suite(name)).find("{data}") != std::string::npos;
  return read_suite(find_suite(name), MethodRegistry::built_in(), needs_data ? "/data" : "");
}

}  // namespace

TEST_CASE("Every shipped suite can be read and says what it is for") {
  const std::vector<std::string> names = shipped_suite_names();
  for (const char* name :
       {"kth", "semantickitti", "simulated", "simulated-long", "simulated-quick"}) {
    CHECK(std::find(names.begin(), names.end(), name) != names.end());
  }
  for (const std::string& name : names) {
    CAPTURE(name);
    CHECK_NOTHROW(shipped(name));
    CHECK_FALSE(suite_sentence(name).empty());
  }
}

TEST_CASE("The suite semantickitti has the segments that papers compare on, and no other frames") {
  const Suite suite = shipped("semantickitti");
  REQUIRE(suite.sequences.size() == paper_segments().size());
  for (std::size_t i = 0; i < suite.sequences.size(); ++i) {
    CHECK(suite.sequences[i].path == "/data:" + paper_segments()[i].name);
    CHECK_FALSE(suite.sequences[i].options.frames);
  }
  REQUIRE(suite.protocols.size() == 1);
  CHECK(suite.protocols[0].options == protocol_defaults("erasor"));
}

TEST_CASE("The suite kth has every frame of its segments") {
  const Suite suite = shipped("kth");
  REQUIRE(suite.sequences.size() == 3);
  for (const SequenceRequest& request : suite.sequences) {
    REQUIRE(request.options.frames);
    CHECK(request.options.frames->stride == 1);
  }
  CHECK(suite.protocols[0].protocol == "dynamicmap");
}
