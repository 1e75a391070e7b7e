// SPDX-License-Identifier: MIT
#include "datasets/reading/loaded_data.h"

#include "core/error.h"
#include "datasets/open_sequence.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using test::TemporaryFolder;

namespace {

std::string scan_bytes(float x) {
  return test::floats({x, 1, 2, 0.5F, 4, 5, 6, 0.5F});
}

/// Two scans of two points with labels.
void write_sequence(const TemporaryFolder& at) {
  for (const char* name : {"000000", "000001"}) {
    at.write("velodyne/" + std::string(name) + ".bin", scan_bytes(3));
    at.write("labels/" + std::string(name) + ".label", test::words({9, 252}));
  }
  at.write("poses.txt", test::kIdentityRow + test::kIdentityRow);
  at.write("sequence.json", R"({"poses_are_lidar": true, "sensor": "hdl64e"})");
}

LoadedData all_of(const WatchedSequence& data) {
  for (std::size_t i = 0; i < data.sequence.scans->size(); ++i) {
    (void)data.sequence.labels->labels(data.sequence.scans->load(i));
  }
  return data.loaded();
}

}  // namespace

TEST_CASE("A watched sequence is the same sequence") {
  const TemporaryFolder at;
  write_sequence(at);
  const Sequence sequence = open_sequence(at.text(), {});
  const WatchedSequence data = watched(open_sequence(at.text(), {}));
  CHECK(fingerprint(data.sequence, 2) == fingerprint(sequence, 1));
  CHECK(changed_data(all_of(data), data.loaded()).empty());
}

TEST_CASE("A scan or label that is another when it is read again is an error") {
  const TemporaryFolder at;
  write_sequence(at);
  const WatchedSequence data = watched(open_sequence(at.text(), {}));
  const Scan scan = data.sequence.scans->load(1);
  (void)data.sequence.scans->load(1);
  (void)data.sequence.labels->labels(scan);
  at.write("labels/000001.label", test::words({9, 9}));
  test::check_says(test::message_of<DataError>([&] { (void)data.sequence.labels->labels(scan); }),
                   {"the data changed", "the labels of scan 000001"});
  at.write("velodyne/000001.bin", scan_bytes(7));
  test::check_says(test::message_of<DataError>([&] { (void)data.sequence.scans->load(1); }),
                   {"the data changed", "points, pose or time of scan 000001"});
  // A caller that ignores the error cannot hide it.
  CHECK_THAT(data.loaded().change, Catch::Contains("000001"));
}

TEST_CASE(
    "What two readers read is compared scan by scan, and what one did not read does not count") {
  const TemporaryFolder at;
  write_sequence(at);
  const LoadedData before = all_of(watched(open_sequence(at.text(), {})));
  const WatchedSequence none = watched(open_sequence(at.text(), {}));
  CHECK(changed_data(before, none.loaded()).empty());

  at.write("velodyne/000001.bin", scan_bytes(8));
  const WatchedSequence first = watched(open_sequence(at.text(), {}));
  (void)first.sequence.scans->load(0);
  CHECK(changed_data(before, first.loaded()).empty());
  CHECK_THAT(changed_data(before, all_of(first)), Catch::Contains("scan 000001"));
  at.write("velodyne/000001.bin", scan_bytes(3));
  CHECK(changed_data(before, all_of(watched(open_sequence(at.text(), {})))).empty());

  at.write("labels/000000.label", test::words({252, 252}));
  CHECK_THAT(changed_data(before, all_of(watched(open_sequence(at.text(), {})))),
             Catch::Contains("the labels of scan 000000"));
  at.write("labels/000000.label", test::words({9, 252}));

  // Poses count though no scan is loaded: a method may use them alone.
  at.write("poses.txt", test::kIdentityRow + "1 0 0 5 0 1 0 0 0 0 1 0\n");
  CHECK_THAT(changed_data(before, watched(open_sequence(at.text(), {})).loaded()),
             Catch::Contains("poses, sensor"));
  at.write("poses.txt", test::kIdentityRow + test::kIdentityRow);
  at.write("sequence.json", R"({"poses_are_lidar": true, "sensor": "vlp16"})");
  CHECK_THAT(changed_data(before, watched(open_sequence(at.text(), {})).loaded()),
             Catch::Contains("poses, sensor"));
  SequenceOptions options;
  options.frames = parse_frame_range("0:0");
  CHECK_THAT(changed_data(before, watched(open_sequence(at.text(), options)).loaded()),
             Catch::Contains("it had 2 scans and has 1"));
}
