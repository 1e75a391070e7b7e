// SPDX-License-Identifier: MIT
#include "datasets/bags/rewriting/rewrite_bag.h"

#include <fcntl.h>

#include <cerrno>
#include <system_error>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/file_writer.h"
#include "core/files/files.h"
#include "core/files/same_file.h"
#include "core/files/scratch_folder.h"
#include "datasets/bags/chunks/pack.h"
#include "datasets/bags/chunks/temporary_copy.h"
#include "datasets/bags/open_bag.h"
#include "datasets/bags/rewriting/rewrite_file.h"
#include "datasets/bags/rewriting/rewrite_metadata.h"
#include "datasets/bags/ros2/folder_bag.h"
#include "datasets/bags/ros2/packed_bag.h"

namespace raymoval {
namespace {

namespace fs = std::filesystem;

/// The ending that a file's name must have.
std::string ending_of(const fs::path& input) {
  switch (container_of(input)) {
    case BagContainer::kRos1:
      return ".bag";
    case BagContainer::kMcap:
      return ".mcap";
    case BagContainer::kDb3:
      return ".db3";
    case BagContainer::kZstd:
      break;
  }
  return without_zstd_ending(input.filename()).extension().string() + input.extension().string();
}

void write_db3(const Db3Bag& bag, const fs::path& output, const ChangeMessage& change,
               Replacements& together) {
  Part part = new_part_file(output, 0666);
  if (!part.held.valid()) {
    throw DataError(output.string() + ": cannot be written (" +
                    std::generic_category().message(errno) + ").");
  }
  const fs::path place = part.place;
  const int file = part.held.get();
  try {
    rewrite_db3(bag, place, change);
  } catch (...) {
    ::unlink(place.c_str());
    throw;
  }
  const bool is_on_disk = ::fsync(file) == 0;
  const int reason = errno;
  together.add(std::move(part), output);
  if (is_on_disk) return;
  throw DataError(output.string() + ": cannot be written (" +
                  std::generic_category().message(reason) + "). Free space.");
}

void write_packed(const PackedBag& bag, const fs::path& output, const ChangeMessage& change,
                  Replacements& together) {
  const ScratchFolder folder(kRecordingFolder);
  const fs::path plain = folder.path() / without_zstd_ending(output.filename());
  Replacements inside;
  rewrite_file(bag.inside(), plain, change, inside);
  inside.commit();
  FileWriter writer(output);
  pack_zstd_file(plain, writer);
  writer.commit_with(together);
}

/// The counts of a folder's recording, and its messages by number there.
class FolderRewriting {
 public:
  FolderRewriting(const Ros2FolderBag& bag, const ChangeMessage& change)
      : bag_(bag), change_(change) {
    counts_.files.resize(bag.metadata().files.size());
  }

  void write(const fs::path& output, Replacements& together) {
    Part part = new_part_folder(output);
    if (!part.held.valid()) {
      throw DataError(output.string() + ": cannot be made (" +
                      std::generic_category().message(errno) + ").");
    }
    const fs::path place = part.place;
    try {
      for (std::size_t i = 0; i < bag_.parts().size(); ++i) write_part(i, place);
      write_atomically(place / "metadata.yaml",
                       rewritten_metadata(bag_.metadata(), output.filename().string(), counts_));
    } catch (...) {
      std::error_code ignored;
      fs::remove_all(place, ignored);
      throw;
    }
    together.add(std::move(part), output);
  }

 private:
  void write_part(std::size_t number, const fs::path& folder) {
    const Ros2FolderBag::Part& part = bag_.parts()[number];
    WrittenMessages& written = counts_.files[part.file].emplace();
    const ChangeMessage change = [&](std::size_t own, std::size_t index, const std::string& bytes) {
      const std::size_t topic = part.topics.at(own);
      auto changed = change_(topic, bag_.index_of(number, own, index), bytes);
      if (changed) {
        written.add(part.bag->recorded(own, index));
        ++counts_.topics[{bag_.topics()[topic].name, bag_.topics()[topic].type}];
      }
      return changed;
    };
    Replacements together;
    rewrite_file(*part.bag, folder / bag_.metadata().files[part.file].path.filename(), change,
                 together);
    together.commit();
  }

  const Ros2FolderBag& bag_;
  const ChangeMessage& change_;
  WrittenCounts counts_;
};

}  // namespace

void rewrite_file(const Bag& bag, const fs::path& output, const ChangeMessage& change,
                  Replacements& together) {
  if (const auto* packed = dynamic_cast<const PackedBag*>(&bag)) {
    write_packed(*packed, output, change, together);
    return;
  }
  if (const auto* db3 = dynamic_cast<const Db3Bag*>(&bag)) {
    write_db3(*db3, output, change, together);
    return;
  }
  FileWriter writer(output);
  if (const auto* mcap = dynamic_cast<const McapBag*>(&bag)) {
    rewrite_mcap(*mcap, writer, change);
  } else if (const auto* ros1 = dynamic_cast<const Ros1Bag*>(&bag)) {
    rewrite_ros1(*ros1, writer, change);
  } else {
    throw InternalError("a kind of recording is read and not written");
  }
  writer.commit_with(together);
}

void check_rewriting(const fs::path& input, const fs::path& output) {
  if (is_same_file(input, output)) {
    throw UsageError(output.string() + ": is the recording that is read. Name another.");
  }
  if (is_folder(input)) {
    const fs::path target = without_slash(output);
    if (!is_there(target) || (is_folder(target) && entries_of(target).empty())) return;
    throw UsageError(output.string() +
                     ": is there already. A recording in a folder is written to a new one; name "
                     "that, or move this away.");
  }
  const std::string ending = ending_of(input);
  if (output.filename().string().ends_with(ending)) return;
  throw UsageError(output.string() + ": the recording " + input.filename().string() +
                   " can be written to a file whose name ends in " + ending +
                   ". Name such a file.");
}

RewrittenBag rewrite_bag(const fs::path& input, const fs::path& output, const ChangeMessage& change,
                         Replacements* together) {
  check_rewriting(input, output);
  const std::unique_ptr<Bag> bag = open_bag(input);
  RewrittenBag result;
  const ChangeMessage counted = [&](std::size_t topic, std::size_t index,
                                    const std::string& message) {
    auto changed = change(topic, index, message);
    ++result.messages;
    result.left_out += changed ? 0 : 1;
    result.changed += changed && *changed != message ? 1 : 0;
    return changed;
  };
  Replacements alone;
  Replacements& group = together == nullptr ? alone : *together;
  const fs::path target = without_slash(output);
  if (const auto* folder = dynamic_cast<const Ros2FolderBag*>(bag.get())) {
    FolderRewriting(*folder, counted).write(target, group);
  } else {
    rewrite_file(*bag, output_target(target), counted, group);
  }
  alone.commit();
  result.damage = bag->damage();
  return result;
}

}  // namespace raymoval
