// SPDX-License-Identifier: MIT
#include "methods/external/external.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/files/scratch_folder.h"
#include "core/process/child_process.h"
#include "core/text.h"
#include "methods/external/manifest.h"
#include "methods/external/sequence_files.h"

namespace raymoval {
namespace external_method {
namespace {

constexpr std::string_view kPrefix = "external:";

/// Environment variables that limit a program to the method's threads and fix the order of Python's
/// hashes.
std::vector<std::pair<std::string, std::string>> environment_for(int threads) {
  std::vector<std::pair<std::string, std::string>> variables = {{"PYTHONHASHSEED", "0"}};
  for (const char* name : {"RAYMOVAL_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS",
                           "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"}) {
    variables.emplace_back(name, std::to_string(threads));
  }
  return variables;
}

/// Whether the working folder is kept for the author of a program.
bool is_folder_kept() {
  const char* asked = std::getenv("RAYMOVAL_KEEP_WORKING_FOLDER");
  return asked != nullptr && *asked != '\0';
}

/// The file of the program `name`, searched as by a shell.
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
      "the program '{}' is not on PATH; install it, or give its path in the manifest", name));
}

/// The last output of the program, as the end of a message.
std::string printed_text(const std::string& output) {
  const std::size_t end = output.find_last_not_of(" \n\r\t");
  if (end == std::string::npos) return " and printed nothing";
  return ". It printed last:\n" + output.substr(0, end + 1);
}

/// The error, to follow the program's name; empty if there is none.
std::string fault_of(const ChildEnd& end, double time_limit_s, double disk_limit_gib) {
  switch (end.kind) {
    case ChildEnd::Kind::kCancelled:
      throw Cancelled();
    case ChildEnd::Kind::kNotStarted:
      return fmt::format("cannot be started ({})", std::generic_category().message(end.code));
    case ChildEnd::Kind::kTimeout:
      return fmt::format("did not end within {} s and was ended", number_text(time_limit_s)) +
             printed_text(end.output_tail);
    case ChildEnd::Kind::kOutOfDisk:
      return fmt::format(
                 "filled its working folder with more than {} GiB and was ended; raise "
                 "'disk_limit_gib' in the manifest or run on fewer frames",
                 number_text(disk_limit_gib)) +
             printed_text(end.output_tail);
    case ChildEnd::Kind::kOutOfMemory:
      break;  // No memory limit is set here: the caller sets it.
    case ChildEnd::Kind::kSignalled:
      return "was ended by " + signal_text(end.code) + printed_text(end.output_tail);
    case ChildEnd::Kind::kExited:
      if (end.code == 0) return "";
      return fmt::format("ended with exit code {}", end.code) + printed_text(end.output_tail);
  }
  throw InternalError("unknown end of a program");
}

class External : public Remover {
 public:
  External(Manifest manifest, Configuration parameters)
      : manifest_(std::move(manifest)), parameters_(std::move(parameters)) {}

  void run(const ScanSource& scans, RemovalSink& sink, const RunContext& context) override {
    const ScratchFolder folder(kMethodFolder, is_folder_kept());
    if (is_folder_kept() && context.progress != nullptr) {
      context.progress->say("the working folder is kept: " + folder.path().string());
    }
    const auto points = write_files(folder.path(), scans, context);
    run_command(folder.path(), points.size(), context);
    const StageScope timed(context.times, "reading answers");
    read_answers(folder.path(), points, sink, context);
  }

 private:
  [[nodiscard]] std::vector<std::size_t> write_files(const std::filesystem::path& folder,
                                                     const ScanSource& scans,
                                                     const RunContext& context) const {
    const StageScope timed(context.times, "writing scans");
    return write_sequence_files(folder, scans, manifest_, parameters_, context);
  }

  /// The limit of the manifest, else 30 s for each scan but at least ten minutes.
  [[nodiscard]] double time_limit_s(std::size_t scans) const {
    if (manifest_.time_limit_s > 0.0) return manifest_.time_limit_s;
    return std::max(600.0, 30.0 * static_cast<double>(scans));
  }

  /// Runs the program to its end; its output is kept for messages only.
  void run_command(const std::filesystem::path& folder, std::size_t scans,
                   const RunContext& context) const {
    const StageScope timed(context.times, "program");
    context.begin_pass("program", 1);
    ChildSetup setup;
    setup.arguments = command_line(manifest_);
    setup.program = found_program(setup.arguments.front());
    setup.folder = folder;
    setup.environment = environment_for(context.threads);
    setup.limits.seconds = time_limit_s(scans);
    setup.limits.folder_mib = 1024.0 * manifest_.disk_limit_gib;
    setup.cancel = context.cancel;
    const std::string fault =
        fault_of(run_child(setup), setup.limits.seconds, manifest_.disk_limit_gib);
    if (context.cancel != nullptr && context.cancel->load()) throw Cancelled();
    if (!fault.empty()) throw MethodError(fmt::format("'{}' {}", setup.program, fault));
    context.advance();
  }

  Manifest manifest_;
  Configuration parameters_;
};

}  // namespace
}  // namespace external_method

std::optional<std::filesystem::path> external_manifest(const std::string& method_name) {
  if (!method_name.starts_with(external_method::kPrefix)) return std::nullopt;
  return method_name.substr(external_method::kPrefix.size());
}

MethodEntry external_entry(const std::filesystem::path& manifest) {
  external_method::Manifest read = external_method::read_manifest(manifest);
  MethodEntry entry;
  entry.name = read.name;
  entry.sentence = read.sentence;
  entry.source = read.source;
  entry.version = read.version + "+" + external_method::program_hash(read).substr(0, 16);
  entry.notes = read.notes;
  entry.parameters = read.parameters;
  entry.variants = {
      {.name = "default",
       .sentence = read.online
                       ? "Answers for a scan from it and earlier ones, according to its manifest."
                       : "Answers from all scans.",
       .online = read.online}};
  entry.manifest = read.path.string();
  entry.make = [read = std::move(read)](const Configuration& parameters) {
    return std::make_unique<external_method::External>(read, parameters);
  };
  return entry;
}

}  // namespace raymoval
