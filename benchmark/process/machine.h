// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "benchmark/result/run_record.h"

namespace raymoval {

/// Version, compiler and build type of this program.
BuildRecord build_record();

/// Processor, cores and memory, but nothing that names the machine or its user.
/// @param threads that the run uses
MachineRecord machine_record(int threads);

/// Resets the peak memory, so that `peak_memory_mib` gives the largest value from now on.
/// @return false if the system does not allow it
bool reset_peak_memory();

/// The largest resident memory of this process in MiB; no value if the system does not report it.
std::optional<double> peak_memory_mib();

}  // namespace raymoval
