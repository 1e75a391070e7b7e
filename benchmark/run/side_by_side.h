// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace raymoval {

/// Calls `work(i)` for each i in [0, count), up to `jobs` at once: each free thread takes the
/// lowest that nobody has taken. The calling thread is one of them. If one throws, no further are
/// taken, those that run are waited for, and the exception of the lowest is thrown.
/// @note Threads of its own, and not those of `parallel_for`: a child process dies with the thread
/// that started it (see `run_child`), and TBB ends its threads when it likes.
void run_side_by_side(int jobs, std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace raymoval
