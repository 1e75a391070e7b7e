// SPDX-License-Identifier: MIT
#pragma once

#include "tests/eval/memory_sequence.h"

namespace raymoval::test {

/// The worked example of the protocols' description: 12 points in two scans, of which one is near.
inline MemorySequence worked_example() {
  LabelledScan first;
  first.add(2.60f, 0.00f, -1.63f, 40);
  first.add(5.05f, 0.05f, -1.63f, 40, true);
  first.add(5.15f, 0.15f, -1.63f, 40, true);
  first.add(8.05f, 2.05f, -0.63f, 252, true);
  first.add(8.07f, 2.07f, -0.63f, 252, true);
  first.add(8.15f, 2.15f, -0.63f, 70);
  first.add(-6.05f, -3.05f, -1.63f, 50, true);
  first.add(0.05f, 6.10f, -1.63f, 48);
  first.add(-0.05f, 6.10f, -1.63f, 254, true);
  LabelledScan second;
  second.pose.translation().x() = 1.0;
  second.add(4.07f, 0.07f, -1.63f, 40);
  second.add(11.05f, 0.05f, -1.63f, 40, true);
  second.add(10.95f, 0.05f, -1.63f, 327933);  // 253 of instance 5.
  return MemorySequence({first, second});
}

}  // namespace raymoval::test
