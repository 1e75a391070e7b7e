// SPDX-License-Identifier: MIT
#include "datasets/sequence.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/error.h"
#include "core/files/files.h"
#include "core/scan/local_frame.h"
#include "core/text.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/clouds/frames.h"
#include "datasets/dynamicmap/dynamicmap.h"
#include "datasets/ego/ego_free_source.h"
#include "datasets/files/files.h"
#include "datasets/semantickitti/semantickitti.h"
#include "datasets/simulation/scene/library.h"
#include "datasets/simulation/scene/scene_text.h"
#include "datasets/simulation/street/street.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKnownLayouts =
    "Known are: a SemanticKITTI sequence (velodyne/*.bin, poses.txt, calib.txt), a SemanticKITTI "
    "root as ROOT:05 or ROOT:kitti-05 (sequences/NN), a DynamicMap sequence (pcd/*.pcd), a folder "
    "of .pcd, .ply or .bin scans with poses.txt, 'street', the built-in scene, and the simulated "
    "scenes of `raymoval list scenes`.";

/// Up to eight names in `folder`, for messages.
std::string content_text(const fs::path& folder) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> names;
  const std::vector<fs::path> folders = folders_in(folder);
  for (const fs::path& path : entries_of(folder)) {
    const bool is_one = std::find(folders.begin(), folders.end(), path) != folders.end();
    names.push_back(path.filename().string() + (is_one ? "/" : ""));
  }
  if (names.empty()) return "nothing";
  const std::size_t more = names.size() - std::min(names.size(), kMost);
  names.resize(std::min(names.size(), kMost));
  return join(names) + (more > 0 ? " and " + grouped_text(more) + " more" : "");
}

/// The folder above `path`, if that is a sequence and `path` its folder of scans or one of these;
/// else empty.
std::string sequence_above(const fs::path& path) {
  fs::path folder = fs::absolute(path).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  for (int level = 0; level < 2; ++level) {
    const fs::path name = folder.filename();
    folder = folder.parent_path();
    if ((name == "velodyne" || name == "pcd") && is_folder(folder / name)) return folder.string();
  }
  return "";
}

Sequence open_folder(const fs::path& folder, const SequenceOptions& options) {
  if (has_folder(folder / "velodyne")) return open_semantickitti(folder, options);
  if (has_folder(folder / "pcd")) return open_dynamicmap(folder, options);
  if (!list_files(folder, cloud_extensions()).empty()) {
    // With poses of its own it is a sequence whatever its name.
    const std::string above = sequence_above(folder);
    if (!above.empty() && !options.poses && list_files(folder, {".txt"}).empty()) {
      throw DataError(folder.string() + ": holds scans only; the sequence they belong to is " +
                      above + ".");
    }
    return open_files(folder, options);
  }
  if (is_folder(folder / "sequences")) {
    throw UsageError(folder.string() + ": is a root with " + content_text(folder / "sequences") +
                     " in sequences/; say which one, such as " + folder.string() + ":05.");
  }
  throw DataError(folder.string() + ": no known layout; found " + content_text(folder) + ". " +
                  kKnownLayouts);
}

/// The nearest scene name, for a path that leads nowhere; empty if none is near.
std::string scene_suggestion(const std::string& name) {
  std::vector<std::string> names = simulated_scene_names();
  names.emplace_back("street");
  const auto near = closest_name(name, names);
  return near ? " Did you mean the scene '" + *near + "'?" : "";
}

/// Generated unless it is in the cache, then read like a recorded drive.
Sequence open_scene(const std::string& text, const SequenceOptions& options,
                    const OpenContext& context) {
  return open_semantickitti(
      cached_simulation(parse_scene(text), default_cache_root(), context.threads, context.progress,
                        context.cancel, context.check_content),
      options);
}

}  // namespace

UpDirection Sequence::up() const {
  // From the scans as opened: what is only looked at for this is nothing that a method has read.
  return up_choice ? up_choice->get(opened ? *opened : *scans) : UpDirection{};
}

Pose Sequence::method_frame() const {
  return raymoval::method_frame(*scans, up().direction);
}

Pose Sequence::upright_frame() const {
  Pose T_upright_world = Pose::Identity();
  T_upright_world.linear() = turn_to_z(up().direction);
  return T_upright_world;
}

DataRecord Sequence::record() const {
  DataRecord data{name,
                  layout,
                  source,
                  frames,
                  scans->size(),
                  poses_file,
                  scans->sensor().name,
                  scans->sensor().basis};
  data.up = up_text(up().direction);
  data.up_source = up_source_name(up().source);
  data.scan_period_s = scan_period_s;
  data.range_m = range_m;
  if (const EgoFreeSource* without_ego = ego_free_source(*this)) {
    data.drop_ego = {ego_region_text(without_ego->asked()), ego_region_text(without_ego->region())};
  }
  if (labels) data.label_rule = label_rule;
  return data;
}

namespace {

/// The sequence with all that its scans hold.
Sequence open_whole(const std::string& path, const SequenceOptions& options,
                    const OpenContext& context) {
  if (path == "street") return open_street(options);
  if (names_scene(path)) return open_scene(path, options, context);
  if (is_folder(path)) return open_folder(path, options);
  if (is_there(path)) {
    const std::string above = sequence_above(path);
    if (!above.empty()) {
      throw DataError(path + ": is a scan, expected the folder of its sequence: " + above + ".");
    }
    throw DataError(path + ": is a file, expected a folder. " + kKnownLayouts);
  }
  const std::size_t colon = path.rfind(':');
  const std::string root = path.substr(0, colon);
  for (const PaperSegment& segment : paper_segments()) {
    if (path != segment.name) continue;
    throw DataError(path + ": no such folder; the segment of that name is ROOT:" + path +
                    ", with ROOT the folder of SemanticKITTI that holds sequences/.");
  }
  if (colon == std::string::npos || !is_folder(root)) {
    throw DataError(root + ": no such folder." + scene_suggestion(root) + " " + kKnownLayouts);
  }
  return open_semantickitti_root(root, path.substr(colon + 1), options);
}

}  // namespace

Sequence open_sequence(const std::string& path, const SequenceOptions& options,
                       const OpenContext& context) {
  Sequence sequence = open_whole(path, options, context);
  if (sequence.drop_ego.kind != EgoRegion::Kind::kNone) {
    sequence.scans = std::make_shared<EgoFreeSource>(sequence.scans, sequence.drop_ego);
  }
  sequence.opened = sequence.scans;
  return sequence;
}

std::string sequence_name(const std::string& path, const SequenceOptions& options) {
  if (options.name) return *options.name;
  if (path == "street" || !names_scene(path)) return open_sequence(path, options).name;
  return simulated::find_world(parse_scene(path).scene).name;
}

bool is_scene(const std::string& path) {
  return path == "street" || names_scene(path);
}

std::string scene_or_folder(const std::string& path, const fs::path& base) {
  if (!is_scene(path) || !is_folder(base / path)) return "";
  const std::string both =
      path + ": is a scene and also a folder here; write ./" + path + " for the folder, or ";
  // The street has no options to be told by.
  if (path == "street") return both + "start where there is no such folder for the scene.";
  return both + path.substr(0, path.find(':')) + ":seed=1 for the scene.";
}

void check_not_both(const std::string& path) {
  const std::string both = scene_or_folder(path);
  if (!both.empty()) throw UsageError(both);
}

}  // namespace raymoval
