// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

namespace raymoval {

/// Version, compiler and build type of this program.
nlohmann::ordered_json build_record();

/// Cores, processor and memory; nothing that names the machine or its user.
nlohmann::ordered_json machine_record();

/// Forgets the largest memory use so far, so that `peak_memory_mib` is that since now.
/// @return false if the system does not allow it
bool reset_peak_memory();

/// Largest resident memory of the whole process in MiB, nothing if the system does not tell.
std::optional<double> peak_memory_mib();

}  // namespace raymoval
