// SPDX-License-Identifier: MIT
#include "tests/fuzz/cloud_input.h"
#include "tests/fuzz/target.h"

namespace {

void try_bin(std::string_view bytes) {
  raymoval::fuzz::try_cloud("scan.bin", bytes);
}

}  // namespace

RAYMOVAL_FUZZ_TARGET(bin, try_bin)
