// SPDX-License-Identifier: MIT
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "datasets/bags/bag.h"
#include "datasets/bags/bag_file.h"
#include "datasets/bags/bag_index.h"

namespace raymoval {

/// A SQLite database for a single user at a time. Errors are DataError for a damaged file and
/// UnreadableError for a disk that fails.
class SqliteDatabase {
 public:
  /// Opens a file to read it, and neither locks nor changes it.
  /// @param is_truncated whether the file has fewer pages than its head states
  SqliteDatabase(const std::filesystem::path& path, bool is_truncated);
  SqliteDatabase(const SqliteDatabase&) = delete;

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void run(const std::string& sql) const;
  /// Limits the steps of the next statements in all. More steps are an error, because a malicious
  /// database could take forever.
  void allow_steps(std::int64_t steps) const { steps_ = steps; }
  /// @param code of SQLite @throws the matching error
  [[noreturn]] void fail(int code) const;

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  std::filesystem::path path_;
  mutable std::int64_t steps_ = 0;  ///< Steps that are left.
  std::unique_ptr<sqlite3, Close> handle_;
};

/// One statement, prepared.
class SqliteStatement {
 public:
  /// @throws DataError, also if there is more than one statement in `sql`
  SqliteStatement(const SqliteDatabase& database, std::string_view sql);
  /// Moves to the next row. @return whether there is one
  bool step();
  [[nodiscard]] std::int64_t number(int column) const {
    return sqlite3_column_int64(handle_.get(), column);
  }
  [[nodiscard]] std::string text(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  const SqliteDatabase& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

/// A recording in a SQLite database of rosbag2 (.db3).
class Db3Bag : public Bag {
 public:
  /// @throws DataError if it is no database, lacks the tables of rosbag2, or has a journal or a
  ///   write-ahead log of unfinished writes beside it; UnreadableError
  explicit Db3Bag(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.path(); }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return table_.topics(); }
  [[nodiscard]] Nanoseconds recorded(std::size_t topic, std::size_t index) const override {
    return table_.at(topic, index).recorded;
  }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;
  [[nodiscard]] std::vector<std::string> damage() const override { return damage_.sentences(); }

 private:
  void check_tables() const;
  void read_topics();
  void read_messages();
  /// "drive_0.db3: message 17", to begin messages.
  [[nodiscard]] std::string place(std::int64_t row) const;
  /// The first `most` bytes in the row of a message, compressed or not. @throws as `message`
  [[nodiscard]] std::string stored(
      std::int64_t row, std::size_t most = std::numeric_limits<std::size_t>::max()) const;

  BagFile file_;  ///< Held open so that the file is not replaced while it is read.
  DamageNotes damage_;
  SqliteDatabase database_;
  std::map<std::int64_t, std::size_t> topics_;
  MessageTable table_;
  mutable std::mutex reading_;
};

}  // namespace raymoval
