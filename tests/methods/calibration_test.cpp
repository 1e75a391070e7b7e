// SPDX-License-Identifier: MIT
#include "methods/calibration.h"

#include <catch2/catch.hpp>

#include "methods/registry.h"

using namespace raymoval;

TEST_CASE("confidence lies on straight lines between the knots, and is flat beyond") {
  const Calibration calibration{"", {{0.25F, 0.1F}, {0.5F, 0.3F}, {0.75F, 0.9F}}};
  CHECK(calibration.confidence(0.0F) == 0.1F);
  CHECK(calibration.confidence(0.25F) == 0.1F);
  CHECK(calibration.confidence(0.375F) == Approx(0.2));  // Half of the way from 0.1 to 0.3.
  CHECK(calibration.confidence(0.5F) == 0.3F);
  CHECK(calibration.confidence(0.7F) == Approx(0.78));  // Four fifths of the way from 0.3 to 0.9.
  CHECK(calibration.confidence(0.75F) == 0.9F);
  CHECK(calibration.confidence(1.0F) == 0.9F);
}

TEST_CASE("the curves of the methods rise and stay within 0 and 1") {
  int curves = 0;
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    INFO(entry->name);
    CHECK(entry->confidence.empty() == entry->confidence.sentence.empty());
    if (entry->confidence.empty()) continue;
    ++curves;
    const std::vector<Calibration::Knot>& curve = entry->confidence.curve;
    CHECK(curve.front().confidence >= 0.0F);
    CHECK(curve.back().confidence <= 1.0F);
    for (std::size_t i = 1; i < curve.size(); ++i) {
      CHECK(curve[i - 1].evidence < curve[i].evidence);
      CHECK(curve[i - 1].confidence < curve[i].confidence);
    }
  }
  CHECK(curves == 2);  // octomap and raymoval_plus.
}
