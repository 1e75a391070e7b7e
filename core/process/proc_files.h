// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raymoval {

/// The text behind "key:" in a file below /proc; empty if the file or the key is not there.
std::string proc_field(const std::filesystem::path& file, std::string_view key);

/// The same for an amount of memory, in MiB; nothing if the file or the key is not there.
std::optional<double> proc_mib(const std::filesystem::path& file, std::string_view key);

/// The sum of several amounts of memory in one file below /proc, in MiB; nothing if the file or one
/// of the keys is not there.
std::optional<double> proc_mib_sum(const std::filesystem::path& file,
                                   std::initializer_list<std::string_view> keys);

/// The folder of a process below /proc.
std::filesystem::path proc_folder(pid_t process);

/// The state of a process.
struct ProcessState {
  char letter = 'X';  ///< As in /proc/PID/stat: 'Z' is a zombie, 'X' is gone.
  pid_t parent = 0;
  pid_t session = 0;

  [[nodiscard]] bool has_ended() const { return letter == 'Z' || letter == 'X'; }
};

ProcessState process_state(pid_t process);

/// All processes that this one can see.
std::vector<pid_t> all_processes();

/// The children of all threads of a process, zombies too. If the kernel does not list them
/// (CONFIG_PROC_CHILDREN), the parents of all processes are read.
std::vector<pid_t> children_of(pid_t process);
/// The same, from the parents of all processes.
std::vector<pid_t> children_by_parent(pid_t process);

/// The memory of the machine in MiB, or of the control group if that has less. It is 0 if it is
/// unknown.
double machine_memory_mib();

/// The default limit on memory, in MiB: nine tenths of `machine_memory_mib`.
double usual_memory_limit_mib();

}  // namespace raymoval
