// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "methods/external/manifest.h"
#include "methods/remover.h"

namespace raymoval {

/// Where a program has to put its answers, below the working folder.
inline constexpr const char* kAnswerFolder = "predictions";

/// Words of an answer, as SemanticKITTI's motion segmentation has them.
inline constexpr std::uint32_t kKeptWord = 9;
inline constexpr std::uint32_t kRemovedWord = 251;

/// "000012.bin"
std::string scan_file_name(std::size_t scan, const char* extension);

/// Writes all that a program gets, in SemanticKITTI layout: velodyne/NNNNNN.bin (x y z reflectance
/// as float32, sensor frame, metres; 0 where the data has no reflectance), poses.txt
/// (T_world_sensor, a row of 12 numbers each, as calib.txt says the identity), times.txt (seconds),
/// sequence.json, sensor.json and parameters.json. Points, names and numbers are those that every
/// method sees: only finite points, nothing of the data set's layout, no label.
/// @return the number of points of each scan
/// @throws MethodError where the manifest's disk limit would be exceeded; DataError if the disk is
/// full; Cancelled
std::vector<std::size_t> write_sequence_files(const std::filesystem::path& folder,
                                              const ScanSource& scans, const Manifest& manifest,
                                              const Configuration& parameters,
                                              const RunContext& context);

/// Reads predictions/NNNNNN.label of every scan: a 32-bit little-endian word per point, 9 = kept,
/// 251 = removed in the lower 16 bits. Gives the masks to `sink`.
/// @throws MethodError naming the file, what is expected and what was found
void read_answers(const std::filesystem::path& folder, const std::vector<std::size_t>& points,
                  RemovalSink& sink, const RunContext& context);

}  // namespace raymoval
