// SPDX-License-Identifier: MIT
#include <limits>
#include <optional>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "datasets/bags/chunks/pack.h"
#include "datasets/bags/chunks/zstandard.h"
#include "datasets/bags/rewriting/rewrite_file.h"

namespace raymoval {
namespace {

std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char letter : name) text += letter == '"' ? "\"\"" : std::string(1, letter);
  return text + "\"";
}

class Db3Rewriting {
 public:
  Db3Rewriting(const Db3Bag& bag, const std::filesystem::path& output, const ChangeMessage& change)
      : bag_(bag), in_(bag.database()), out_(SqliteDatabase::to_write(output)), change_(change) {}

  void run() {
    for (const char* name : {"page_size", "user_version", "application_id"}) copy_setting(name);
    out_.run("BEGIN");
    for (const std::string& table : make("table")) {
      if (table == "messages") {
        copy_messages();
      } else {
        copy_table(table);
      }
    }
    (void)make("index");
    out_.run("COMMIT");
  }

 private:
  void copy_setting(const std::string& name) const {
    SqliteStatement setting(in_, "PRAGMA " + name);
    if (setting.step()) out_.run("PRAGMA " + name + "=" + std::to_string(setting.number(0)));
  }

  /// Makes what the input has of `type` by the SQL that made it there. @return the names
  [[nodiscard]] std::vector<std::string> make(const std::string& type) const {
    std::vector<std::string> names;
    SqliteStatement known(in_, "SELECT name, sql FROM sqlite_master WHERE type='" + type +
                                   "' AND sql IS NOT NULL AND name NOT LIKE 'sqlite\\_%' ESCAPE "
                                   "'\\' ORDER BY rowid");
    while (known.step()) {
      names.push_back(known.text(0));
      SqliteStatement(out_, known.text(1)).run();
    }
    return names;
  }

  [[nodiscard]] SqliteStatement insertion(const std::string& table, int columns) const {
    std::string places;
    for (int i = 0; i < columns; ++i) places += i == 0 ? "?" : ",?";
    return {out_, "INSERT INTO " + quoted(table) + " VALUES(" + places + ")"};
  }

  /// Copies a table up to damage in it.
  void copy_table(const std::string& table) const {
    SqliteStatement rows(in_, "SELECT * FROM " + quoted(table) + " NOT INDEXED");
    SqliteStatement insert = insertion(table, rows.columns());
    while (if_whole([&] { return rows.step(); }) == true) {
      for (int i = 0; i < rows.columns(); ++i) insert.bind(i + 1, rows.value(i));
      insert.run();
    }
  }

  void copy_messages() {
    DamageNotes known;
    Db3Rows rows(bag_, known);
    // The bag has found out already that going through the rows ends.
    in_.allow_steps(std::numeric_limits<std::int64_t>::max());
    SqliteStatement fields(in_, "SELECT * FROM messages WHERE rowid=?");
    SqliteStatement insert = insertion("messages", fields.columns());
    int data = 0;
    while (data < fields.columns() && fields.name(data) != "data") ++data;
    if (data == fields.columns()) {
      throw DataError(bag_.path().string() + ": the table 'messages' has no column 'data'.");
    }
    while (const auto row = rows.next()) {
      const auto is_copied = if_whole([&] {
        fields.bind(1, row->id);
        return fields.step();
      });
      if (is_copied == true) copy_message(*row, fields, insert, data);
      fields.reset();
    }
  }

  void copy_message(const Db3Rows::Row& row, const SqliteStatement& fields, SqliteStatement& insert,
                    int data) {
    const std::string stored = fields.blob(data);
    const auto index =
        bag_.table().index_of(row.topic, {row.stamp, static_cast<std::uint64_t>(row.id)});
    const bool is_cdr = bag_.topics()[row.topic].encoding == MessageEncoding::kCdr;
    const auto message =
        if_whole([&] { return unpacked_if_packed(stored, is_cdr, bag_.place(row.id)); });
    if (!index || !message) return;
    auto changed = change_(row.topic, *index, *message);
    if (!changed) return;
    for (int i = 0; i < fields.columns(); ++i) insert.bind(i + 1, fields.value(i));
    if (*changed != *message) {
      if (is_cdr && is_zstd(stored)) changed = pack_zstd(*changed);
      insert.bind(data + 1, std::string_view(*changed));
    }
    insert.run();
  }

  const Db3Bag& bag_;
  const SqliteDatabase& in_;
  SqliteDatabase out_;
  const ChangeMessage& change_;
};

}  // namespace

void rewrite_db3(const Db3Bag& bag, const std::filesystem::path& output,
                 const ChangeMessage& change) {
  Db3Rewriting(bag, output, change).run();
}

}  // namespace raymoval
