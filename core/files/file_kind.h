// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"

namespace raymoval {

/// The kind of entry at a path. Links are followed.
enum class FileKind { kAbsent, kFile, kFolder };

/// The system cannot read a path: no rights, or a disk that does not respond. The path is neither
/// absent nor damaged, so code that continues without an absent or damaged file must not continue
/// here.
class UnreadableError : public DataError {
 public:
  using DataError::DataError;
};

/// @param reason the system's error number
[[noreturn]] void throw_inaccessible(const std::filesystem::path& path, int reason);

/// Whether the system's error number means that nothing of a name exists.
bool means_absent(int reason);

/// The kind of `path`, found without opening it. A path is absent only if the system reports that
/// this name does not exist.
/// @throws UnreadableError for a path that cannot be examined (no rights, a disk that does not
/// respond, links in a circle); DataError for everything else that is no file and no folder: a link
/// that leads nowhere (also one in the middle of the path), a pipe, a socket, a device
FileKind file_kind(const std::filesystem::path& path);

/// @throws DataError as file_kind
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
bool is_there(const std::filesystem::path& path);

/// Whether the optional file or folder `path` exists. @throws DataError as file_kind, and if it is
/// a folder in place of a file or the reverse
bool has_file(const std::filesystem::path& path);
bool has_folder(const std::filesystem::path& path);

/// Bytes of the file `path`. @throws DataError as file_kind, and if it is absent or a folder
std::uintmax_t plain_file_size(const std::filesystem::path& path);

/// Paths of all entries in `folder`, not below it, in order of name. The kinds of the entries are
/// not examined. @throws UnreadableError if the folder cannot be listed to its end
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

/// The folders among them; links to nothing are left out. @throws DataError
std::vector<std::filesystem::path> folders_in(const std::filesystem::path& folder);

/// The folder that contains `path`. A slash at the end of `path` is ignored.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// `path` without a slash at its end, which would follow a link and hide its last name.
std::filesystem::path without_slash(const std::filesystem::path& path);

/// The result of `read`; empty if the file is absent or damaged.
/// @throws UnreadableError, which means neither
template <class Read>
std::optional<std::invoke_result_t<Read>> if_whole(Read&& read) {
  try {
    return read();
  } catch (const UnreadableError&) {
    throw;
  } catch (const DataError&) {
    return std::nullopt;
  }
}

/// Removes a file or an empty folder, links not followed, if there is one. @throws DataError if it
/// stays
void remove_if_there(const std::filesystem::path& path);

/// Whether `path` is a link. @throws UnreadableError
bool is_link(const std::filesystem::path& path);

/// The identity of the file or folder at `path`, the same for all of its names; nothing if there is
/// none. @throws UnreadableError
std::optional<std::pair<dev_t, ino_t>> identity_of(const std::filesystem::path& path);

}  // namespace raymoval
