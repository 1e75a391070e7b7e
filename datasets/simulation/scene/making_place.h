// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "core/files/part_name.h"

namespace raymoval::simulated {

/// A new folder beside a target, in which that target is made before it gets its name. Its name is
/// nobody else's (see `new_part_folder`), on whatever machine, and it goes with this object. It is
/// locked, so that others can tell what a killed process left from what is still being made.
class MakingPlace {
 public:
  /// @throws DataError if it cannot be made
  explicit MakingPlace(std::filesystem::path target);
  ~MakingPlace();
  MakingPlace(const MakingPlace&) = delete;
  MakingPlace& operator=(const MakingPlace&) = delete;

  /// The folder to be filled; empty at first.
  [[nodiscard]] std::filesystem::path folder() const { return part_.place / "made"; }

  /// Gives `folder()` the target's name, on the disk too.
  /// @return false if something that is no empty folder has that name
  /// @throws DataError if it cannot be done for another reason
  bool take_place();

  /// The same in place of what has that name, which goes with this object.
  /// @return false if another process put something there meanwhile
  /// @throws DataError if it cannot be done for another reason
  bool replace_target();

 private:
  std::filesystem::path target_;
  Part part_;
};

/// Removes from `parent` what killed processes left of a MakingPlace, see `remove_abandoned_part`.
void sweep_making_places(const std::filesystem::path& parent);

}  // namespace raymoval::simulated
