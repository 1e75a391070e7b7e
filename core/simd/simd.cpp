// SPDX-License-Identifier: MIT
#include "core/simd/simd.h"

#include <atomic>

#include "core/simd/instruction_set_scope.h"
#include "core/simd/instruction_sets.h"

namespace raymoval {
namespace {

/// The set of the innermost InstructionSetScope.
std::atomic<InstructionSet> scoped_set{InstructionSet::kBest};

/// The bits of all sets up to and including `target`. In Highway's bits the best target is the
/// lowest.
std::int64_t up_to(std::int64_t target) {
  return ~(target - 1);
}

}  // namespace

InstructionSetScope::InstructionSetScope(InstructionSet set) : outer_(scoped_set.exchange(set)) {}
InstructionSetScope::~InstructionSetScope() {
  scoped_set = outer_;
}

std::int64_t highway_targets() {
  const InstructionSet set = scoped_set;
  if (set == InstructionSet::kPlain) return 0;
  static const std::int64_t here = hwy::SupportedTargets();  // Slow to find out.
#if HWY_ARCH_X86
  switch (set) {
    case InstructionSet::kSse4:
      return here & up_to(HWY_SSE4);
    case InstructionSet::kAvx2:
      return here & up_to(HWY_AVX2);
    default:
      break;
  }
#endif
  return here;
}

const char* instruction_set_name(InstructionSet set) {
  switch (set) {
    case InstructionSet::kPlain:
      return "plain";
    case InstructionSet::kSse4:
      return "SSE4";
    case InstructionSet::kAvx2:
      return "AVX2";
    default:
      return "best";
  }
}

std::vector<InstructionSet> supported_instruction_sets() {
  std::vector<InstructionSet> sets = {InstructionSet::kPlain};
#if HWY_ARCH_X86
  const std::int64_t here = hwy::SupportedTargets();
  if ((here & HWY_SSE4) != 0) sets.push_back(InstructionSet::kSse4);
  if ((here & HWY_AVX2) != 0) sets.push_back(InstructionSet::kAvx2);
#endif
  return sets;
}

}  // namespace raymoval
