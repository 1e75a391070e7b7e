// SPDX-License-Identifier: MIT
#include "core/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/error.h"
#include "core/text.h"

namespace raymoval {
namespace {

std::string system_reason() {
  return std::generic_category().message(errno);
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags, mode_t mode = 0644)
      : value_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] bool valid() const { return value_ >= 0; }
  [[nodiscard]] int get() const { return value_; }
  bool close() {
    const int old = value_;
    value_ = -1;
    return old < 0 || ::close(old) == 0;
  }

 private:
  int value_;
};

template <class Container>
Container read_all(const std::filesystem::path& path) {
  Descriptor file(path, O_RDONLY);
  struct stat status {};
  if (!file.valid() || ::fstat(file.get(), &status) != 0) {
    throw DataError(path.string() + ": cannot be read (" + system_reason() + ").");
  }
  if (S_ISDIR(status.st_mode)) throw DataError(path.string() + ": is a folder, expected a file.");
  Container content(static_cast<std::size_t>(status.st_size), typename Container::value_type{});
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t got = ::read(file.get(), content.data() + done, content.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw DataError(path.string() + ": reading failed (" + system_reason() + ").");
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  content.resize(done);
  return content;
}

[[noreturn]] void throw_write_error(const std::filesystem::path& path) {
  throw DataError(path.string() + ": cannot be written (" + system_reason() +
                  "). Nothing was changed; free space or choose another --out.");
}

void write_all(const Descriptor& file, std::string_view content,
               const std::filesystem::path& path) {
  while (!content.empty()) {
    const ssize_t put = ::write(file.get(), content.data(), content.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_write_error(path);
    content.remove_prefix(static_cast<std::size_t>(put));
  }
}

}  // namespace

std::vector<std::byte> read_bytes(const std::filesystem::path& path) {
  return read_all<std::vector<std::byte>>(path);
}

std::string read_text(const std::filesystem::path& path) {
  auto text = read_all<std::string>(path);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

void write_atomically(const std::filesystem::path& path, std::string_view content) {
  const std::filesystem::path temporary =
      path.string() + "." + std::to_string(::getpid()) + ".part";
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.valid()) throw_write_error(path);
  try {
    write_all(file, content, path);
    if (::fsync(file.get()) != 0 || !file.close()) throw_write_error(path);
    if (::rename(temporary.c_str(), path.c_str()) != 0) throw_write_error(path);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const Descriptor parent(folder, O_RDONLY | O_DIRECTORY);
  if (parent.valid()) ::fsync(parent.get());
}

nlohmann::json read_json(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  try {
    return nlohmann::json::parse(text, nullptr, true, /*ignore_comments=*/true);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t byte = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(byte), '\n');
    const std::size_t line_start = byte == 0 ? 0 : text.rfind('\n', byte - 1) + 1;
    throw ConfigurationError(path.string() + ": line " + std::to_string(line) + ", column " +
                             std::to_string(byte - line_start + 1) +
                             ": not valid JSON (a comma or a quote is missing or surplus there).");
  }
}

void check_keys(const nlohmann::json& json, const std::vector<std::string>& allowed,
                const std::string& where) {
  if (!json.is_object()) {
    throw ConfigurationError(where + ": expected an object { ... } with the keys " + join(allowed) +
                             ".");
  }
  for (const auto& [key, value] : json.items()) {
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
      throw ConfigurationError(where + ": unknown key '" + key + "'." + suggestion(key, allowed));
    }
  }
}

ContentHasher::ContentHasher() : state_(XXH3_createState()) {
  XXH3_128bits_reset(static_cast<XXH3_state_t*>(state_));
}

ContentHasher::~ContentHasher() {
  XXH3_freeState(static_cast<XXH3_state_t*>(state_));
}

void ContentHasher::add(const void* data, std::size_t size) {
  XXH3_128bits_update(static_cast<XXH3_state_t*>(state_), data, size);
}

std::string ContentHasher::digest() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(static_cast<XXH3_state_t*>(state_)));
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string content_hash(std::string_view content) {
  ContentHasher hasher;
  hasher.add(content);
  return hasher.digest();
}

}  // namespace raymoval
