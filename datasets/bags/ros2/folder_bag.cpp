// SPDX-License-Identifier: MIT
#include "datasets/bags/ros2/folder_bag.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// A message's place is the number of its part, and its own in its topic there.
constexpr unsigned kIndexBits = 44;
constexpr std::size_t kMostParts = std::size_t{1} << (63 - kIndexBits);

std::uint64_t place_of(std::size_t part, std::size_t index) {
  return std::uint64_t{part} << kIndexBits | index;
}

}  // namespace

Ros2FolderBag::Ros2FolderBag(std::filesystem::path folder, const Open& open)
    : folder_(std::move(folder)), metadata_(read_ros2_metadata(folder_)) {
  for (const std::string& listed : metadata_.twice) {
    damage_.add(metadata_.path.string() + ": lists " + listed + " twice; it is read once.");
  }
  if (metadata_.files.size() > kMostParts) {
    throw DataError(metadata_.path.string() + ": lists more files than a recording can have.");
  }
  for (std::size_t file = 0; file < metadata_.files.size(); ++file) add_part(file, open);
  if (parts_.empty()) {
    throw DataError(metadata_.path.string() + ": none of the files that it lists can be read. " +
                    join(damage_.sentences(), " "));
  }
  table_.finish();
  check_counts();
}

void Ros2FolderBag::add_part(std::size_t file, const Open& open) {
  const Ros2File& listed = metadata_.files[file];
  if (!listed.is_there) {
    damage_.add(metadata_.path.string() + ": lists " + listed.listed +
                ", which is not there; its messages are missing. Copy it to the folder.");
    return;
  }
  Part part{file, nullptr, {}};
  try {
    part.bag = open(listed.path);
  } catch (const UnreadableError&) {
    throw;
  } catch (const DataError& error) {
    damage_.add(error.what());
    return;
  }
  for (std::size_t own = 0; own < part.bag->topics().size(); ++own) {
    const BagTopic& topic = part.bag->topics()[own];
    part.topics.push_back(table_.topic(topic.name, topic.type, topic.encoding));
  }
  for (std::size_t own = 0; own < part.bag->topics().size(); ++own) {
    const std::uint64_t count = part.bag->topics()[own].messages;
    for (std::size_t i = 0; i < count; ++i) {
      table_.add(part.topics[own], {part.bag->recorded(own, i), place_of(parts_.size(), i)});
    }
  }
  parts_.push_back(std::move(part));
}

void Ros2FolderBag::check_counts() {
  const auto note = [&](const std::string& what, std::uint64_t said, std::uint64_t found) {
    damage_.add(metadata_.path.string() + ": says that " + what + " has " +
                counted_text(said, "message") + ", but " + grouped_text(found) + " can be read.");
  };
  for (const Part& part : parts_) {
    const Ros2File& file = metadata_.files[part.file];
    std::uint64_t found = 0;
    for (const BagTopic& topic : part.bag->topics()) found += topic.messages;
    if (file.messages && *file.messages != found) note(file.listed, *file.messages, found);
  }
  if (metadata_.messages && *metadata_.messages != table_.size()) {
    note("the recording", *metadata_.messages, table_.size());
  }
}

Ros2FolderBag::Found Ros2FolderBag::find(std::size_t topic, std::size_t index) const {
  const std::uint64_t place = table_.at(topic, index).place;
  const Part& part = parts_.at(place >> kIndexBits);
  const std::size_t own_index = place & ((std::uint64_t{1} << kIndexBits) - 1);
  const Nanoseconds stamp = table_.at(topic, index).recorded;
  // Two topics of a part are never one here: their names, types or encodings differ.
  for (std::size_t own = 0; own < part.topics.size(); ++own) {
    if (part.topics[own] != topic) continue;
    if (part.bag->recorded(own, own_index) == stamp) return {*part.bag, own, own_index};
  }
  throw InternalError("a message of a recording in a folder is in none of its files");
}

std::string Ros2FolderBag::message(std::size_t topic, std::size_t index) const {
  const Found found = find(topic, index);
  return found.bag.message(found.topic, found.index);
}

std::string Ros2FolderBag::message_head(std::size_t topic, std::size_t index,
                                        std::size_t most) const {
  const Found found = find(topic, index);
  return found.bag.message_head(found.topic, found.index, most);
}

std::size_t Ros2FolderBag::index_of(std::size_t part, std::size_t topic, std::size_t index) const {
  const Part& in = parts_.at(part);
  const auto found =
      table_.index_of(in.topics.at(topic), {in.bag->recorded(topic, index), place_of(part, index)});
  if (!found) throw InternalError("a message of a file is not in the recording that it belongs to");
  return *found;
}

std::vector<std::string> Ros2FolderBag::damage() const {
  DamageNotes all;
  for (const std::string& sentence : damage_.sentences()) all.add(sentence);
  for (const Part& part : parts_) {
    for (const std::string& sentence : part.bag->damage()) all.add(sentence);
  }
  return all.sentences();
}

}  // namespace raymoval
