// SPDX-License-Identifier: MIT
#pragma once

#include "core/simd/simd.h"

namespace raymoval {

/// While it exists, kernels that are looked up are those of `set`, on every thread: tests compare
/// instruction sets with it, and benchmarks measure them. Methods never name a set. An inner scope
/// takes precedence over an outer one.
/// @note what looked its kernels up before, such as a `FirstHitCaster`, keeps them
class InstructionSetScope {
 public:
  explicit InstructionSetScope(InstructionSet set);
  ~InstructionSetScope();
  InstructionSetScope(const InstructionSetScope&) = delete;
  InstructionSetScope& operator=(const InstructionSetScope&) = delete;

 private:
  InstructionSet outer_;
};

}  // namespace raymoval
