// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace raymoval {

/// A name beside `path` for what takes its place when it is finished, such as
/// `table.md.raymoval-5f0c9a7be1d24836.part`. The digits are random: no other process, on whatever
/// machine and with whatever number, has the same name.
std::filesystem::path new_part_name(const std::filesystem::path& path);

/// Whether the last part of `path` has the form that `new_part_name` gives. Only this program makes
/// such names.
bool is_part_name(const std::filesystem::path& path);

/// "table.md" of table.md.raymoval-5f0c9a7be1d24836.part; empty if it has another form.
std::filesystem::path name_of_part(const std::filesystem::path& path);

}  // namespace raymoval
