// SPDX-License-Identifier: MIT
#include "datasets/bags/ros2/sqlite.h"

#include <algorithm>
#include <limits>
#include <new>
#include <system_error>

#include "core/error.h"
#include "core/files/file_kind.h"

namespace raymoval {
namespace {

constexpr int kStepsAtOnce = 1000;
/// What reading the list of tables takes at most.
constexpr std::int64_t kStepsOfSchema = 5'000'000;
constexpr std::int64_t kMostValueBytes = std::int64_t{1} << 30;

int count_steps(void* left) {
  auto* steps = static_cast<std::int64_t*>(left);
  *steps -= kStepsAtOnce;
  return *steps < 0 ? 1 : 0;
}

/// Lets SQL that stands in a file make tables and indexes, and nothing else.
int allow_tables(void*, int action, const char*, const char*, const char*, const char*) {
  switch (action) {
    case SQLITE_CREATE_TABLE:
    case SQLITE_CREATE_INDEX:
    case SQLITE_INSERT:
    case SQLITE_UPDATE:
    case SQLITE_READ:
    case SQLITE_REINDEX:
    case SQLITE_TRANSACTION:
    case SQLITE_PRAGMA:
      return SQLITE_OK;
    default:
      return SQLITE_DENY;
  }
}

/// "file:..." of a path, in which three characters have another meaning.
std::string uri_of(const std::filesystem::path& path, std::string_view options) {
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
  return uri + std::string(options);
}

}  // namespace

SqliteDatabase::SqliteDatabase(std::filesystem::path path, const std::string& uri, int flags)
    : path_(std::move(path)), steps_(std::make_unique<std::int64_t>(kStepsOfSchema)) {
  sqlite3* opened = nullptr;
  const int code =
      sqlite3_open_v2(uri.c_str(), &opened, flags | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(opened);
  if (!handle_) throw std::bad_alloc();
  if (code != SQLITE_OK) fail(code);
  sqlite3_extended_result_codes(handle(), 1);
  sqlite3_progress_handler(handle(), kStepsAtOnce, count_steps, steps_.get());
  sqlite3_db_config(handle(), SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle(), SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle(), SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  run("PRAGMA mmap_size=0");
  run("PRAGMA temp_store=MEMORY");
}

SqliteDatabase SqliteDatabase::to_read(const std::filesystem::path& path, bool is_cut) {
  SqliteDatabase database(path, uri_of(path, "?mode=ro&immutable=1"), SQLITE_OPEN_READONLY);
  const auto most = std::min<std::int64_t>(kMostValueBytes,
                                           static_cast<std::int64_t>(plain_file_size(path)) + 1024);
  sqlite3_limit(database.handle(), SQLITE_LIMIT_LENGTH, static_cast<int>(most));
  database.run("PRAGMA cell_size_check=ON");
  // So the library opens what has fewer pages than it says. Nothing is written in any case.
  if (is_cut) database.run("PRAGMA writable_schema=ON");
  return database;
}

SqliteDatabase SqliteDatabase::to_write(const std::filesystem::path& path) {
  SqliteDatabase database(path, uri_of(path, "?mode=rw"), SQLITE_OPEN_READWRITE);
  database.run("PRAGMA locking_mode=EXCLUSIVE");
  database.run("PRAGMA journal_mode=OFF");
  database.run("PRAGMA synchronous=OFF");
  sqlite3_set_authorizer(database.handle(), allow_tables, nullptr);
  database.allow_steps(std::numeric_limits<std::int64_t>::max());
  return database;
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
    // The library says so of damaged schemas as well, and it asks for little otherwise.
    throw DataError(path_.string() +
                    ": reading it takes memory that is not to be had. If the machine has memory "
                    "left, the database is damaged: copy it again.");
  }
  if ((kind == SQLITE_IOERR && code != SQLITE_IOERR_SHORT_READ) || kind == SQLITE_CANTOPEN ||
      kind == SQLITE_PERM) {
    const int cause = handle_ ? sqlite3_system_errno(handle()) : 0;
    throw UnreadableError(path_.string() + ": cannot be read or written (" + reason +
                          (cause == 0 ? "" : ": " + std::generic_category().message(cause)) +
                          "). Check its rights, and that its disk or share answers.");
  }
  if (kind == SQLITE_FULL) {
    throw DataError(path_.string() + ": cannot be written (" + reason + "). Free space.");
  }
  if (kind == SQLITE_INTERRUPT) {
    throw DataError(path_.string() +
                    ": reading it takes more steps than its size explains; the database is damaged "
                    "or built to hang. Record or copy it again.");
  }
  throw DataError(path_.string() + ": the database cannot be read (" + reason +
                  "); it is damaged or cut. Copy it again, or save what is left by `sqlite3 FILE "
                  ".recover`.");
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

void SqliteStatement::run() {
  step();
  sqlite3_reset(handle_.get());
}

std::string SqliteStatement::text(int column) const {
  const auto* text = sqlite3_column_text(handle_.get(), column);
  const int size = sqlite3_column_bytes(handle_.get(), column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text), static_cast<std::size_t>(size)};
}

std::string SqliteStatement::blob(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(handle_.get(), column));
  const int size = sqlite3_column_bytes(handle_.get(), column);
  return bytes == nullptr ? std::string() : std::string(bytes, static_cast<std::size_t>(size));
}

void SqliteStatement::bind(int place, std::int64_t number) {
  const int code = sqlite3_bind_int64(handle_.get(), place, number);
  if (code != SQLITE_OK) database_.fail(code);
}

void SqliteStatement::bind(int place, sqlite3_value* value) {
  const int code = sqlite3_bind_value(handle_.get(), place, value);
  if (code != SQLITE_OK) database_.fail(code);
}

void SqliteStatement::bind(int place, std::string_view blob) {
  const int code =
      sqlite3_bind_blob64(handle_.get(), place, blob.data(), blob.size(), SQLITE_TRANSIENT);
  if (code != SQLITE_OK) database_.fail(code);
}

}  // namespace raymoval
