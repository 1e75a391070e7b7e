// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <optional>

#include "datasets/bags/bag.h"
#include "datasets/bags/chunks/bag_file.h"
#include "datasets/bags/chunks/message_table.h"
#include "datasets/bags/damage_notes.h"
#include "datasets/bags/ros2/sqlite.h"

namespace raymoval {

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
  [[nodiscard]] const MessageTable& table() const { return table_; }

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
