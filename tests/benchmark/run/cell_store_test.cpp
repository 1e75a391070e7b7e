// SPDX-License-Identifier: MIT
#include "benchmark/run/folder/cell_store.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "benchmark/process/checked_sink.h"
#include "benchmark/result/cell_json.h"
#include "benchmark/result/checks/differences.h"
#include "benchmark/result/removals/removal_files.h"
#include "core/files/files.h"
#include "core/files/part_name.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const CellName kName{"town", "comb"};

CellIdentity identity() {
  CellIdentity wanted;
  wanted.method = {"comb", "default", "1", false, false, {{"size", 0.5}}};
  wanted.data = DataRecord{"town", "files"};
  wanted.data.fingerprint = "f";
  wanted.protocols = {{"erasor", "erasor", "1", {}}};
  return wanted;
}

MaskStore masks_of_two_scans() {
  MaskStore masks(2);
  masks.set(0, {0, 1, 1});
  masks.set(1, {1});
  return masks;
}

Cell cell_of(const CellIdentity& identity, const MaskStore& masks) {
  Cell cell{kName.sequence, kName.name, cell_key(identity)};
  cell.method = identity.method;
  cell.data = identity.data;
  cell.scores = {Score{identity.protocols[0]}};
  cell.masks = MaskRecord{mask_digest(masks), 3};
  return cell;
}

/// Removals that are written and wait for `keep`.
fs::path written_removals(const CellStore& store, const MaskStore& masks) {
  store.prepare(kName);
  const fs::path place = store.new_removals(kName);
  write_removals(place, test::TwoScans(), masks, [] {});
  return place;
}

/// A cell, and a store in which it is not yet.
struct OneCell {
  test::TemporaryFolder folder;
  CellStore store{folder.path()};
  MaskStore masks = masks_of_two_scans();
  Cell cell = cell_of(identity(), masks);
};

/// The events on names in folders, in order, from the kernel.
class FolderWatch {
 public:
  explicit FolderWatch(const std::vector<fs::path>& folders) : file_(::inotify_init1(IN_NONBLOCK)) {
    for (const fs::path& folder : folders) {
      ::inotify_add_watch(file_, folder.c_str(), IN_DELETE | IN_MOVED_TO);
    }
  }
  ~FolderWatch() { ::close(file_); }
  FolderWatch(const FolderWatch&) = delete;
  FolderWatch& operator=(const FolderWatch&) = delete;

  /// "gone NAME" and "there NAME" up to now.
  std::vector<std::string> events() {
    std::vector<std::string> list;
    alignas(inotify_event) char buffer[8192];
    for (ssize_t size = 0; (size = ::read(file_, buffer, sizeof buffer)) > 0;) {
      for (const char* at = buffer; at < buffer + size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(at);
        if (event->len > 0) {
          list.push_back(((event->mask & IN_DELETE) != 0 ? "gone " : "there ") +
                         std::string(event->name));
        }
        at += sizeof(inotify_event) + event->len;
      }
    }
    return list;
  }

 private:
  int file_;
};

std::ptrdiff_t position(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) - list.begin();
}

}  // namespace

TEST_CASE("No cell stands beside removals of another one at any moment") {
  const OneCell one;
  const auto& [folder, store, masks, cell] = one;
  store.keep(cell, written_removals(store, masks));
  const fs::path removals = written_removals(store, masks);
  FolderWatch watch({store.folder(kName), store.folder(kName) / "removals"});
  store.keep(cell, removals);
  const auto events = watch.events();
  CAPTURE(events);
  // First the old cell is deleted, then its removals; the new removals are written, and last their
  // cell.
  const std::vector<std::string> order = {"gone cell.json", "gone 000007.label", "there removals",
                                          "there cell.json"};
  for (std::size_t i = 0; i < order.size(); ++i) {
    REQUIRE(position(events, order[i]) < std::ssize(events));
    if (i > 0) CHECK(position(events, order[i - 1]) < position(events, order[i]));
  }
}

TEST_CASE("A place where a cell could not be kept is refused before it is needed, and left whole") {
  const OneCell one;
  const auto& [folder, store, masks, cell] = one;
  store.keep(cell, written_removals(store, masks));
  const fs::path removals = written_removals(store, masks);
  const fs::path place = store.folder(kName);
  write_atomically(place / "removals/notes.txt", "mine");
  CHECK_THROWS_WITH(store.prepare(kName),
                    Contains("removals: holds files that are not from a run"));
  CHECK_THROWS_WITH(store.keep(cell, removals),
                    Contains("removals: holds files that are not from a run"));
  CHECK(store.has_result(kName));
  const test::TwoScans scans;
  CHECK(store.find(kName, identity(), &scans).state == StoredCell::State::kFresh);
}

TEST_CASE("What a killed run left of a cell goes before it is run again, and nothing else does") {
  const test::TemporaryFolder folder;
  const CellStore store(folder.path());
  const fs::path place = store.folder(kName);
  make_folder(place);
  const std::vector<fs::path> left = {new_part_name(place / "cell.json")};
  const std::vector<fs::path> foreign = {new_part_name(place / "notes.json"), place / "cell.json"};
  for (const fs::path& file : left) write_atomically(file, "half");
  for (const fs::path& file : foreign) write_atomically(file, "whole");
  write_atomically(place / "keep.txt", "mine");
  store.prepare(kName);
  for (const fs::path& file : left) CHECK_FALSE(fs::exists(file));
  for (const fs::path& file : foreign) CHECK(fs::exists(file));
  CHECK(fs::exists(place / "keep.txt"));
}

TEST_CASE("A stored cell is fresh, stale, failed or missing") {
  using State = StoredCell::State;
  const test::TemporaryFolder folder;
  const CellStore store(folder.path());
  const MaskStore masks = masks_of_two_scans();
  const test::TwoScans scans;
  const StoredCell missing = store.find(kName, identity(), nullptr);
  CHECK(missing.state == State::kMissing);
  CHECK(missing.why == "is not there yet");

  Cell cell = cell_of(identity(), masks);
  store.keep(cell, written_removals(store, masks));
  const StoredCell fresh = store.find(kName, identity(), &scans);
  CHECK(fresh.state == State::kFresh);
  CHECK(fresh.why.empty());
  REQUIRE(fresh.cell);
  CHECK(fresh.cell->masks->removed == 3);

  CellIdentity other = identity();
  other.method.version = "2";
  const StoredCell stale = store.find(kName, other, nullptr);
  CHECK(stale.state == State::kStale);
  CHECK_THAT(stale.why, Contains("version"));
  CHECK_FALSE(stale.cell);

  cell.fail(CellStatus::kTimeout, "took too long");
  store.keep(cell);
  const StoredCell failed = store.find(kName, identity(), nullptr);
  CHECK(failed.state == State::kFailed);
  CHECK(failed.why == "failed last time: took too long");
  REQUIRE(failed.cell);
  CHECK(store.find(kName, other, nullptr).state == State::kStale);
}

TEST_CASE("A cell whose removals are asked for has to have the very masks it was scored by") {
  using State = StoredCell::State;
  const test::TemporaryFolder folder;
  const CellStore store(folder.path());
  const MaskStore masks = masks_of_two_scans();
  const test::TwoScans scans;
  Cell cell = cell_of(identity(), masks);
  store.keep(cell);  // Without removals.
  CHECK(store.find(kName, identity(), nullptr).state == State::kFresh);
  CHECK(store.find(kName, identity(), &scans).state == State::kStale);

  MaskStore others = masks_of_two_scans();
  others.set(1, {0});
  store.keep(cell, written_removals(store, others));
  CHECK(store.find(kName, identity(), nullptr).state == State::kFresh);
  const StoredCell stale = store.find(kName, identity(), &scans);
  CHECK(stale.state == State::kStale);
  CHECK_THAT(stale.why, Contains("removals"));

  cell.masks.reset();
  store.keep(cell, written_removals(store, masks));
  CHECK(store.find(kName, identity(), &scans).state == State::kStale);
}
