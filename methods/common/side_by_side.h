// SPDX-License-Identifier: MIT
#pragma once

#include "core/parallel.h"
#include "methods/remover.h"

namespace raymoval {

/// Takes two steps that do not need each other, each of which gets the context to work in. With
/// several threads one is taken beside the other, and they are timed as one stage: what goes on
/// side by side cannot be told apart.
template <class OneStep, class OtherStep>
void side_by_side(const RunContext& context, const char* stage, OneStep&& one_step,
                  OtherStep&& other_step) {
  const bool together = context.threads > 1;
  const StageScope timed(together ? context.times : nullptr, stage);
  RunContext of_step = context;
  if (together) of_step.times = nullptr;
  parallel_for(context.threads, 2, 1,
               [&](std::size_t step) { step == 0 ? one_step(of_step) : other_step(of_step); });
}

/// The same for steps that are part of a longer stage and need no context. The first may use all
/// threads as soon as the second is done.
template <class First, class Second>
void side_by_side(const RunContext& context, First&& first, Second&& second) {
  parallel_for(context.threads, 2, 1, [&](std::size_t step) { step == 0 ? first() : second(); });
}

}  // namespace raymoval
