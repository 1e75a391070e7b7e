// SPDX-License-Identifier: MIT
#pragma once

#include "core/parallel.h"
#include "methods/remover.h"

namespace raymoval {

/// Runs two independent steps, each with the context to work in. With several threads they run in
/// parallel and are timed as one stage, because their times cannot be separated.
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

/// The same for steps within a longer stage, without a context. The first step may use all threads
/// once the second is done.
template <class First, class Second>
void side_by_side(const RunContext& context, First&& first, Second&& second) {
  parallel_for(context.threads, 2, 1, [&](std::size_t step) { step == 0 ? first() : second(); });
}

}  // namespace raymoval
