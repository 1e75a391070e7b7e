// SPDX-License-Identifier: MIT
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace raymoval {

/// A database of SQLite, which nothing else uses at the same time. Errors are DataError for what is
/// wrong in the file, and UnreadableError for a disk that fails.
class SqliteDatabase {
 public:
  /// Opens a file to read it, and neither locks nor changes it.
  /// @param is_cut whether the file has fewer pages than it says, so that some cannot be read
  static SqliteDatabase to_read(const std::filesystem::path& path, bool is_cut);
  /// Opens an empty file to write it. Nothing but the file itself is written. The SQL that it runs
  /// may make tables and indexes and fill them, and nothing else.
  static SqliteDatabase to_write(const std::filesystem::path& path);

  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void run(const std::string& sql) const;
  /// How many steps the next statements may take in all; what takes more is an error, for a
  /// database can be built so that it never ends.
  void allow_steps(std::int64_t steps) const { *steps_ = steps; }
  /// @param code the library's. @throws what it stands for
  [[noreturn]] void fail(int code) const;

 private:
  SqliteDatabase(std::filesystem::path path, const std::string& uri, int flags);
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::int64_t> steps_;  ///< Stays where it is when the database moves.
  std::unique_ptr<sqlite3, Close> handle_;
};

/// One statement, prepared.
class SqliteStatement {
 public:
  /// @throws DataError, also if there is more than one statement in `sql`
  SqliteStatement(const SqliteDatabase& database, std::string_view sql);
  /// Goes to the next row. @return whether there is one
  bool step();
  /// Runs a statement that gives no row, so that it can be run again.
  void run();
  [[nodiscard]] int columns() const { return sqlite3_column_count(handle_.get()); }
  [[nodiscard]] std::int64_t number(int column) const {
    return sqlite3_column_int64(handle_.get(), column);
  }
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] sqlite3_value* value(int column) const {
    return sqlite3_column_value(handle_.get(), column);
  }
  [[nodiscard]] std::string blob(int column) const;
  [[nodiscard]] std::string_view name(int column) const {
    return sqlite3_column_name(handle_.get(), column);
  }
  /// Makes it ready to be run from its beginning, with the values that are bound.
  void reset() { sqlite3_reset(handle_.get()); }
  /// Places are numbered from 1 on.
  void bind(int place, std::int64_t number);
  void bind(int place, sqlite3_value* value);
  void bind(int place, std::string_view blob);

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  const SqliteDatabase& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

}  // namespace raymoval
