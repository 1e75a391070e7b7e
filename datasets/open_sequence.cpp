// SPDX-License-Identifier: MIT
#include "datasets/open_sequence.h"

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bags/bag.h"
#include "datasets/clouds/cloud_file.h"
#include "datasets/deskew/deskew.h"
#include "datasets/ego/ego_region.h"
#include "datasets/ego/sensor_origin.h"
#include "datasets/layouts.h"
#include "datasets/sequence_poses.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// " Known are: a SemanticKITTI sequence (...), ...".
std::string known_text() {
  std::vector<std::string> known;
  for (const Layout& layout : layouts()) known.push_back(layout.expected);
  return " Known are: " + join(known) + ".";
}

bool is_scan_folder(const fs::path& name) {
  for (const Layout& layout : layouts()) {
    if (!layout.scan_folder.empty() && name == layout.scan_folder) return true;
  }
  return false;
}

/// The folder above `path`, if it is a sequence and `path` is its scan folder or one of its scans;
/// else empty.
std::string sequence_above(const fs::path& path) {
  fs::path folder = fs::absolute(path).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  for (int level = 0; level < 2; ++level) {
    const fs::path name = folder.filename();
    folder = folder.parent_path();
    if (is_scan_folder(name) && is_folder(folder / name)) return folder.string();
  }
  return "";
}

/// Refuses the scan folder of a sequence in another layout. A folder with its own poses is a
/// sequence, with any name.
void check_not_part(const std::string& path, const SequenceOptions& options) {
  if (!is_folder(path) || options.poses || !list_files(path, {".txt"}).empty()) return;
  const std::string above = sequence_above(path);
  if (above.empty()) return;
  throw DataError(path + ": holds scans only; the sequence they belong to is " + above + ".");
}

/// Reports what a folder of known files lacks to be a sequence.
void check_known_files(const fs::path& folder) {
  for (const fs::path& entry : entries_of(folder)) {
    // Both throw: the files are no parts of one recording, or of a format that is not supported.
    if (if_whole([&] { return is_bag(entry); }) == true) (void)open_bag(folder);
    if (!conversion_text(entry).empty()) (void)read_layout(entry);
  }
}

/// Refuses options that only recordings have.
void check_topics(const Layout& layout, const std::string& path, const SequenceOptions& options) {
  if ((!options.topic && !options.pose_topic) || layout.name == bags_layout().name) return;
  throw UsageError(path + ": is not a recording, so there is no topic to choose by " +
                   (options.topic ? "--topic" : "--pose-topic") + ". Leave it out.");
}

/// Refuses the rule moving-now for a sequence that does not support it.
void check_label_rule(const Sequence& sequence, const SequenceOptions& options) {
  if (!options.label_rule || is_rule_file(*options.label_rule) || sequence.moving_now) return;
  throw UsageError("--label-rule moving-now cannot be used on sequence " + sequence.name + ": " +
                   (sequence.labels ? "its labels have no times of motion" : "it has no labels") +
                   ". Leave it out.");
}

/// The files of `folder` with "pose" in their names.
std::vector<std::string> pose_files(const fs::path& folder) {
  std::vector<std::string> files;
  for (const fs::path& file : list_files(folder, {".txt", ".csv", ".tum"})) {
    if (file.filename().string().find("pose") != std::string::npos) files.push_back(file.string());
  }
  return files;
}

/// " Its folder scans/ has scans: ...", if one of its folders has, or how to convert the dump of a
/// known program; else empty.
std::string scans_below_text(const fs::path& folder) {
  const std::string script = "python3 examples/recipes/poses_of.py ";
  if (is_folder(folder / "oxts") && is_folder(folder / "velodyne_points/data")) {
    const fs::path calibration = (folder / "../calib_imu_to_velo.txt").lexically_normal();
    return " It is a drive of KITTI raw. `" + script + "kitti-raw " + folder.string() + " " +
           calibration.string() + "` writes its poses; then use " +
           (folder / "velodyne_points/data").string() + " --poses " +
           (folder / "poses.txt").string() + ".";
  }
  for (const fs::path& below : folders_in(folder)) {
    if (list_files(below, cloud_extensions()).empty()) continue;
    if (is_file(below / "cloud.pcd") && is_file(below / "data")) {
      return " It is a dump of hdl_graph_slam. `" + script + "hdl-graph-slam " + folder.string() +
             " keyframes` makes keyframes, a folder of scans with poses.";
    }
    const std::vector<std::string> poses = pose_files(folder);
    return " Its folder " + below.filename().string() + "/ has scans: use " + below.string() +
           " --poses " + (poses.size() == 1 ? poses[0] : "FILE") + "." +
           (poses.size() > 1 ? " FILE may be one of " + join(poses) + "." : "");
  }
  return "";
}

[[noreturn]] void throw_unrecognised(const std::string& path) {
  if (is_folder(path)) {
    check_known_files(path);
    throw DataError(path + ": no known layout; found " + content_text(path) + "." +
                    scans_below_text(path) + known_text());
  }
  if (is_there(path)) {
    const std::string above = sequence_above(path);
    if (!conversion_text(path).empty()) (void)read_layout(path);
    if (above.empty() && !cloud_extension(path).empty()) {
      throw DataError(
          path +
          ": is one cloud, expected a folder with a file for each scan, and their poses. If "
          "the points of a merged map name their scan, PDAL splits it: pdal translate map.las "
          "scan_#.las groupby --filters.groupby.dimension=PointSourceId.");
    }
    if (above.empty()) throw DataError(path + ": is a file, expected a folder." + known_text());
    throw DataError(path + ": is a scan, expected the folder of its sequence: " + above + ".");
  }
  const std::string folder = path.substr(0, path.rfind(':'));
  const auto near = closest_name(folder, scene_names());
  throw DataError(folder + ": no such folder." +
                  (near ? " Did you mean the scene '" + *near + "'?" : "") + known_text());
}

/// The scene names of the layout of `path`; null if it is no scene.
const SceneNames* scenes_of(const std::string& path) {
  for (const Layout& layout : layouts()) {
    if (layout.scenes && layout.recognise(path)) return &*layout.scenes;
  }
  return nullptr;
}

DeskewInput deskew_input(const Sequence& sequence) {
  return {sequence.records, sequence.motion, sequence.stamps, !sequence.topics.empty()};
}

/// The clock of the points of a sequence; `sequence` gets notes on it.
PointClock point_clock_of(Sequence& sequence) {
  if (sequence.records == nullptr || sequence.motion == nullptr) {
    throw UsageError("--deskew cannot be used on sequence " + sequence.name +
                     ": its points have no times. Leave it out.");
  }
  PointClock clock =
      find_point_clock(*sequence.scans, deskew_input(sequence), sequence.point_time_unit);
  sequence.notes.insert(sequence.notes.end(), clock.notes.begin(), clock.notes.end());
  return clock;
}

/// Merged clouds are split where a method reads them (see `with_split_sensors`).
void check_merged(const Sequence& sequence) {
  const SensorPlaces& places = *sequence.sensor_origin;
  if (sequence.records == nullptr) {
    throw UsageError("--sensor-origin " + sensor_places_text(places) + ": sequence " +
                     sequence.name + " has no fields of points. Leave it out.");
  }
  (void)sensor_positions(*sequence.records, sequence.scans->load(0), places);
}

/// The place of the sensor of each scan of several topics.
std::vector<Eigen::Vector3d> places_of_topics(const Sequence& sequence) {
  const SensorPlaces& given = *sequence.sensor_origin;
  const std::string form = "Give --sensor-origin topic:0=X,Y,Z/1=X,Y,Z, in the order of --topic.";
  std::vector<Eigen::Vector3d> places;
  for (const std::size_t topic : sequence.topics) {
    const auto found = given.by_number.find(static_cast<std::int64_t>(topic));
    if (given.field == kTopicField && found != given.by_number.end()) {
      places.push_back(found->second);
      continue;
    }
    throw UsageError("--sensor-origin " + sensor_places_text(given) + ": has no place of topic " +
                     std::to_string(topic) + " of sequence " + sequence.name + ". " + form);
  }
  return places;
}

void bring_to_sensor_origin(Sequence& sequence) {
  if (!sequence.topics.empty()) {
    sequence.scans =
        std::make_shared<SensorOriginSource>(sequence.scans, places_of_topics(sequence));
    return;
  }
  if (!sequence.sensor_origin->field.empty()) return check_merged(sequence);
  const Eigen::Vector3d& origin = sequence.sensor_origin->one;
  sequence.scans = std::make_shared<SensorOriginSource>(
      sequence.scans, std::vector<Eigen::Vector3d>(sequence.scans->size(), origin));
  if (sequence.motion == nullptr) return;
  const MotionStep step{{}, Pose(Eigen::Translation3d{origin})};
  sequence.motion = std::make_shared<SensorMotion>(sequence.motion->followed_by({step}));
}

}  // namespace

Sequence open_sequence(const std::string& path, const SequenceOptions& given,
                       const OpenContext& context) {
  SequenceOptions options = given;
  const PoseWork pose_work = take_pose_work(options);
  const Layout* layout = recognised_layout(path);
  if (layout == nullptr) throw_unrecognised(path);
  if (!layout->scenes && layout->scan_folder.empty()) check_not_part(path, options);
  check_topics(*layout, path, options);
  Sequence sequence = layout->open(path, options, context);
  check_label_rule(sequence, options);
  make_poses(sequence, pose_work, context);
  if (sequence.sensor_origin) bring_to_sensor_origin(sequence);
  std::optional<PointClock> clock;
  if (sequence.deskew) clock = point_clock_of(sequence);
  if (sequence.drop_ego.kind != EgoRegion::Kind::kNone) {
    std::optional<Eigen::Vector3d> up;
    if (sequence.up_choice && sequence.up_choice->known()) {
      up = sequence.up_choice->known()->direction;
    }
    sequence.scans = std::make_shared<EgoFreeSource>(sequence.scans, sequence.drop_ego, up);
  }
  // The ego vehicle is fixed in the sensor frame, so it is removed before the motion correction.
  if (clock) {
    sequence.scans =
        std::make_shared<DeskewedSource>(sequence.scans, deskew_input(sequence), *clock);
  }
  sequence.opened = sequence.scans;
  return sequence;
}

std::string sequence_name(const std::string& path, const SequenceOptions& options) {
  if (options.name) return *options.name;
  const SceneNames* scenes = scenes_of(path);
  if (scenes != nullptr) return scenes->sequence_name(path);
  SequenceOptions quick = options;
  (void)take_pose_work(quick);  // The name does not depend on the poses.
  return open_sequence(path, quick).name;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const Layout& layout : layouts()) {
    if (!layout.scenes) continue;
    for (const std::string& name : layout.scenes->names()) names.push_back(name);
  }
  return names;
}

bool is_scene(const std::string& path) {
  return scenes_of(path) != nullptr;
}

bool is_at_hand(const std::string& path) {
  const SceneNames* scenes = scenes_of(path);
  return scenes == nullptr || !scenes->is_made || scenes->is_made(path);
}

std::string scene_or_folder(const std::string& path, const fs::path& base) {
  const SceneNames* scenes = scenes_of(path);
  if (scenes == nullptr || !is_folder(base / path)) return "";
  return path + ": is a scene and also a folder here; write ./" + path + " for the folder, or " +
         scenes->unmistakable(path) + " for the scene.";
}

void check_not_both(const std::string& path) {
  const std::string both = scene_or_folder(path);
  if (!both.empty()) throw UsageError(both);
}

}  // namespace raymoval
