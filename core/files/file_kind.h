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

/// What stands at a path, links followed.
enum class FileKind { kAbsent, kFile, kFolder };

/// The system cannot say or give what stands at a path: no rights, or a disk that does not answer.
/// Such a path is neither absent nor damaged, so what may do without an absent or a damaged file
/// must not do without this one.
class UnreadableError : public DataError {
 public:
  using DataError::DataError;
};

/// @param reason the system's error number
[[noreturn]] void throw_cannot_look_at(const std::filesystem::path& path, int reason);

/// Whether the system's error number means that nothing of a name exists.
bool means_absent(int reason);

/// Looks at `path` without opening it. It is absent only if the system says that nothing of this
/// name exists.
/// @throws UnreadableError for a path that cannot be looked at (no rights, a disk that does not
/// answer, links in a circle); DataError for everything else that is no file and no folder: a link
/// that leads nowhere (also one in the middle of the path), a pipe, a socket, a device
FileKind file_kind(const std::filesystem::path& path);

/// @throws DataError as file_kind
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
bool is_there(const std::filesystem::path& path);

/// Whether the file or folder `path` exists, for what may be left out but must be what its name
/// says. @throws DataError as file_kind, and if it is a folder in place of a file or the reverse
bool has_file(const std::filesystem::path& path);
bool has_folder(const std::filesystem::path& path);

/// Bytes of the file `path`. @throws DataError as file_kind, and if it is absent or a folder
std::uintmax_t plain_file_size(const std::filesystem::path& path);

/// Paths of all that stands in `folder`, not below it, in order of name; what an entry is has not
/// been looked at. @throws UnreadableError if the folder cannot be listed to its end
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

/// The folders among them; links to nothing are left out. @throws DataError
std::vector<std::filesystem::path> folders_in(const std::filesystem::path& folder);

/// The folder in which `path` stands. A slash at the end of `path` does not count.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// `path` without a slash at its end, which would follow a link and hide its last name.
std::filesystem::path without_slash(const std::filesystem::path& path);

/// What `read` gives; nothing if what it reads is absent or damaged, so that it must do without.
/// @throws UnreadableError, which says neither
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

/// What tells the file or folder at `path` from all others, whatever its names; nothing if there is
/// none. @throws UnreadableError
std::optional<std::pair<dev_t, ino_t>> identity_of(const std::filesystem::path& path);

}  // namespace raymoval
