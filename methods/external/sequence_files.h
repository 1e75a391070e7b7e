// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "methods/external/manifest.h"
#include "methods/remover.h"

namespace raymoval::external_method {

/// The folder below the working folder for the program's label files.
inline constexpr const char* kAnswerFolder = "predictions";

/// The label words are those of SemanticKITTI's motion segmentation.
inline constexpr std::uint32_t kKeptWord = 9;
inline constexpr std::uint32_t kRemovedWord = 251;

/// "000012.bin"
std::string scan_file_name(std::size_t scan, const char* extension);

/// Writes the input of a program, in SemanticKITTI layout: velodyne/NNNNNN.bin (x y z reflectance
/// as float32, in the sensor frame, in metres; reflectance is 0 if the data has none), poses.txt (a
/// row with the 12 numbers of T_world_sensor for each scan; calib.txt holds the identity),
/// times.txt (in seconds), sequence.json, sensor.json and parameters.json. The program gets the
/// same data as every method: finite points only, no labels, and no hint at the data set.
/// @return the number of points of each scan
/// @throws MethodError if the files would take more than the manifest's disk limit; DataError if
/// the disk is full; Cancelled
std::vector<std::size_t> write_sequence_files(const std::filesystem::path& folder,
                                              const ScanSource& scans, const Manifest& manifest,
                                              const Configuration& parameters,
                                              const RunContext& context);

/// Reads predictions/NNNNNN.label of every scan, which holds a 32-bit little-endian word for each
/// point. Its lower 16 bits are 9 for a kept and 251 for a removed point. Gives the masks to
/// `sink`.
/// @throws MethodError that names the file, what is expected and what was found
void read_answers(const std::filesystem::path& folder, const std::vector<std::size_t>& points,
                  RemovalSink& sink, const RunContext& context);

}  // namespace raymoval::external_method
