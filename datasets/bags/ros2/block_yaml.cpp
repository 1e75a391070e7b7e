// SPDX-License-Identifier: MIT
#include "datasets/bags/ros2/block_yaml.h"

#include <optional>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

constexpr int kMostLevels = 32;

/// A line without its indentation and its comment.
struct Line {
  std::size_t indent = 0, begin = 0;
  std::string_view content;
  int number = 0;
};

/// The length of the quoted text that `text` begins with; nothing if it does not end.
std::optional<std::size_t> quoted_length(std::string_view text) {
  const char quote = text.front();
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text[i] == quote) {
      const bool doubled = quote == '\'' && i + 1 < text.size() && text[i + 1] == quote;
      if (!doubled) return i + 1;
      ++i;
    }
  }
  return std::nullopt;
}

bool is_quote(char letter) {
  return letter == '"' || letter == '\'';
}

/// `text` up to a comment, without blanks at its end.
std::string_view without_comment(std::string_view text) {
  std::size_t at = 0;
  if (!text.empty() && is_quote(text.front())) at = quoted_length(text).value_or(text.size());
  for (; at < text.size(); ++at) {
    if (text[at] == '#' && (at == 0 || text[at - 1] == ' ')) break;
  }
  text = text.substr(0, at);
  const std::size_t last = text.find_last_not_of(" \t\r");
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

std::string unquoted(std::string_view text) {
  if (text.size() < 2 || !is_quote(text.front())) return std::string(text);
  const char quote = text.front();
  text = text.substr(1, text.size() - 2);
  std::string value;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escapes = (quote == '"' && text[i] == '\\') || (quote == '\'' && text[i] == quote);
    if (escapes && i + 1 < text.size()) ++i;
    if (escapes && quote == '"' && text[i] == 'n') {
      value += '\n';
    } else if (escapes && quote == '"' && text[i] == 't') {
      value += '\t';
    } else {
      value += text[i];
    }
  }
  return value;
}

/// Where the value of "key: value" begins; nothing if the line has no key.
std::optional<std::size_t> colon_of(std::string_view content) {
  std::size_t at = 0;
  if (!content.empty() && is_quote(content.front())) {
    at = quoted_length(content).value_or(content.size());
  }
  for (; at < content.size(); ++at) {
    if (content[at] == ':' && (at + 1 == content.size() || content[at + 1] == ' ')) return at;
  }
  return std::nullopt;
}

bool is_item(std::string_view content) {
  return content == "-" || content.starts_with("- ");
}

class Parser {
 public:
  Parser(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {
    int number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
      ++number;
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      add_line(text.substr(begin, end - begin), begin, number);
      begin = end + 1;
    }
  }

  YamlNode parse() {
    YamlNode root;
    if (!lines_.empty()) root.children = block(lines_.front().indent, 0);
    if (at_ < lines_.size()) fail(lines_[at_], "stands further left than what is before it");
    return root;
  }

 private:
  void add_line(std::string_view all, std::size_t begin, int number) {
    const std::size_t indent = std::min(all.find_first_not_of(' '), all.size());
    const std::string_view content = without_comment(all.substr(indent));
    if (content.empty() || content.starts_with("---") || content.starts_with("%")) return;
    lines_.push_back({indent, begin + indent, content, number});
  }

  [[noreturn]] void fail(const Line& line, const std::string& problem) const {
    throw DataError(where_ + ":" + std::to_string(line.number) + ": '" +
                    std::string(line.content.substr(0, 60)) + "' " + problem +
                    ". Expected what `ros2 bag record` writes; `ros2 bag reindex` writes it anew.");
  }

  std::vector<YamlNode> block(std::size_t indent, int level) {
    if (level > kMostLevels) fail(lines_[at_], "is more than 32 levels deep");
    std::vector<YamlNode> nodes;
    while (at_ < lines_.size() && lines_[at_].indent == indent) {
      // A list may stand as far left as its key, and ends where the next key begins.
      if (!nodes.empty() && nodes.front().key.empty() != is_item(lines_[at_].content)) break;
      nodes.push_back(is_item(lines_[at_].content) ? item(level) : entry(level));
    }
    if (at_ < lines_.size() && lines_[at_].indent > indent) {
      fail(lines_[at_], "stands further right than what is before it");
    }
    return nodes;
  }

  YamlNode item(int level) {
    Line& line = lines_[at_];
    const std::size_t skip = std::min(line.content.find_first_not_of(' ', 1), line.content.size());
    if (skip == line.content.size()) {
      YamlNode node;
      node.line = line.number;
      const std::size_t indent = line.indent;
      ++at_;
      if (at_ < lines_.size() && lines_[at_].indent > indent) {
        node.children = block(lines_[at_].indent, level + 1);
      }
      return node;
    }
    // What stands behind the dash is a block of its own, as far right as it stands.
    line.indent += skip;
    line.begin += skip;
    line.content = line.content.substr(skip);
    YamlNode node;
    node.line = line.number;
    if (is_item(line.content) || colon_of(line.content)) {
      node.children = block(line.indent, level + 1);
    } else {
      set_value(node, line, 0);
    }
    return node;
  }

  YamlNode entry(int level) {
    const Line line = lines_[at_];
    const auto colon = colon_of(line.content);
    if (!colon || *colon == 0) fail(line, "is no 'key: value'");
    YamlNode node;
    node.key = unquoted(line.content.substr(0, *colon));
    node.line = line.number;
    const std::size_t value = line.content.find_first_not_of(' ', *colon + 1);
    if (value != std::string_view::npos) {
      set_value(node, line, value);
      return node;
    }
    node.begin = node.end = line.begin + line.content.size();
    ++at_;
    if (at_ == lines_.size()) return node;
    const Line& next = lines_[at_];
    if (next.indent > line.indent || (next.indent == line.indent && is_item(next.content))) {
      node.children = block(next.indent, level + 1);
    }
    return node;
  }

  /// Reads the value that stands at `from` in a line, and goes behind it.
  void set_value(YamlNode& node, const Line& line, std::size_t from) {
    const std::size_t indent = line.indent;
    std::string_view value = line.content.substr(from);
    node.begin = line.begin + from;
    node.end = node.begin + value.size();
    ++at_;
    if (value.front() == '|' || value.front() == '>') {
      skip_deeper(indent);
      return;
    }
    if (is_quote(value.front())) {
      const auto length = quoted_length(text_.substr(node.begin));
      if (!length) fail(line, "begins a quoted text that does not end");
      node.end = node.begin + *length;
      value = text_.substr(node.begin, *length);
      while (at_ < lines_.size() && lines_[at_].begin < node.end) ++at_;
    } else if (value.front() == '[' && value.back() == ']') {
      add_list(node, value.substr(1, value.size() - 2));
    } else {
      skip_deeper(indent);  // A plain text may go on there.
    }
    node.value = unquoted(value);
  }

  void skip_deeper(std::size_t indent) {
    while (at_ < lines_.size() && lines_[at_].indent > indent) ++at_;
  }

  static void add_list(YamlNode& node, std::string_view inside) {
    for (std::string_view part : split(inside, ',')) {
      const std::size_t first = part.find_first_not_of(' ');
      if (first == std::string_view::npos) continue;
      part = part.substr(first, part.find_last_not_of(' ') + 1 - first);
      YamlNode child;
      child.line = node.line;
      child.begin = node.begin + static_cast<std::size_t>(part.data() - inside.data()) + 1;
      child.end = child.begin + part.size();
      child.value = unquoted(part);
      node.children.push_back(std::move(child));
    }
  }

  std::string_view text_;
  std::string where_;
  std::vector<Line> lines_;
  std::size_t at_ = 0;
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view wanted) const {
  for (const YamlNode& child : children) {
    if (child.key == wanted) return &child;
  }
  return nullptr;
}

YamlNode parse_block_yaml(std::string_view text, const std::string& where) {
  return Parser(text, where).parse();
}

}  // namespace raymoval
