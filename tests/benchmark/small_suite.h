// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "benchmark/suite/suite.h"

namespace raymoval::test {

/// The first scans of a sequence under ERASOR's protocol, without a method yet.
inline Suite small_suite(const std::string& frames, const std::string& path = "street") {
  Suite suite;
  SequenceOptions options;
  options.frames = parse_frame_range(frames);
  suite.sequences.push_back({path, options});
  add_protocol(suite, "erasor", "");
  suite.threads = 1;
  return suite;
}

/// noop on the first scan of a sequence, and no controls.
inline Suite noop_on(const std::string& path) {
  Suite suite = small_suite("0:0", path);
  add_method(suite, "noop", "", MethodRegistry::built_in());
  suite.controls = false;
  return suite;
}

}  // namespace raymoval::test
