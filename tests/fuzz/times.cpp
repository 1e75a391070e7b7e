// SPDX-License-Identifier: MIT
#include <cmath>

#include "datasets/clouds/poses.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace {

using namespace raymoval;

void try_times(std::string_view bytes) {
  fuzz::may_refuse([&] {
    for (const double time : read_number_column(fuzz::input_file("times.txt", bytes))) {
      fuzz::require(std::isfinite(time), "a time is not finite");
    }
  });
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(times, try_times)
