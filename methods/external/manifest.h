// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/parameters.h"

namespace raymoval {

/// What a manifest says about a program.
struct Manifest {
  std::filesystem::path path;  ///< Absolute.
  std::string name, sentence, source, version;
  bool online = false;
  std::vector<std::string> notes;
  std::vector<std::string> command;  ///< As written; see `command_line`.
  std::vector<std::string> files;    ///< Files and folders of the program, besides the command's.
  double time_limit_s = 0.0;         ///< 0: the usual, by the number of scans.
  double disk_limit_gib = 32.0;      ///< Of the working folder.
  std::vector<ParameterSpec> parameters;
};

/// Reads a manifest (JSON with comments).
/// @throws ConfigurationError naming the file, the key, what is expected and the nearest legal key
Manifest read_manifest(const std::filesystem::path& path);

/// The command with "{here}" (the manifest's folder) and "{VARIABLE|default}" (an environment
/// variable, or the default where it is unset or empty) replaced. One item is one argument,
/// whatever blanks it holds; no shell reads it.
std::vector<std::string> command_line(const Manifest& manifest);

/// Hash of the manifest and of the content of the program: the files it lists, and each argument of
/// the command that is a path of a file as it stands or below "{here}". An interpreter found on
/// PATH or named by a variable is the machine's and does not count.
/// @throws DataError if a listed file is missing
std::string program_hash(const Manifest& manifest);

}  // namespace raymoval
