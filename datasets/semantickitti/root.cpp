// SPDX-License-Identifier: MIT
#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "datasets/semantickitti/semantickitti.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// The segment of this name; null if there is none.
const PaperSegment* find_segment(const std::string& name) {
  for (const PaperSegment& segment : paper_segments()) {
    if (segment.name == name) return &segment;
  }
  return nullptr;
}

/// ROOT and 05 of "ROOT:05".
std::pair<std::string, std::string> parts_of_root(const std::string& path) {
  const std::size_t colon = path.rfind(':');
  if (colon == std::string::npos) return {path, ""};
  return {path.substr(0, colon), path.substr(colon + 1)};
}

bool names_root(const std::string& path) {
  if (is_folder(path)) return is_folder(fs::path(path) / "sequences");
  if (is_there(path)) return false;
  const auto [root, selection] = parts_of_root(path);
  return find_segment(path) != nullptr || (root.size() < path.size() && is_folder(root));
}

fs::path folder_in_root(const std::string& path) {
  const auto [root, selection] = parts_of_root(path);
  const PaperSegment* segment = find_segment(selection);
  return fs::path(root) / "sequences" / (segment != nullptr ? segment->sequence : selection);
}

[[noreturn]] void throw_not_in_root(const std::string& root, const std::string& selection,
                                    std::vector<std::string> there) {
  for (const PaperSegment& segment : paper_segments()) there.push_back(segment.name);
  const auto near = closest_name(selection, there);
  throw UsageError(root + ": has no sequence '" + selection + "'." +
                   (near ? " Did you mean '" + *near + "'?" : "") +
                   " A root holds sequences/NN; known here: " + join(there) + ".");
}

Sequence open_root(Layout::Path path, const SequenceOptions& options, const OpenContext& context) {
  if (is_folder(path)) {
    throw UsageError(path + ": is a root with " + content_text(fs::path(path) / "sequences") +
                     " in sequences/; name one, such as " + path + ":05.");
  }
  if (find_segment(path) != nullptr) {
    throw DataError(path + ": no such folder; the segment of that name is ROOT:" + path +
                    ", with ROOT the folder of SemanticKITTI that holds sequences/.");
  }
  const auto [root, selection] = parts_of_root(path);
  if (!has_folder(fs::path(root) / "sequences")) {
    throw UsageError(root +
                     ": holds no folder sequences/; expected the root of SemanticKITTI, with "
                     "sequences/00 and so on in it.");
  }
  std::vector<std::string> there;
  for (const fs::path& folder : folders_in(fs::path(root) / "sequences")) {
    there.push_back(folder.filename().string());
  }
  if (std::find(there.begin(), there.end(), selection) != there.end()) {
    return open_semantickitti(fs::path(root) / "sequences" / selection, options, context);
  }
  const PaperSegment* segment = find_segment(selection);
  if (segment == nullptr) throw_not_in_root(root, selection, std::move(there));
  const fs::path folder = folder_in_root(path);
  if (is_folder(folder))
    return open_semantickitti(folder, options, context, {selection, segment->frames, {}});
  throw DataError(folder.string() + ": no such folder; segment " + selection +
                  " is part of sequence " + segment->sequence +
                  " of SemanticKITTI, and sequences/ holds " +
                  (there.empty() ? "no folder" : join(there)) + ".");
}

}  // namespace

const std::vector<PaperSegment>& paper_segments() {
  static const std::vector<PaperSegment> segments = {
      {"kitti-00", "00", {4390, 4530, 2}}, {"kitti-01", "01", {150, 250, 1}},
      {"kitti-02", "02", {860, 950, 2}},   {"kitti-05", "05", {2350, 2670, 2}},
      {"kitti-07", "07", {630, 820, 2}},
  };
  return segments;
}

Layout semantickitti_root_layout() {
  Layout layout = semantickitti_layout();
  layout.name = "semantickitti root";
  layout.expected = "a SemanticKITTI root as ROOT:05 or ROOT:kitti-05 (sequences/NN)";
  layout.forms = {{"ROOT:05", "a whole sequence of a SemanticKITTI root folder"}};
  for (const PaperSegment& segment : paper_segments()) {
    layout.forms.emplace_back("ROOT:" + segment.name, "sequence " + segment.sequence + ", frames " +
                                                          frame_range_text(segment.frames) +
                                                          ", as papers compare on");
  }
  layout.recognise = names_root;
  layout.open = open_root;
  layout.folder_of = folder_in_root;
  return layout;
}

}  // namespace raymoval
