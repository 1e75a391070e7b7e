// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/files/part_name.h"

namespace raymoval {

/// Finished files and folders that get their names together, or none of them, as far as the file
/// system allows that. Replaced files are removed when all new files have their names. If one
/// cannot get its name, the replaced files get theirs back.
class Replacements {
 public:
  Replacements() = default;
  /// Removes the parts that did not get their names.
  ~Replacements();
  Replacements(const Replacements&) = delete;
  Replacements& operator=(const Replacements&) = delete;

  /// @param part all of it is on the disk. It belongs to this object from now on.
  void add(Part part, std::filesystem::path target);

  /// @throws DataError that lists which file could not get its name, and which others were changed
  void commit();

 private:
  /// How a part got its name, which decides how the name is taken back.
  enum class Way { kNone, kNew, kExchanged, kAside };
  struct One {
    Part part;
    std::filesystem::path target;
    std::filesystem::path aside;  ///< Path of the replaced file, if it is not the part's name.
    Way way = Way::kNone;
  };

  static bool give_name(One& one);
  static bool take_back(One& one);
  [[noreturn]] void give_up(const One& failed, int reason);

  std::vector<One> all_;
};

}  // namespace raymoval
