// SPDX-License-Identifier: MIT
#include "datasets/clouds/numpy/npy_head.h"

#include <yaml-cpp/yaml.h>

#include <cctype>
#include <cstring>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "datasets/clouds/format/cloud_header.h"

namespace raymoval {
namespace {

/// The text of the head, and the bytes behind it.
std::pair<std::string_view, std::string_view> head_and_body(const CloudBytes& file) {
  const std::string where = file.path.string();
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (!file.text.starts_with(kMagic) || file.text.size() < 12) {
    throw DataError(where + ": is not a .npy file: it does not begin with \\x93NUMPY and a head.");
  }
  const int version = static_cast<unsigned char>(file.text[6]);
  if (version < 1 || version > 3) {
    throw DataError(where + ": version " + std::to_string(version) +
                    " of .npy is not known; expected 1, 2 or 3.");
  }
  const std::size_t bytes = version == 1 ? 2 : 4;
  std::uint32_t length = 0;
  std::memcpy(&length, file.text.data() + 8, bytes);
  if (length > file.text.size() - 8 - bytes) {
    throw DataError(where + ": its head has " + grouped_text(length) + " bytes, but only " +
                    grouped_text(file.text.size() - 8 - bytes) +
                    " follow; the file looks truncated." + kRereadRemedy);
  }
  return {file.text.substr(8 + bytes, length), file.text.substr(8 + bytes + length)};
}

/// A Python literal as YAML: brackets for tuples, and texts between double quotes, whose escapes
/// both languages write alike.
/// @throws DataError for a character that no head of an array has
std::string yaml_of(std::string_view python, const std::string& where) {
  constexpr std::string_view kKnown = " \n\t,:{}[]";
  std::string yaml;
  for (std::size_t at = 0; at < python.size(); ++at) {
    const char c = python[at];
    if (c == '(' || c == ')') {
      yaml += c == '(' ? '[' : ']';
    } else if (c == '\'' || c == '"') {
      yaml += '"';
      for (++at; at < python.size() && python[at] != c; ++at) {
        const bool escapes = python[at] == '\\' && at + 1 < python.size();
        if (escapes && python[at + 1] == '\'') ++at;  // YAML escapes no apostrophe.
        if (!escapes && python[at] == '"') yaml += '\\';
        yaml += python[at];
        if (escapes && python[at] == '\\') yaml += python[++at];
      }
      yaml += '"';
    } else if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      // Python 2 wrote u'x', b'x' and 10L.
      const bool quoted =
          (c == 'u' || c == 'b') && at + 1 < python.size() && python[at + 1] == '\'';
      if (!quoted && c != 'L') yaml += c;
    } else if (kKnown.find(c) != std::string_view::npos) {
      yaml += c;
    } else {
      throw DataError(where + ": the head of the array is damaged at its column " +
                      std::to_string(at + 1) + ". Save it again, or copy it again.");
    }
  }
  return yaml;
}

/// A whole number from 0 on; empty for another value.
std::optional<std::uint64_t> length_in(const YAML::Node& node) {
  return node.IsScalar() ? parse_number<std::uint64_t>(node.Scalar()) : std::nullopt;
}

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw DataError(where + ": " + what +
                  "; expected numbers of 1, 2, 4 or 8 bytes, or fields of such. Save the array "
                  "with another type.");
}

/// The number type of "<f4" without its byte order. Empty if it is not supported. A count of 0
/// means no bytes.
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

/// Reads "descr" of the head. Fields within fields are named "outer.inner"; texts and complex
/// numbers are fields of several values; times are whole numbers.
class TypeReader {
 public:
  explicit TypeReader(const std::string& where) : where_(where) {}

  /// @throws DataError naming a type that is not supported, such as Python objects, which only
  ///   running code could read
  NpyType read(const YAML::Node& descr) {
    type_.structured = descr.IsSequence();
    add(descr, "", 1);
    return std::move(type_);
  }

 private:
  void add(const YAML::Node& descr, const std::string& name, std::uint64_t count) {
    if (descr.IsScalar()) return add_number(descr.Scalar(), name, count);
    if (!descr.IsSequence()) fail(where_, "the type of the array is not a type");
    if (count != 1) fail(where_, "the field '" + name + "' repeats a group of fields");
    for (const YAML::Node& item : descr) add_field(item, name);
  }

  void add_field(const YAML::Node& item, const std::string& outer) {
    if (!item.IsSequence() || item.size() < 2 || item.size() > 3) {
      fail(where_, "a field of the array is no (name, type)");
    }
    const YAML::Node named = item[0];
    // A field with a title has (title, name).
    const YAML::Node name = named.IsSequence() && named.size() == 2 ? named[1] : named;
    if (!name.IsScalar()) fail(where_, "the name of a field is not a text");
    const bool filler = name.Scalar().empty();
    if (filler && !item[1].IsScalar()) fail(where_, "a field has no name");
    const std::uint64_t count = item.size() == 3 ? shape_count(item[2]) : 1;
    add(item[1], filler || outer.empty() ? name.Scalar() : outer + "." + name.Scalar(), count);
  }

  std::uint64_t shape_count(const YAML::Node& shape) const {
    std::uint64_t count = 1;
    const auto times = [&](const YAML::Node& node) {
      const auto length = length_in(node);
      if (!length || *length > kLargestCount) fail(where_, "a field has more than 65,536 values");
      count *= *length;
      if (count > kLargestCount) fail(where_, "a field has more than 65,536 values");
    };
    if (!shape.IsSequence()) times(shape);
    for (const YAML::Node& length : shape) times(length);
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

NpyHead parsed_head(const CloudBytes& file, const std::string& where) {
  const auto [text, body] = head_and_body(file);
  const YAML::Node head = YAML::Load(yaml_of(text, where));
  const bool whole = head.IsMap() && head["descr"] && head["fortran_order"] && head["shape"];
  if (!whole || !head["shape"].IsSequence()) {
    throw DataError(where + ": the head of the array lacks 'descr', 'fortran_order' or 'shape'.");
  }
  const bool by_columns =
      head["fortran_order"].IsScalar() && head["fortran_order"].Scalar() == "True";
  NpyHead result{TypeReader(where).read(head["descr"]), by_columns, {}, body};
  for (const YAML::Node& node : head["shape"]) {
    const auto length = length_in(node);
    if (!length || *length > kMostCloudPoints) {
      throw DataError(where + ": the shape of the array has a length that is not a count.");
    }
    result.shape.push_back(*length);
  }
  return result;
}

}  // namespace

std::string NpyHead::shape_text() const {
  std::vector<std::string> lengths;
  for (const std::uint64_t length : shape) lengths.push_back(grouped_text(length));
  return lengths.empty() ? "a single value" : join(lengths, " x ");
}

NpyHead npy_head(const CloudBytes& file) {
  const std::string where = file.path.string();
  try {
    return parsed_head(file, where);
  } catch (const YAML::Exception& error) {
    throw DataError(where + ": the head of the array is damaged at its column " +
                    std::to_string(error.mark.column + 1) + ": " + error.msg +
                    ". Save it again, or copy it again.");
  }
}

}  // namespace raymoval
