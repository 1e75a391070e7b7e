// SPDX-License-Identifier: MIT
#include "datasets/clouds/numpy/python_value.h"

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

using Kind = PythonValue::Kind;
constexpr int kMostDepth = 16;

void append_utf8(std::string& text, std::uint32_t code) {
  const auto put = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xC0 | (code >> 6));
  } else if (code < 0x10000) {
    put(0xE0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3F));
  } else {
    put(0xF0 | (code >> 18));
    put(0x80 | ((code >> 12) & 0x3F));
    put(0x80 | ((code >> 6) & 0x3F));
  }
  put(0x80 | (code & 0x3F));
}

class PythonParser {
 public:
  PythonParser(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  PythonValue parse() {
    PythonValue value = parse_value(0);
    skip_blanks();
    if (at_ != text_.size()) fail("expected nothing more");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw DataError(where_ + ": the head of the array is damaged at its column " +
                    std::to_string(at_ + 1) + ": " + what + ". Save it again, or copy it again.");
  }
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t')) {
      ++at_;
    }
  }
  bool take(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool take(std::string_view word) {
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  PythonValue parse_value(int depth) {
    if (depth > kMostDepth) fail("values stand too deep in one another");
    if (take('(')) return parse_items(Kind::kTuple, ')', depth);
    if (take('[')) return parse_items(Kind::kList, ']', depth);
    if (take('{')) return parse_items(Kind::kDictionary, '}', depth);
    PythonValue value;
    if (take(std::string_view("True"))) {
      value.kind = Kind::kTrue;
    } else if (take(std::string_view("False"))) {
      value.kind = Kind::kFalse;
    } else if (!take(std::string_view("None"))) {
      // Python 2 wrote u'x' and b'x'.
      if (text_.substr(at_, 2) == "u'" || text_.substr(at_, 2) == "b'") ++at_;
      return take('\'') ? parse_text('\'') : take('"') ? parse_text('"') : parse_number_value();
    }
    return value;
  }

  PythonValue parse_items(Kind kind, char end, int depth) {
    PythonValue value;
    value.kind = kind;
    while (!take(end)) {
      value.items.push_back(parse_value(depth + 1));
      if (kind == Kind::kDictionary) {
        if (!take(':')) fail("expected ':'");
        value.items.push_back(parse_value(depth + 1));
      }
      if (take(',')) continue;
      if (take(end)) break;
      fail("expected ',' or '" + std::string(1, end) + "'");
    }
    // Brackets around a single value are no tuple.
    const bool is_tuple =
        text_.substr(0, at_ - 1).find_last_not_of(' ') != std::string_view::npos &&
        text_[text_.substr(0, at_ - 1).find_last_not_of(' ')] == ',';
    if (kind == Kind::kTuple && value.items.size() == 1 && !is_tuple) {
      return std::move(value.items.front());
    }
    return value;
  }

  PythonValue parse_text(char quote) {
    PythonValue value;
    value.kind = Kind::kText;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == quote) {
        ++at_;
        return value;
      }
      if (c == '\\') {
        parse_escape(value.text);
      } else {
        value.text += c;
      }
    }
    fail("a text does not end");
  }

  /// At a backslash; leaves `at_` at the last letter of the escape.
  void parse_escape(std::string& text) {
    const char c = ++at_ < text_.size() ? text_[at_] : '\0';
    const std::size_t digits = c == 'x' ? 2 : c == 'u' ? 4 : c == 'U' ? 8 : 0;
    if (digits == 0) {
      constexpr std::string_view kNames = "nrt", kLetters = "\n\r\t";
      const std::size_t known = kNames.find(c);
      if (c == '\0') fail("a text does not end");
      text += known == std::string_view::npos ? c : kLetters[known];
      return;
    }
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < digits; ++i) {
      const char digit = ++at_ < text_.size() ? text_[at_] : '\0';
      const std::size_t value = std::string_view("0123456789abcdef").find(digit);
      if (digit == '\0' || value == std::string_view::npos) fail("an escape is no number");
      code = code * 16 + static_cast<std::uint32_t>(value);
    }
    if (code > 0x10FFFF) fail("an escape is no letter");
    append_utf8(text, code);
  }

  PythonValue parse_number_value() {
    PythonValue value;
    value.kind = Kind::kNumber;
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9') ++at_;
    const auto number = parse_number<std::uint64_t>(text_.substr(begin, at_ - begin));
    if (!number) {
      at_ = begin;
      fail("expected a value");
    }
    if (at_ < text_.size() && text_[at_] == 'L') ++at_;  // Python 2's long numbers.
    value.number = *number;
    return value;
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0;
};

}  // namespace

const PythonValue* PythonValue::find(std::string_view name) const {
  for (std::size_t i = 0; kind == Kind::kDictionary && i + 1 < items.size(); i += 2) {
    if (items[i].is(Kind::kText) && items[i].text == name) return &items[i + 1];
  }
  return nullptr;
}

PythonValue parse_python_value(std::string_view text, const std::string& where) {
  return PythonParser(text, where).parse();
}

}  // namespace raymoval
