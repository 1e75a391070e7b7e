// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/files/replacements.h"

namespace raymoval {

/// What a message is from now on: its new bytes, or nothing if it is left out.
/// @param topic, index as `open_bag` of the same path numbers them
/// @param message the bytes as they were published, unpacked
using ChangeMessage = std::function<std::optional<std::string>(std::size_t topic, std::size_t index,
                                                               const std::string& message)>;

/// What became of a recording.
struct RewrittenBag {
  std::uint64_t messages = 0;  ///< That were read.
  std::uint64_t changed = 0;   ///< Of these, that have other bytes now.
  std::uint64_t left_out = 0;  ///< Of these, that are not in the new recording.
  /// Sentences on what could not be read and is missing, as `Bag::damage`.
  std::vector<std::string> damage;
};

/// Whether a recording can be written as `output`: it has the container of `input` (.bag, .mcap,
/// .db3, a folder, each with the compression of the input) and does not stand where `input` is.
/// @throws UsageError saying what to name instead
void check_rewriting(const std::filesystem::path& input, const std::filesystem::path& output);

/// Copies a recording message by message; `change` is called once for each, one call after another,
/// in the order of the file. Whatever is no message stays as it is: topics, types, times, quality
/// of service, attachments, metadata, compression. Of a damaged recording what can be read is
/// copied. Only a chunk is in memory. The recording appears whole, at the end.
/// @param together gives the recording its name with others, if it is not null
/// @throws UsageError as `check_rewriting`; DataError if `input` cannot be opened or `output`
/// cannot
///   be written; UnreadableError if the disk fails; whatever `change` throws
RewrittenBag rewrite_bag(const std::filesystem::path& input, const std::filesystem::path& output,
                         const ChangeMessage& change, Replacements* together = nullptr);

}  // namespace raymoval
