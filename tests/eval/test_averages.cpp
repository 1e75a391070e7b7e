// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "eval/averages.h"
#include "eval/published/published.h"

namespace raymoval {
namespace {

/// PR, RR and F1 on a number of segments, and their averages.
struct Segments {
  SegmentValues PR, RR, F1;

  void add(std::optional<double> pr, std::optional<double> rr) {
    PR.push_back(pr);
    RR.push_back(rr);
    F1.push_back(pr && rr ? std::optional(f1_from_percent(*pr, *rr)) : std::nullopt);
  }
  [[nodiscard]] Mean F1_of_means() const { return combined_means(PR, RR, f1_from_percent); }
};

Segments published_segments(const std::string& method) {
  const PublishedTable table =
      load_published_table(RAYMOVAL_SOURCE_DIR "/results/published/raymoval_table2.json");
  Segments segments;
  for (const PublishedRow& row : table.rows) {
    if (row.method == method) segments.add(row.value("PR"), row.value("RR"));
  }
  return segments;
}

}  // namespace

TEST_CASE("the five published segments give both averages of F1", "[averages]") {
  // Recomputed from the printed PR and RR.
  struct Expected {
    const char* method;
    double PR, RR, mean_F1, F1_of_means;
  };
  for (const Expected& expected : {Expected{"OctoMap-0.2", 30.236, 99.816, 0.4599, 0.4641},
                                   Expected{"Peopleremover", 35.235, 91.875, 0.5081, 0.5094},
                                   Expected{"Removert RM3+RV1", 87.229, 82.310, 0.8362, 0.8470},
                                   Expected{"ERASOR", 90.510, 97.401, 0.9381, 0.9383},
                                   Expected{"Raymoval", 93.217, 92.566, 0.9288, 0.9289}}) {
    CAPTURE(expected.method);
    const Segments segments = published_segments(expected.method);
    CHECK(mean_of(segments.PR).value.value() == Approx(expected.PR).margin(0.00051));
    CHECK(mean_of(segments.RR).value.value() == Approx(expected.RR).margin(0.00051));
    CHECK(mean_of(segments.F1).value.value() == Approx(expected.mean_F1).margin(0.00005));
    CHECK(segments.F1_of_means().value.value() == Approx(expected.F1_of_means).margin(0.00005));
    CHECK(mean_of(segments.F1).segments == 5);
    CHECK(segments.F1_of_means().segments == 5);
  }
}

TEST_CASE("undefined segments are left out and counted", "[averages]") {
  // The second segment has nothing dynamic: only its PR counts. The third has nothing static.
  Segments segments;
  segments.add(80.0, 40.0);
  segments.add(100.0, {});
  segments.add({}, 100.0);
  CHECK(mean_of(segments.PR).value.value() == Approx(90.0));
  CHECK(mean_of(segments.PR).segments == 2);
  CHECK(mean_of(segments.RR).value.value() == Approx(70.0));
  CHECK(mean_of(segments.RR).segments == 2);
  CHECK(mean_of(segments.F1).segments == 1);
  CHECK(mean_of(segments.F1).value.value() == Approx(2 * 0.8 * 0.4 / 1.2));
  // Of 80 and 40 alone, and not of 90 and 70.
  CHECK(segments.F1_of_means().segments == 1);
  CHECK(segments.F1_of_means().value.value() == Approx(2 * 0.8 * 0.4 / 1.2));
}

}  // namespace raymoval
