// SPDX-License-Identifier: MIT
#include "datasets/bags/ros2/db3_bag.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/text.h"
#include "datasets/bags/chunks/zstandard.h"

namespace raymoval {
namespace {

constexpr std::string_view kMagic{"SQLite format 3\0", 16};
/// The beginning of a journal whose changes are not undone yet.
constexpr std::string_view kHotJournal = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t number = 0;
  for (const char byte : bytes) number = number << 8U | static_cast<unsigned char>(byte);
  return number;
}

/// What SQLite keeps beside a database while it is written.
void check_nothing_beside(const std::filesystem::path& path) {
  const std::string remedy =
      " belongs to it and holds what is not in it yet: the recorder was stopped in the middle, or "
      "is running. Open it once with what may write it: `sqlite3 " +
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

/// Looks at the head of a database. @return whether it has fewer pages than it says
bool is_cut(const BagFile& file, DamageNotes& damage) {
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
  damage.add(file.path().string() + ": the database is cut: it has " + grouped_text(file.size()) +
             " of " + grouped_text(expected) + " bytes; what can be found in them is read.");
  return true;
}

}  // namespace

Db3Bag::Db3Bag(const std::filesystem::path& path)
    : file_((check_nothing_beside(path), path)),
      database_(SqliteDatabase::to_read(path, is_cut(file_, damage_))) {
  check_tables();
  read_topics();
  Db3Rows rows(*this, damage_);
  while (const auto row = rows.next()) {
    table_.add(row->topic, {row->stamp, static_cast<std::uint64_t>(row->id)});
  }
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
                    "', so it is no recording of rosbag2, or cut where that should stand. Name a "
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

std::string Db3Bag::place(std::int64_t row) const {
  return path().filename().string() + ": message " + std::to_string(row);
}

std::optional<std::size_t> Db3Bag::topic_of(std::int64_t id) const {
  const auto found = topics_.find(id);
  return found == topics_.end() ? std::nullopt : std::optional(found->second);
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
  return unpacked_if_packed(stored(row), topics()[topic].encoding == MessageEncoding::kCdr,
                            place(row));
}

std::string Db3Bag::message_head(std::size_t topic, std::size_t index, std::size_t most) const {
  // Of a cut file a message may be there with its beginning only, which has to show now.
  if (!damage_.empty()) return Bag::message_head(topic, index, most);
  std::string head = stored(static_cast<std::int64_t>(table_.at(topic, index).place), most);
  return is_zstd(head) ? Bag::message_head(topic, index, most) : head;
}

Db3Rows::Db3Rows(const Db3Bag& bag, DamageNotes& damage) : bag_(bag), damage_(damage) {
  bag.database().allow_steps(10'000'000 + 4 * static_cast<std::int64_t>(bag.file_size()));
}

std::optional<Db3Rows::Row> Db3Rows::next() {
  try {
    return row();
  } catch (const UnreadableError&) {
    throw;
  } catch (const DataError& error) {
    damage_.add(error.what());
    return std::nullopt;
  }
}

std::optional<Db3Rows::Row> Db3Rows::row() {
  if (!rows_) {
    // No index is used, for in a cut file it may be what is missing.
    rows_.emplace(bag_.database(),
                  "SELECT rowid, topic_id, timestamp, CASE typeof(data) WHEN 'blob' THEN "
                  "length(data) ELSE -1 END FROM messages NOT INDEXED");
  }
  while (rows_->step()) {
    const std::int64_t id = rows_->number(0), size = rows_->number(3);
    bytes_ += static_cast<std::uint64_t>(std::max<std::int64_t>(0, size));
    // Rows can be made to share pages, and pages to contain each other. Then ids do not grow, or
    // the messages together have more bytes than the file.
    if (id < 0 || (last_ && id <= *last_) || bytes_ > bag_.file_size()) {
      throw DataError(bag_.place(id) +
                      " shares its place in the file with others; the database is damaged, and "
                      "what stands before is read.");
    }
    last_ = id;
    const auto topic = bag_.topic_of(rows_->number(1));
    if (topic && size >= 0) return Row{id, rows_->number(2), *topic};
    damage_.add(bag_.place(id) + " has no " + (topic ? "bytes" : "topic") + "; left out.");
  }
  return std::nullopt;
}

}  // namespace raymoval
