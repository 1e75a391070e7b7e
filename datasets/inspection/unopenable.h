// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "datasets/inspection/evidence/finding.h"
#include "datasets/sequence.h"

namespace raymoval::inspection {

/// Mistakes with a name that keep the sequence at `path` from being opened.
std::vector<Finding> unopenable_findings(const std::string& path, const SequenceOptions& options);

}  // namespace raymoval::inspection
