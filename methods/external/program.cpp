// SPDX-License-Identifier: MIT
#include "methods/external/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <system_error>

#include "core/error.h"
#include "core/process/child_process.h"
#include "core/text.h"

namespace raymoval::external_method {
namespace {

/// The file that `name` starts, as a shell would find it.
std::string found_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* path = std::getenv("PATH");
  for (const std::string_view folder : split(path != nullptr ? path : "/usr/bin:/bin", ':')) {
    const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file, ignored)) {
      return std::filesystem::absolute(file, ignored).string();
    }
  }
  throw MethodError(fmt::format(
      "the program '{}' is not on PATH; install it, or name it by its path in the manifest", name));
}

/// What the program printed last, as the end of a message.
std::string printed_text(const std::string& output) {
  const std::size_t end = output.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return " and printed nothing";
  return ". It printed last:\n" + output.substr(0, end + 1);
}

/// What went wrong, to follow the program's name; empty if nothing did.
std::string fault_of(const ChildEnd& end, const ProgramCall& call) {
  switch (end.kind) {
    case ChildEnd::Kind::kCancelled:
      throw Cancelled();
    case ChildEnd::Kind::kNotStarted:
      return fmt::format("cannot be started ({})", std::generic_category().message(end.code));
    case ChildEnd::Kind::kTimeout:
      return fmt::format("did not end within {} s and was ended", number_text(call.time_limit_s)) +
             printed_text(end.output_tail);
    case ChildEnd::Kind::kOutOfDisk:
      return fmt::format(
                 "filled its working folder with more than {} GiB and was ended; raise "
                 "'disk_limit_gib' in the manifest or run on fewer frames",
                 number_text(call.disk_limit_gib)) +
             printed_text(end.output_tail);
    case ChildEnd::Kind::kOutOfMemory:
      break;  // There is no limit on memory here: whoever runs the method sets it.
    case ChildEnd::Kind::kSignalled:
      return "was ended by " + signal_text(end.code) + printed_text(end.output_tail);
    case ChildEnd::Kind::kExited:
      if (end.code == 0) return "";
      return fmt::format("ended with exit code {}", end.code) + printed_text(end.output_tail);
  }
  throw InternalError("unknown end of a program");
}

}  // namespace

void run_program(const ProgramCall& call) {
  ChildSetup setup;
  setup.program = found_program(call.command.front());
  setup.arguments = call.command;
  setup.folder = call.folder;
  setup.environment = call.environment;
  setup.limits.seconds = call.time_limit_s;
  setup.limits.folder_mib = 1024.0 * call.disk_limit_gib;
  setup.cancel = call.cancel;
  const std::string fault = fault_of(run_child(setup), call);
  if (call.cancel != nullptr && call.cancel->load()) throw Cancelled();
  if (!fault.empty()) throw MethodError(fmt::format("'{}' {}", setup.program, fault));
}

}  // namespace raymoval::external_method
