// SPDX-License-Identifier: MIT
#include "datasets/clouds/numpy/npy_type.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {
namespace {

using Kind = PythonValue::Kind;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw DataError(where + ": " + what +
                  "; expected numbers of 1, 2, 4 or 8 bytes, or fields of such. Save the array "
                  "with another type.");
}

/// The number type of "<f4" without its byte order. Nothing if it is not read. A count of 0: no
/// bytes at all.
std::optional<PointField> number_type(std::string_view text) {
  if (text.size() < 2) return std::nullopt;
  const char kind = text[0];
  const auto size = parse_number<int>(text.substr(1, text.find('[') - 1));
  if (!size || *size < 0) return std::nullopt;
  PointField field;
  const auto is = [&](char type, int bytes, int count) {
    field.type = type;
    field.size = bytes;
    field.count = count;
    return field;
  };
  const bool whole_size = *size == 1 || *size == 2 || *size == 4 || *size == 8;
  if (kind == 'f' && (*size == 4 || *size == 8)) return is('F', *size, 1);
  if (kind == 'i' && whole_size) return is('I', *size, 1);
  if (kind == 'u' && whole_size) return is('U', *size, 1);
  if (kind == 'b' && *size == 1) return is('U', 1, 1);
  if ((kind == 'M' || kind == 'm') && *size == 8) return is('I', 8, 1);
  if (kind == 'c' && (*size == 8 || *size == 16)) return is('F', *size / 2, 2);
  if (*size > kLargestCount) return std::nullopt;
  if (kind == 'S' || kind == 'a' || kind == 'V') return is('U', 1, *size);
  if (kind == 'U') return is('U', 4, *size);
  return std::nullopt;
}

class TypeReader {
 public:
  explicit TypeReader(const std::string& where) : where_(where) {}

  NpyType read(const PythonValue& descr) {
    type_.structured = descr.is(Kind::kList);
    add(descr, "", 1);
    return std::move(type_);
  }

 private:
  void add(const PythonValue& descr, const std::string& name, std::uint64_t count) {
    if (descr.is(Kind::kText)) return add_number(descr.text, name, count);
    if (!descr.is(Kind::kList)) fail(where_, "the type of the array is no type");
    if (count != 1) fail(where_, "the field '" + name + "' repeats a group of fields");
    for (const PythonValue& item : descr.items) add_field(item, name);
  }

  void add_field(const PythonValue& item, const std::string& outer) {
    if (!item.is(Kind::kTuple) || item.items.size() < 2 || item.items.size() > 3) {
      fail(where_, "a field of the array is no (name, type)");
    }
    const PythonValue& named = item.items[0];
    // A field with a title has (title, name).
    const bool titled = named.is(Kind::kTuple) && named.items.size() == 2;
    const PythonValue& name = titled ? named.items[1] : named;
    if (!name.is(Kind::kText)) fail(where_, "the name of a field is no text");
    const bool filler = name.text.empty();
    if (filler && !item.items[1].is(Kind::kText)) fail(where_, "a field has no name");
    const std::uint64_t count = item.items.size() == 3 ? shape_count(item.items[2]) : 1;
    add(item.items[1], filler || outer.empty() ? name.text : outer + "." + name.text, count);
  }

  std::uint64_t shape_count(const PythonValue& shape) const {
    std::uint64_t count = 1;
    const auto times = [&](const PythonValue& length) {
      if (!length.is(Kind::kNumber) || length.number > kLargestCount) {
        fail(where_, "a field has more than 65,536 values");
      }
      count *= length.number;
      if (count > kLargestCount) fail(where_, "a field has more than 65,536 values");
    };
    if (!shape.is(Kind::kTuple)) {
      times(shape);
    } else {
      for (const PythonValue& length : shape.items) times(length);
    }
    return count;
  }

  void add_number(const std::string& text, const std::string& name, std::uint64_t count) {
    const bool has_order =
        !text.empty() && std::string_view("<>|=").find(text[0]) != std::string_view::npos;
    const auto number = number_type(std::string_view(text).substr(has_order ? 1 : 0));
    if (!number) {
      fail(where_, (name.empty() ? "the type" : "the field '" + name + "' has the type") + " '" +
                       text.substr(0, 40) + "', which is not read" +
                       (text.ends_with('O') ? ": objects of Python" : ""));
    }
    PointField field = *number;
    const std::uint64_t values = static_cast<std::uint64_t>(field.count) * count;
    if (values > kLargestCount) fail(where_, "a field has more than 65,536 values");
    field.name = name;
    field.count = static_cast<int>(values);
    field.offset = type_.bytes;
    type_.bytes += field.bytes();
    if (type_.bytes > kLargestRow) fail(where_, "an item has more than 1 MiB");
    // Bytes without a name are padding, and a text may have no letter.
    if (values > 0 && !(name.empty() && type_.structured)) {
      type_.fields.push_back({field, text[0] == '>' && field.size > 1});
    }
  }

  const std::string& where_;
  NpyType type_;
};

std::string type_text(const PointField& field) {
  return (field.size == 1 ? "'|" : "'<") +
         std::string(1, static_cast<char>(field.type - 'A' + 'a')) + std::to_string(field.size) +
         "'";
}

std::string quoted(const std::string& name) {
  std::string text = "'";
  for (const char c : name) {
    if (c == '\'' || c == '\\') text += '\\';
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') {
      char escape[5];
      (void)std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned>(c) & 0xFFU);
      text += escape;
    } else {
      text += c;
    }
  }
  return text + "'";
}

}  // namespace

NpyType npy_type(const PythonValue& descr, const std::string& where) {
  return TypeReader(where).read(descr);
}

bool is_plain_array(const RecordLayout& layout) {
  if (!layout.unnamed || layout.fields.empty()) return false;
  std::size_t at = 0;
  for (const PointField& field : layout.fields) {
    const PointField& first = layout.fields.front();
    if (field.type != first.type || field.size != first.size || field.offset != at) return false;
    at += field.bytes();
  }
  return at == layout.row_bytes;
}

std::string npy_descr(const RecordLayout& layout, const std::vector<std::string>& names) {
  if (is_plain_array(layout)) return type_text(layout.fields.front());
  std::string text = "[";
  std::size_t at = 0;
  const auto fill = [&](std::size_t end) {
    if (end > at) text += "('', '|V" + std::to_string(end - at) + "'), ";
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PointField& field = layout.fields[i];
    fill(field.offset);
    text += "(" + quoted(names[i]) + ", " + type_text(field) +
            (field.count == 1 ? "" : ", (" + std::to_string(field.count) + ",)") + "), ";
    at = field.offset + field.bytes();
  }
  fill(layout.row_bytes);
  return text.substr(0, text.size() - 2) + "]";
}

}  // namespace raymoval
