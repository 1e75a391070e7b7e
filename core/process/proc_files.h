// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace raymoval {

/// The text behind "key:" in a file below /proc; empty if the file or the key is not there.
std::string proc_field(const std::filesystem::path& file, std::string_view key);

/// The same for an amount of memory, in MiB; nothing if the file or the key is not there.
std::optional<double> proc_mib(const std::filesystem::path& file, std::string_view key);

/// The memory of the machine in MiB, or of the control group if that has less. It is 0 if the
/// system does not tell.
double machine_memory_mib();

/// The limit on memory, in MiB, that holds where the user gives none: nine tenths of
/// `machine_memory_mib`.
double usual_memory_limit_mib();

}  // namespace raymoval
