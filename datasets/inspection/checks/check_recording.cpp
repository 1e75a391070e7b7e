// SPDX-License-Identifier: MIT
#include "datasets/inspection/checks/checks.h"

namespace raymoval::inspection {
namespace {

/// A finding for each sentence, "PLACE: what is wrong.".
std::vector<Finding> look_damaged(Samples& samples) {
  std::vector<Finding> findings;
  for (const std::string& sentence : samples.sequence().damage) {
    const std::size_t colon = sentence.find(": ");
    const bool has_place = colon != std::string::npos;
    Finding finding;
    finding.where = has_place ? sentence.substr(0, colon) : "the recording";
    finding.what = has_place ? sentence.substr(colon + 2) : sentence;
    if (finding.what.ends_with('.')) finding.what.pop_back();
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace

std::vector<Check> recording_checks() {
  return {{"recording-damaged", "a recording is cut or damaged, or was never closed",
           "a whole recording, because what cannot be read of it is left out",
           "Copy it again and compare its size, or mend it; what could be read is used.",
           look_damaged}};
}

}  // namespace raymoval::inspection
