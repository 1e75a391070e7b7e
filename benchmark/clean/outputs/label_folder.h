// SPDX-License-Identifier: MIT
#pragma once

#include "benchmark/clean/outputs/clean_output.h"
#include "benchmark/clean/outputs/output_folder.h"

namespace raymoval {

/// A label file for each scan: 251 = removed, 9 = kept, 0 = in no output.
class LabelFolder : public CleanOutput {
 public:
  explicit LabelFolder(const std::filesystem::path& path) : folder_(path) {}
  void add(const CleanedScan& scan) override;
  void finish() override {}
  void commit_with(Replacements& together) override { folder_.commit_with(together); }

 private:
  OutputFolder folder_;
};

}  // namespace raymoval
