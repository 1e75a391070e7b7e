// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "benchmark/result/run_record.h"

namespace raymoval {

/// Version, compiler and build type of this program.
BuildRecord build_record();

/// Processor, cores and memory; nothing that names the machine or its user.
/// @param threads that the run uses
MachineRecord machine_record(int threads);

/// Forgets the largest memory use so far, so that `peak_memory_mib` is that since now.
/// @return false if the system does not allow it
bool reset_peak_memory();

/// Largest resident memory of the whole process in MiB, nothing if the system does not tell.
std::optional<double> peak_memory_mib();

}  // namespace raymoval
