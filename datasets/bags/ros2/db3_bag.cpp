// SPDX-License-Identifier: MIT
#include <sqlite3.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bags/bag_file.h"
#include "datasets/bags/bag_formats.h"
#include "datasets/bags/bag_index.h"
#include "datasets/bags/decompress.h"

namespace raymoval {
namespace {

constexpr int kStepsAtOnce = 1000;
/// Largest number of steps to read the list of tables, at ten steps a table. The time grows with
/// the square of the number of tables, and recordings have fewer than ten.
constexpr std::int64_t kStepsOfSchema = 10'000;
constexpr std::int64_t kMostValueBytes = std::int64_t{1} << 30;

int count_steps(void* left) {
  auto* steps = static_cast<std::int64_t*>(left);
  *steps -= kStepsAtOnce;
  return *steps < 0 ? 1 : 0;
}

/// "file:..." of a path, read-only. Three characters have another meaning there and are escaped.
std::string uri_of(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char letter : std::filesystem::absolute(path).string()) {
    if (letter == '?') {
      uri += "%3f";
    } else if (letter == '#') {
      uri += "%23";
    } else if (letter == '%') {
      uri += "%25";
    } else {
      uri += letter;
    }
  }
  return uri + "?mode=ro&immutable=1";
}

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

SqliteDatabase::SqliteDatabase(const std::filesystem::path& path, bool is_truncated)
    : path_(path), steps_(kStepsOfSchema) {
  sqlite3* opened = nullptr;
  const int code =
      sqlite3_open_v2(uri_of(path).c_str(), &opened,
                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(opened);
  if (!handle_) throw std::bad_alloc();
  if (code != SQLITE_OK) fail(code);
  sqlite3_extended_result_codes(handle(), 1);
  sqlite3_progress_handler(handle(), kStepsAtOnce, count_steps, &steps_);
  sqlite3_db_config(handle(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle(), SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle(), SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  run("PRAGMA mmap_size=0");
  run("PRAGMA temp_store=MEMORY");
  const auto most = std::min<std::int64_t>(kMostValueBytes,
                                           static_cast<std::int64_t>(plain_file_size(path)) + 1024);
  sqlite3_limit(handle(), SQLITE_LIMIT_LENGTH, static_cast<int>(most));
  run("PRAGMA cell_size_check=ON");
  // With this, the library opens a truncated file. Nothing is written in any case.
  if (is_truncated) run("PRAGMA writable_schema=ON");
}

void SqliteDatabase::run(const std::string& sql) const {
  SqliteStatement statement(*this, sql);
  while (statement.step()) {
  }
}

void SqliteDatabase::fail(int code) const {
  const int kind = code & 0xFF;
  const std::string reason = handle_ ? sqlite3_errmsg(handle()) : sqlite3_errstr(code);
  if (kind == SQLITE_NOMEM) {
    // The library reports this for damaged schemas as well; it needs little memory otherwise.
    throw DataError(path_.string() +
                    ": there is not enough memory to read it. If the machine has memory left, the "
                    "database is damaged: copy it again.");
  }
  if ((kind == SQLITE_IOERR && code != SQLITE_IOERR_SHORT_READ) || kind == SQLITE_CANTOPEN ||
      kind == SQLITE_PERM) {
    const int cause = handle_ ? sqlite3_system_errno(handle()) : 0;
    throw UnreadableError(path_.string() + ": cannot be read or written (" + reason +
                          (cause == 0 ? "" : ": " + std::generic_category().message(cause)) +
                          "). Check its rights, and that its disk or share is reachable.");
  }
  if (kind == SQLITE_INTERRUPT) {
    throw DataError(
        path_.string() +
        ": reading it takes more steps than a recording of its size; it has far too many "
        "tables, or is damaged. Name a .db3 that `ros2 bag record` wrote, or copy it "
        "again.");
  }
  throw DataError(path_.string() + ": the database cannot be read (" + reason +
                  "); it is damaged or truncated. Copy it again, or save what is left by `sqlite3 "
                  "FILE .recover`.");
}

SqliteStatement::SqliteStatement(const SqliteDatabase& database, std::string_view sql)
    : database_(database) {
  sqlite3_stmt* prepared = nullptr;
  const char* rest = nullptr;
  const int code = sqlite3_prepare_v2(database.handle(), sql.data(), static_cast<int>(sql.size()),
                                      &prepared, &rest);
  handle_.reset(prepared);
  if (code != SQLITE_OK) database_.fail(code);
  const std::string_view behind = sql.substr(static_cast<std::size_t>(rest - sql.data()));
  if (prepared == nullptr || behind.find_first_not_of(" \t\r\n;") != std::string_view::npos) {
    throw DataError(database.path().string() +
                    ": a text in it that makes a table holds something else; it is damaged.");
  }
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  database_.fail(code);
}

std::string SqliteStatement::text(int column) const {
  const auto* text = sqlite3_column_text(handle_.get(), column);
  const int size = sqlite3_column_bytes(handle_.get(), column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text), static_cast<std::size_t>(size)};
}

constexpr std::string_view kMagic{"SQLite format 3\0", 16};
/// The beginning of a journal whose changes are not undone yet.
constexpr std::string_view kHotJournal = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t number = 0;
  for (const char byte : bytes) number = number << 8U | static_cast<unsigned char>(byte);
  return number;
}

/// Refuses a database with a journal or a write-ahead log of unfinished writes.
void check_nothing_beside(const std::filesystem::path& path) {
  const std::string remedy =
      " belongs to it and holds data that is not in it yet: the recorder was stopped in the "
      "middle, or is running. Open it once with write access: `sqlite3 " +
      path.filename().string() + " 'PRAGMA wal_checkpoint(TRUNCATE); SELECT 1 FROM topics;'`.";
  for (const char* ending : {"-wal", "-journal"}) {
    const std::filesystem::path beside = path.string() + ending;
    if (!is_file(beside)) continue;
    const std::string head = BagFile(beside).read_up_to(0, kHotJournal.size());
    const bool matters = std::string_view(ending) == "-wal" ? !head.empty() : head == kHotJournal;
    if (matters) {
      throw DataError(path.string() + ": the file " + beside.filename().string() + remedy);
    }
  }
}

/// Reads the head of a database. @return whether the file has fewer pages than the head states
bool is_truncated(const BagFile& file, DamageNotes& damage) {
  const std::string head = file.read_up_to(0, 100);
  if (!head.starts_with(kMagic) || head.size() < 100) {
    throw DataError(file.path().string() +
                    ": does not begin as a database of SQLite; it is damaged or something else. "
                    "Copy it again.");
  }
  const std::uint64_t stored_size = big_endian(head.substr(16, 2));
  const std::uint64_t page_size = stored_size == 1 ? 65536 : stored_size;
  const std::uint64_t expected = page_size * big_endian(head.substr(28, 4));
  if (file.size() >= expected) return false;
  damage.add(file.path().string() + ": the database is truncated: it has " +
             grouped_text(file.size()) + " of " + grouped_text(expected) +
             " bytes; all readable messages in them are read.");
  return true;
}

/// A recording in a SQLite database of rosbag2 (.db3).
class Db3Bag : public IndexedBag {
 public:
  /// @throws DataError if it is no database, lacks the tables of rosbag2, or has a journal or a
  ///   write-ahead log of unfinished writes beside it; UnreadableError
  explicit Db3Bag(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const override { return file_.path(); }
  [[nodiscard]] std::string message(std::size_t topic, std::size_t index) const override;
  [[nodiscard]] std::string message_head(std::size_t topic, std::size_t index,
                                         std::size_t most) const override;

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
  SqliteDatabase database_;
  std::map<std::int64_t, std::size_t> topics_;
  mutable std::mutex reading_;
};

Db3Bag::Db3Bag(const std::filesystem::path& path)
    : file_((check_nothing_beside(path), path)), database_(path, is_truncated(file_, damage_)) {
  check_tables();
  database_.allow_steps(10'000'000 + 4 * static_cast<std::int64_t>(file_.size()));
  read_topics();
  const std::string damage = damage_in([&] { read_messages(); });
  if (!damage.empty()) damage_.add(damage);
  table_.finish();
}

void Db3Bag::check_tables() const {
  for (const char* name : {"topics", "messages"}) {
    SqliteStatement tables(
        database_, "SELECT type, sql FROM sqlite_master WHERE name='" + std::string(name) + "'");
    const bool is_table =
        tables.step() && tables.text(0) == "table" && !tables.text(1).starts_with("CREATE VIRTUAL");
    SqliteStatement hidden(database_, "SELECT count(*) FROM pragma_table_xinfo('" +
                                          std::string(name) + "') WHERE hidden <> 0");
    if (is_table && hidden.step() && hidden.number(0) == 0) continue;
    throw DataError(path().string() + ": has no table '" + name +
                    "', so it is not a recording of rosbag2, or is truncated before it. Name a "
                    ".db3 that `ros2 bag record` wrote.");
  }
}

void Db3Bag::read_topics() {
  SqliteStatement rows(database_,
                       "SELECT rowid, name, type, serialization_format FROM topics NOT INDEXED");
  for (std::int64_t last = std::numeric_limits<std::int64_t>::min(); rows.step();) {
    const std::int64_t id = rows.number(0);
    if (id < last) break;
    last = id;
    const auto encoding = rows.text(3) == "cdr" ? MessageEncoding::kCdr : MessageEncoding::kOther;
    topics_.emplace(id, table_.topic(rows.text(1), ros1_type_name(rows.text(2)), encoding));
  }
}

void Db3Bag::read_messages() {
  // No index is used because it may be missing in a truncated file.
  SqliteStatement rows(database_,
                       "SELECT rowid, topic_id, timestamp, CASE typeof(data) WHEN 'blob' THEN "
                       "length(data) ELSE -1 END FROM messages NOT INDEXED");
  std::int64_t last = -1;
  std::uint64_t bytes = 0;
  while (rows.step()) {
    const std::int64_t id = rows.number(0), size = rows.number(3);
    bytes += static_cast<std::uint64_t>(std::max<std::int64_t>(0, size));
    // Rows can be made to share pages, and pages to contain each other. Then ids do not grow, or
    // the messages together have more bytes than the file.
    if (id <= last || bytes > file_.size()) {
      throw DataError(place(id) +
                      " shares its place in the file with others; the database is damaged, and "
                      "everything before it is read.");
    }
    last = id;
    const auto topic = topics_.find(rows.number(1));
    if (topic != topics_.end() && size >= 0) {
      table_.add(topic->second, {rows.number(2), static_cast<std::uint64_t>(id)});
    } else {
      damage_.add(place(id) + " has no " + (topic != topics_.end() ? "bytes" : "topic") +
                  "; left out.");
    }
  }
}

std::string Db3Bag::place(std::int64_t row) const {
  return path().filename().string() + ": message " + std::to_string(row);
}

std::string Db3Bag::stored(std::int64_t row, std::size_t most) const {
  const std::scoped_lock lock(reading_);
  sqlite3_blob* opened = nullptr;
  const int code =
      sqlite3_blob_open(database_.handle(), "main", "messages", "data", row, 0, &opened);
  const auto close = [](sqlite3_blob* blob) { sqlite3_blob_close(blob); };
  const std::unique_ptr<sqlite3_blob, decltype(close)> blob(opened);
  if (code != SQLITE_OK) database_.fail(code);
  const int size = sqlite3_blob_bytes(blob.get());
  if (static_cast<std::uint64_t>(size) > file_.size()) {
    throw DataError(place(row) + " has more bytes than the file; it is damaged. Copy it again.");
  }
  std::string bytes(std::min(static_cast<std::size_t>(size), most), '\0');
  const int read = sqlite3_blob_read(blob.get(), bytes.data(), static_cast<int>(bytes.size()), 0);
  if (read != SQLITE_OK) database_.fail(read);
  return bytes;
}

std::string Db3Bag::message(std::size_t topic, std::size_t index) const {
  const auto row = static_cast<std::int64_t>(table_.at(topic, index).place);
  return decompressed_if_needed(stored(row), topics()[topic].encoding == MessageEncoding::kCdr,
                                place(row));
}

std::string Db3Bag::message_head(std::size_t topic, std::size_t index, std::size_t most) const {
  // In a truncated file, a message may have only its beginning. Reading all of it detects that now.
  if (!damage_.empty()) return Bag::message_head(topic, index, most);
  std::string head = stored(static_cast<std::int64_t>(table_.at(topic, index).place), most);
  return is_zstd(head) ? Bag::message_head(topic, index, most) : head;
}

}  // namespace

std::unique_ptr<Bag> open_db3(const std::filesystem::path& path) {
  return std::make_unique<Db3Bag>(path);
}

}  // namespace raymoval
