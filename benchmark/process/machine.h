// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

namespace raymoval {

/// Version, compiler and build type of this program.
nlohmann::ordered_json build_record();

/// Processor, cores and memory, but nothing that names the machine or its user.
nlohmann::ordered_json machine_record();

/// Forgets the largest memory so far, so that `peak_memory_mib` gives the largest from now on.
/// @return false if the system does not allow it
bool reset_peak_memory();

/// The largest resident memory of this process in MiB; no value if the system does not tell.
std::optional<double> peak_memory_mib();

}  // namespace raymoval
