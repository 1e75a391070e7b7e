// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <vector>

#include "core/files/descriptor.h"

namespace raymoval {

/// A name beside `path` for the unfinished file that will replace it, such as
/// `table.md.raymoval-1be0a73c5f0c9a7be1d24836.part`. The first 8 digits identify the running
/// kernel, the other 16 are random. So no other process on any machine has the same name, and the
/// name cannot be guessed.
std::filesystem::path new_part_name(const std::filesystem::path& path);

/// Whether the last part of `path` has the form that `new_part_name` gives. Only this program makes
/// such names.
bool is_part_name(const std::filesystem::path& path);

/// "table.md" of table.md.raymoval-1be0a73c5f0c9a7be1d24836.part; empty if it has another form.
std::filesystem::path name_of_part(const std::filesystem::path& path);

/// The parts of `target` that are beside it now; none if its folder cannot be listed.
std::vector<std::filesystem::path> parts_of(const std::filesystem::path& target);

/// A new file or folder under a part name. It is locked as long as `held` lives. So other processes
/// can distinguish a part that is being written from a part of a dead process (see
/// `take_abandoned_part`).
struct Part {
  std::filesystem::path place = {};
  Descriptor held =
      Descriptor();  ///< Not valid if it could not be made; then errno has the reason.
};

/// Makes an empty file for reading and writing. The first call for a folder also removes parts of
/// the same target that dead processes of this user left. No existing file is opened, and no link
/// is followed.
/// @param mode the rights of the file, of which the process's umask takes away
Part new_part_file(const std::filesystem::path& target, mode_t mode);

/// Makes an empty folder in the same way.
/// @param mode as above
Part new_part_folder(const std::filesystem::path& target, mode_t mode = 0777);

/// Takes the lock of a file or folder under a part name if the process that made it has certainly
/// ended: it ran under this very system kernel, whose locks can be trusted, and its lock is free.
/// Parts of another machine, or of an earlier start of this machine, stay.
/// @return the lock, so that no other process takes it meanwhile; not valid if it is in use, is no
/// part, or its state is unknown
Descriptor take_abandoned_part(const std::filesystem::path& part);

/// Removes a file or folder under a part name if `take_abandoned_part` can take it and it is this
/// user's. It never throws.
void remove_abandoned_part(const std::filesystem::path& part);

}  // namespace raymoval
