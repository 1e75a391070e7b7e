// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/parameters.h"

namespace raymoval::external_method {

/// The content of a manifest.
struct Manifest {
  std::filesystem::path path;  ///< Absolute.
  std::string name, sentence, source, version;
  bool online = false;
  std::vector<std::string> notes;
  std::vector<std::string> command;  ///< As written; see `command_line`.
  std::vector<std::string> files;    ///< Further files and folders of the program.
  double time_limit_s = 0.0;         ///< 0 means the usual limit for the number of scans.
  double disk_limit_gib = 32.0;      ///< Of the working folder.
  std::vector<ParameterSpec> parameters;
};

/// Reads a manifest (JSON with comments).
/// @throws ConfigurationError that names the file, the key, what is expected and the nearest valid
/// key
Manifest read_manifest(const std::filesystem::path& path);

/// The program and its arguments. "{here}" is replaced by the manifest's folder,
/// "{VARIABLE|default}" by an environment variable, or by the default if it is not set or empty.
/// One item is one argument, even with blanks; no shell reads it.
std::vector<std::string> command_line(const Manifest& manifest);

/// Hash of the manifest and of the program's files: the listed files, and each argument of the
/// command that is an absolute path of a file or the path of one below "{here}". An interpreter on
/// PATH or from a variable belongs to the machine and is not included.
/// @throws DataError if a listed file is missing
std::string program_hash(const Manifest& manifest);

}  // namespace raymoval::external_method
