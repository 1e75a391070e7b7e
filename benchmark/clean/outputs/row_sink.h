// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>

#include "benchmark/clean/rows/map_rows.h"
#include "core/files/replacements.h"
#include "datasets/clouds/cloud_file.h"

namespace raymoval {

/// The destination of the rows of a map. Like `CleanOutput`, it is opened at the beginning and
/// renamed at the end.
class RowSink {
 public:
  RowSink() = default;
  virtual ~RowSink() = default;
  RowSink(const RowSink&) = delete;
  RowSink& operator=(const RowSink&) = delete;

  virtual void add(const ScanRows& rows) = 0;
  /// Whether `add` reads `ScanRows::world`, which may be empty otherwise.
  [[nodiscard]] virtual bool needs_world() const { return true; }
  virtual void finish() = 0;
  virtual void commit_with(Replacements& together) = 0;
};

/// Rows in one file, in order of arrival.
class FileSink : public RowSink {
 public:
  /// @throws UsageError, DataError as `PointRecordWriter`
  FileSink(const std::filesystem::path& path, const RecordLayout& layout,
           const RecordWriting& writing)
      : file_(path, writing) {
    file_.start(layout);
  }
  void add(const ScanRows& rows) override { file_.add(rows.rows); }
  [[nodiscard]] bool needs_world() const override { return false; }
  void finish() override { file_.finish(); }
  void commit_with(Replacements& together) override { file_.commit_with(together); }

 private:
  PointRecordWriter file_;
};

}  // namespace raymoval
