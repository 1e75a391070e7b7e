// SPDX-License-Identifier: MIT
#include "benchmark/clean/outputs/label_folder.h"

#include "benchmark/result/removals/removal_files.h"

namespace raymoval {

void LabelFolder::add(const CleanedScan& scan) {
  write_removal(folder_.place(), scan.scan, scan.mask);
}

}  // namespace raymoval
