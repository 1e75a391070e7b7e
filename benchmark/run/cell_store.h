// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/process/method_run.h"
#include "benchmark/run/sequence_bench.h"
#include "benchmark/suite/suite.h"

namespace raymoval {

/// What a run folder holds of a cell.
struct StoredCell {
  enum class State {
    kMissing,  ///< There is none.
    kStale,    ///< It is of other parameters, data, protocols or versions, or it is damaged.
    kFailed,   ///< It is this very cell, and it failed.
    kFresh,    ///< It is this very cell, and whole.
  };
  State state = State::kMissing;
  std::string why;                               ///< A reader's reason to run it; none if fresh.
  std::shared_ptr<nlohmann::ordered_json> cell;  ///< Where it failed or is fresh.
};

/// A further run of a method for its time.
struct StoredRepeat {
  std::string digest;  ///< Of its masks.
  Measurement measured;
};

/// The folder cells/ of a run: what is there, and how it gets there so that whatever is ended at
/// any moment leaves either the old or the new.
class CellStore {
 public:
  explicit CellStore(std::filesystem::path out) : out_(std::move(out)) {}

  [[nodiscard]] std::filesystem::path folder(const std::string& sequence,
                                             const MethodRequest& request) const {
    return folder(sequence, request.name);
  }
  /// @param name of the method in the suite
  [[nodiscard]] std::filesystem::path folder(const std::string& sequence,
                                             const std::string& name) const;
  /// A new name in a cell's folder, where removals are written before `keep`.
  [[nodiscard]] std::filesystem::path new_removals(const std::filesystem::path& folder) const;

  /// @param with_removals kept removals have to be there and to be those of the cell
  [[nodiscard]] StoredCell find(SequenceBench& bench, const MethodRequest& request,
                                bool with_removals) const;
  /// Repeat `number` (2, 3 ...) of the cell with `key`; nothing if it is not there.
  /// @param name of the method in the suite
  [[nodiscard]] std::optional<StoredRepeat> find_repeat(const std::string& sequence,
                                                        const std::string& name, int number,
                                                        const std::string& key) const;

  /// Makes the cell's folder and removes what a killed run left there. @throws DataError
  void prepare(const std::filesystem::path& folder) const;
  /// Puts a cell, and new removals if there are any, in the place of what was there.
  /// @param removals of `new_removals`; empty, or not there: none were kept
  /// @throws DataError if something cannot be written, or would be lost that no run made
  void keep(const std::filesystem::path& folder, const nlohmann::ordered_json& cell,
            const std::filesystem::path& removals = {}) const;
  void keep_repeat(const std::filesystem::path& folder, int number, const std::string& key,
                   const StoredRepeat& repeat) const;

  /// Removes half-written files of killed runs from the cells' folders, by names that only runs
  /// give (see `is_part_name`). Only for who holds the folder's lock.
  void sweep() const;

 private:
  std::filesystem::path out_;
};

/// @throws DataError pointing to --out
void make_folder(const std::filesystem::path& folder);

}  // namespace raymoval
