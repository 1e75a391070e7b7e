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

/// A database of SQLite, which nothing else uses at the same time. Errors are DataError for what is
/// wrong in the file, and UnreadableError for a disk that fails.
class SqliteDatabase {
 public:
  /// Opens a file to read it, and neither locks nor changes it.
  /// @param is_cut whether the file has fewer pages than it says, so that some cannot be read
  static SqliteDatabase to_read(const std::filesystem::path& path, bool is_cut);

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

/// A recording in a database of SQLite, as rosbag2 writes it (.db3).
class Db3Bag : public Bag {
 public:
  /// @throws DataError if it is no database or has not the tables of rosbag2, or if a journal or a
  ///   write-ahead log beside it has what it lacks; UnreadableError
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

  /// "drive_0.db3: message 17", to begin messages.
  [[nodiscard]] std::string place(std::int64_t row) const;
  /// The first `most` bytes in the row of a message, packed or not. @throws as `message`
  [[nodiscard]] std::string stored(
      std::int64_t row, std::size_t most = std::numeric_limits<std::size_t>::max()) const;
  [[nodiscard]] const SqliteDatabase& database() const { return database_; }
  /// The topic of an id in the table `topics`; nothing if it is not there.
  [[nodiscard]] std::optional<std::size_t> topic_of(std::int64_t id) const;
  [[nodiscard]] std::uint64_t file_size() const { return file_.size(); }

 private:
  void check_tables() const;
  void read_topics();

  BagFile file_;  ///< Held so that the file stays what it is while it is read.
  DamageNotes damage_;
  SqliteDatabase database_;
  std::map<std::int64_t, std::size_t> topics_;
  MessageTable table_;
  mutable std::mutex reading_;
};

/// Goes through the messages of a database in the order of their rows.
class Db3Rows {
 public:
  struct Row {
    std::int64_t id = 0, stamp = 0;
    std::size_t topic = 0;
  };
  /// @param damage gets a note for what cannot be read
  Db3Rows(const Db3Bag& bag, DamageNotes& damage);
  /// The next message that can be read; nothing at the end, or where damage ends it.
  /// @throws UnreadableError
  std::optional<Row> next();

 private:
  std::optional<Row> row();
  const Db3Bag& bag_;
  DamageNotes& damage_;
  std::optional<SqliteStatement> rows_;
  std::optional<std::int64_t> last_;
  std::uint64_t bytes_ = 0;
};

}  // namespace raymoval
