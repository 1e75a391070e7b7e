// SPDX-License-Identifier: MIT
#include "tests/fuzz/cloud_input.h"
#include "tests/fuzz/target.h"

namespace {

void try_ply(std::string_view bytes) {
  raymoval::fuzz::try_cloud("scan.ply", bytes);
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(ply, try_ply)
