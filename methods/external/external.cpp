// SPDX-License-Identifier: MIT
#include "methods/external/external.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/files/scratch_folder.h"
#include "methods/external/manifest.h"
#include "methods/external/program.h"
#include "methods/external/sequence_files.h"

namespace raymoval {
namespace external_method {
namespace {

constexpr std::string_view kPrefix = "external:";

/// The variables that hold a program to the threads that a method may use, and to one order of
/// Python's hashes.
std::vector<std::pair<std::string, std::string>> environment_for(int threads) {
  std::vector<std::pair<std::string, std::string>> variables = {{"PYTHONHASHSEED", "0"}};
  for (const char* name : {"RAYMOVAL_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS",
                           "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"}) {
    variables.emplace_back(name, std::to_string(threads));
  }
  return variables;
}

/// Whether somebody who writes a program wants to see what it got and gave.
bool is_folder_kept() {
  const char* asked = std::getenv("RAYMOVAL_KEEP_WORKING_FOLDER");
  return asked != nullptr && *asked != '\0';
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

  void run_command(const std::filesystem::path& folder, std::size_t scans,
                   const RunContext& context) const {
    const StageScope timed(context.times, "program");
    context.begin_pass("program", 1);
    run_program({command_line(manifest_), folder, environment_for(context.threads),
                 time_limit_s(scans), manifest_.disk_limit_gib, context.cancel});
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
  entry.variants = {{"default",
                     read.online ? "Answers for a scan from it and earlier ones, its manifest says."
                                 : "Answers from all scans.",
                     read.online,
                     {}}};
  entry.manifest = read.path.string();
  entry.make = [read = std::move(read)](const Configuration& parameters) {
    return std::make_unique<external_method::External>(read, parameters);
  };
  return entry;
}

}  // namespace raymoval
