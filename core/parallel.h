// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace raymoval {

/// Number of hardware threads, at least 1.
int hardware_threads();

/// Runs `body(begin, end)` over [0, count) cut into chunks of `grain` on at most `threads` threads.
/// The chunks depend on `count` and `grain` only. So values that are computed per chunk and
/// combined in chunk order are the same for any number of threads. The first exception (of the
/// lowest chunk) is rethrown.
void parallel_chunks(int threads, std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// Runs `body(i)` for each i in [0, count).
template <class Body>
void parallel_for(int threads, std::size_t count, std::size_t grain, Body&& body) {
  parallel_chunks(threads, count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

}  // namespace raymoval
