// SPDX-License-Identifier: MIT
#pragma once

#include "core/simd/simd.h"

namespace raymoval {

/// While it exists, kernels of `set` are used on every thread: tests compare instruction sets with
/// it, and benchmarks measure them. Methods never use it. An inner scope takes precedence over an
/// outer scope.
/// @note an object that selected its kernels before, such as a `FirstHitCaster`, keeps them
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
