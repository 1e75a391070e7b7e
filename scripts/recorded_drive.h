// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace raymoval {

/// A drive that is made up: up and down the same 40 m, so that its map does not grow.
struct Drive {
  std::size_t scans = 2000, points = 30000;
};

/// A way to store a drive, as a recording or as files.
struct DriveForm {
  std::string name, file;
  std::function<void(const Drive&, const std::filesystem::path&)> write;
};

/// All of them, folders of files first.
std::vector<DriveForm> drive_forms();

}  // namespace raymoval
