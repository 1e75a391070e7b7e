// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"

namespace raymoval::test {

/// Scans with one point at (5, 0, 0) each.
inline void write_scans(const TemporaryFolder& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) folder.write(name, floats({5, 0, 0, 1}));
}

/// The x of the pose of each scan.
inline std::vector<double> xs_of(const Sequence& sequence) {
  std::vector<double> xs;
  for (std::size_t i = 0; i < sequence.scans->size(); ++i) {
    xs.push_back(sequence.scans->pose(i).translation().x());
  }
  return xs;
}

/// The message of the error that opening `path` has to throw.
template <class Wanted = DataError>
std::string open_error(const std::string& path, const SequenceOptions& options = {}) {
  return message_of<Wanted>([&] { open_sequence(path, options); });
}

}  // namespace raymoval::test
