// SPDX-License-Identifier: MIT
#include "datasets/bags/rewriting/rewrite_metadata.h"

#include <algorithm>
#include <optional>

#include "datasets/bags/chunks/message_table.h"

namespace raymoval {
namespace {

/// What a part of a text becomes.
struct Edit {
  std::size_t begin = 0, end = 0;
  std::string text;
};

class Edits {
 public:
  explicit Edits(const std::string& text) : text_(text) {}

  void value(const YamlNode* node, std::string text) {
    if (node != nullptr) all_.push_back({node->begin, node->end, std::move(text)});
  }
  /// Takes out a list's item: its lines up to `end`.
  void remove(std::size_t begin, std::size_t end) {
    const std::size_t before = text_.rfind('\n', begin);
    all_.push_back({before == std::string::npos ? 0 : before + 1, end, ""});
  }
  /// Where the line ends that `at` is in.
  [[nodiscard]] std::size_t line_end(std::size_t at) const {
    const std::size_t end = text_.find('\n', at);
    return end == std::string::npos ? text_.size() : end + 1;
  }
  [[nodiscard]] std::string result() {
    std::sort(all_.begin(), all_.end(),
              [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
    std::string result;
    std::size_t at = 0;
    for (const Edit& edit : all_) {
      if (edit.begin < at) continue;  // It is in what was taken out.
      result.append(text_, at, edit.begin - at).append(edit.text);
      at = edit.end;
    }
    return result.append(text_, at);
  }

 private:
  const std::string& text_;
  std::vector<Edit> all_;
};

/// Where all of a value ends.
std::size_t end_of(const YamlNode& node) {
  std::size_t end = node.end;
  for (const YamlNode& child : node.children) end = std::max(end, end_of(child));
  return end;
}

/// Where the first value in it begins.
std::size_t begin_of(const YamlNode& node) {
  std::size_t begin = node.value.empty() && node.children.empty() ? node.begin : SIZE_MAX;
  if (!node.value.empty()) begin = node.begin;
  for (const YamlNode& child : node.children) begin = std::min(begin, begin_of(child));
  return begin;
}

void edit_topics(Edits& edits, const YamlNode& information, const WrittenCounts& counts) {
  const YamlNode* topics = information.find("topics_with_message_count");
  if (topics == nullptr) return;
  for (const YamlNode& topic : topics->children) {
    const YamlNode* about = topic.find("topic_metadata");
    const YamlNode* name = about == nullptr ? nullptr : about->find("name");
    const YamlNode* type = about == nullptr ? nullptr : about->find("type");
    if (name == nullptr || type == nullptr) continue;
    const auto count = counts.topics.find({name->value, ros1_type_name(type->value)});
    edits.value(topic.find("message_count"),
                std::to_string(count == counts.topics.end() ? 0 : count->second));
  }
}

/// When the messages below `node` begin, and how long they take.
void edit_times(Edits& edits, const YamlNode& node, const WrittenMessages& written) {
  const auto edit = [&](const char* name, const char* unit, Nanoseconds value) {
    const YamlNode* time = node.find(name);
    if (time != nullptr) edits.value(time->find(unit), std::to_string(value));
  };
  edit("starting_time", "nanoseconds_since_epoch", written.first);
  edit("duration", "nanoseconds", written.last - written.first);
}

/// Those of all files together.
WrittenMessages all_messages(const WrittenCounts& counts) {
  WrittenMessages all;
  for (const auto& file : counts.files) {
    if (!file || file->count == 0) continue;
    const bool is_first = all.count == 0;
    all.first = is_first ? file->first : std::min(all.first, file->first);
    all.last = is_first ? file->last : std::max(all.last, file->last);
    all.count += file->count;
  }
  return all;
}

}  // namespace

std::string rewritten_metadata(const Ros2Metadata& metadata, const std::string& name,
                               const WrittenCounts& counts) {
  Edits edits(metadata.text);
  std::map<std::string, std::optional<WrittenMessages>> by_name;
  std::map<std::string, std::string> new_names;
  for (std::size_t i = 0; i < metadata.files.size(); ++i) {
    const Ros2File& file = metadata.files[i];
    by_name.emplace(file.listed, counts.files[i]);
    const std::string own = file.path.filename().string();
    // Up to version 3 the folder's name stands before the file's.
    new_names.emplace(file.listed, metadata.version <= 3 ? name + "/" + own : own);
  }
  const WrittenMessages all = all_messages(counts);
  edits.value(metadata.information.find("message_count"), std::to_string(all.count));
  if (metadata.messages && *metadata.messages != all.count) {
    edit_times(edits, metadata.information, all);
  }
  edit_topics(edits, metadata.information, counts);
  const auto edit_file = [&](const YamlNode& item, const YamlNode* path, const YamlNode* count) {
    const auto found = path == nullptr ? by_name.end() : by_name.find(path->value);
    if (found == by_name.end() || !found->second) {
      edits.remove(begin_of(item), edits.line_end(end_of(item)));
      return;
    }
    edits.value(path, new_names.at(path->value));
    if (count != nullptr && count->value != std::to_string(found->second->count)) {
      edits.value(count, std::to_string(found->second->count));
      edit_times(edits, item, *found->second);
    }
    by_name.erase(found);  // It is listed once.
  };
  for (const YamlNode& item : metadata.information.find("relative_file_paths")->children) {
    edit_file(item, &item, nullptr);
  }
  for (std::size_t i = 0; i < metadata.files.size(); ++i) {
    by_name.emplace(metadata.files[i].listed, counts.files[i]);
  }
  if (const YamlNode* files = metadata.information.find("files")) {
    for (const YamlNode& item : files->children) {
      edit_file(item, item.find("path"), item.find("message_count"));
    }
  }
  return edits.result();
}

}  // namespace raymoval
