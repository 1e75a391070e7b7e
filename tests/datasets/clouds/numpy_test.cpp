// SPDX-License-Identifier: MIT
// .npy and .npz files made by hand, after NumPy's description of the format (NEP 1).
#include <zlib.h>

#include <catch2/catch.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "datasets/clouds/cloud_file.h"
#include "tests/datasets/clouds/record_files.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

std::string npy(const std::string& descr, const std::string& shape, const std::string& body,
                int version = 1, const std::string& order = "False") {
  const std::string head =
      "{'descr': " + descr + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  std::string file = "\x93NUMPY" + std::string(1, static_cast<char>(version)) + '\0';
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i) {
    file += static_cast<char>((head.size() >> (8 * i)) & 0xFFU);
  }
  return file + head + body;
}

std::string npy_error(const std::string& content, const std::string& name = "a.npy") {
  const TemporaryFolder folder;
  const auto path = folder.write(name, content);
  return message_of<DataError>([&] { read_records(path); });
}

/// `bytes` in the form of deflate.
std::string deflated(const std::string& bytes) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string packed(bytes.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  packed.resize(packed.size() - stream.avail_out);
  deflateEnd(&stream);
  return packed;
}

template <class Number>
std::string raw(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

std::uint32_t checksum_of(const std::string& bytes) {
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(::crc32(0, data, static_cast<uInt>(bytes.size())));
}

struct ZipFile {
  std::string name, content;
  bool packed = false, wide = false;  ///< `wide`: its sizes are in a zip64 block.
};

std::string zip_of(const std::vector<ZipFile>& files, bool zip64 = false) {
  std::string archive, directory;
  for (const ZipFile& file : files) {
    const std::string packed = file.packed ? deflated(file.content) : file.content;
    const auto method = static_cast<std::uint16_t>(file.packed ? 8 : 0);
    const auto name_bytes = static_cast<std::uint16_t>(file.name.size());
    const auto small = [&](std::uint64_t size) {
      return raw(file.wide ? 0xFFFFFFFFU : static_cast<std::uint32_t>(size));
    };
    const std::string extra = file.wide ? raw(std::uint16_t{1}) + raw(std::uint16_t{16}) +
                                              raw(std::uint64_t{file.content.size()}) +
                                              raw(std::uint64_t{packed.size()})
                                        : "";
    const std::string common = raw(std::uint16_t{20}) + raw(std::uint16_t{0}) + raw(method) +
                               raw(std::uint32_t{0}) + raw(checksum_of(file.content)) +
                               small(packed.size()) + small(file.content.size()) + raw(name_bytes) +
                               raw(static_cast<std::uint16_t>(extra.size()));
    directory += "PK\x01\x02" + raw(std::uint16_t{20}) + common + raw(std::uint16_t{0}) +
                 raw(std::uint16_t{0}) + raw(std::uint16_t{0}) + raw(std::uint32_t{0}) +
                 raw(static_cast<std::uint32_t>(archive.size())) + file.name + extra;
    archive += "PK\x03\x04" + common + file.name + extra + packed;
  }
  const std::size_t start = archive.size();
  archive += directory;
  if (zip64) {
    const std::uint64_t end64 = archive.size();
    archive += "PK\x06\x06" + raw(std::uint64_t{44}) + std::string(12, '\0') +
               raw(std::uint64_t{files.size()}) + raw(std::uint64_t{files.size()}) +
               raw(std::uint64_t{directory.size()}) + raw(std::uint64_t{start});
    archive += "PK\x06\x07" + raw(std::uint32_t{0}) + raw(end64) + raw(std::uint32_t{1});
  }
  const auto count = static_cast<std::uint16_t>(zip64 ? 0xFFFF : files.size());
  return archive + "PK\x05\x06" + std::string(4, '\0') + raw(count) + raw(count) +
         raw(static_cast<std::uint32_t>(directory.size())) +
         raw(zip64 ? 0xFFFFFFFFU : static_cast<std::uint32_t>(start)) + std::string(2, '\0');
}

const std::string kTwoPoints = npy("'<f4'", "(2, 4)", floats({1, 2, 3, 4, 5, 6, 7, 8}));

}  // namespace

TEST_CASE("arrays of numbers have columns with names, and stay what they are", "[numpy]") {
  const TemporaryFolder folder;
  const std::string body = floats({1, 2, 3, 4, 5, 10, 20, 30, 40, 50});
  const auto path = folder.write("a.npy", npy("'<f4'", "(2, 5)", body));
  const PointRecords records = read_records(path);
  CHECK(field_texts(records.layout) == std::vector<std::string>{"float32 x", "float32 y",
                                                                "float32 z", "float32 intensity",
                                                                "float32 field_4"});
  CHECK(column(records, "field_4") == std::vector<double>{5, 50});
  write_records(folder / "b.npy", records);
  const std::string again = read_text(folder / "b.npy");
  check_says(again, {"'descr': '<f4'", "'shape': (2, 5, )"});
  CHECK(again.substr(again.size() - 40) == body);
  CHECK((again.size() - 40) % 64 == 0);

  const RecordReading reading{"t x y z _"};
  CHECK(column(read_records(path, reading), "x") == std::vector<double>{2, 20});
  CHECK(read_cloud(path, Eigen::Vector3d::Zero(), reading).points[1] ==
        Eigen::Vector3f(20, 30, 40));
  write_records(folder / "c.npy", read_records(path, reading));
  CHECK(read_text(folder / "c.npy").ends_with(body));
  check_says(message_of<UsageError>([&] { read_records(path, {"x y z"}); }),
             {"names 3 columns, but the array has 5"});
}

TEST_CASE("arrays may stand by columns, big-endian, in rows, of any version", "[numpy]") {
  const TemporaryFolder folder;
  const auto x_of = [&](const std::string& content) {
    return column(read_records(folder.write("a.npy", content)), "x");
  };
  const std::vector<double> expected = {1, 4};
  const std::vector<float> rows = {1, 2, 3, 4, 5, 6}, columns = {1, 4, 2, 5, 3, 6};
  for (const int version : {1, 2, 3}) {
    CHECK(x_of(npy("'<f4'", "(2, 3)", floats(rows), version)) == expected);
  }
  CHECK(x_of(npy("'<f4'", "(2, 3)", floats(columns), 1, "True")) == expected);
  CHECK(x_of(npy("'>i2'", "(2, 3)", std::string("\0\1\0\2\0\3\0\4\0\5\0\6", 12))) == expected);
  CHECK(x_of(npy("'|u1'", "(2L, 3)", std::string("\1\2\3\4\5\6"))) == expected);
  const PointRecords organised =
      read_records(folder.write("a.npy", npy("'<f4'", "(2, 1, 3)", floats(rows))));
  CHECK(organised.width == 1);
  CHECK(organised.height == 2);
}

TEST_CASE("arrays of fields have their places, types and padding", "[numpy]") {
  const TemporaryFolder folder;
  const std::string descr =
      "[('x', '>f8'), ('', '|V4'), (('Title', 'y'), '<f4'), ('z', '<f4'), ('_', '<u2', (2,)), "
      "('in', [('a', '|b1'), ('b', '<M8[ns]')]), ('name', '|S3'), ('q\\'\\xe9', '<i4', (1, 2))]";
  const std::string row = std::string("\x3F\xF0\0\0\0\0\0\0", 8) + "pad!" + floats({2, 3}) +
                          bytes_of<std::uint16_t>({7, 8}) + "\x01" +
                          bytes_of<std::int64_t>({1LL << 60}) + "abc" +
                          bytes_of<std::int32_t>({-1, -2});
  const PointRecords records = read_records(folder.write("a.npy", npy(descr, "(1,)", row)));
  CHECK(field_texts(records.layout) ==
        std::vector<std::string>{"float64 x", "float32 y", "float32 z", "uint16[2] _", "uint8 in.a",
                                 "int64 in.b", "uint8[3] name", "int32[2] q'\xC3\xA9"});
  CHECK(column(records, "x") == std::vector<double>{1});
  CHECK(column(records, "_") == std::vector<double>{7, 8});
  CHECK(column(records, "in.b") == std::vector<double>{0x1p60});
  write_records(folder / "b.npy", records);
  CHECK(read_records(folder / "b.npy").layout == records.layout);
  CHECK(read_records(folder / "b.npy").bytes == records.bytes);
  check_says(read_text(folder / "b.npy"), {"('', '|V4')", "\x93NUMPY\x03"});
  // A field of the name that PCD has for padding gets another one there.
  write_records(folder / "b.pcd", records);
  CHECK(column(read_records(folder / "b.pcd"), "__1") == std::vector<double>{7, 8});
}

TEST_CASE("what is no array of points is named", "[numpy]") {
  const std::string body = floats({1, 2, 3, 4});
  check_says(npy_error("NUMPY"), {"is not a .npy file"});
  check_says(npy_error(npy("'<f4'", "(1, 4)", body, 4)), {"version 4"});
  check_says(npy_error(kTwoPoints.substr(0, 40)), {"its head has", "truncated"});
  check_says(npy_error(kTwoPoints.substr(0, kTwoPoints.size() - 1)),
             {"2 x 4, 16 bytes a point, but 31 bytes follow", "truncated"});
  check_says(npy_error(kTwoPoints + "x"), {"33 bytes follow", "only one is read"});
  for (const char* shape : {"()", "(4,)", "(2, 2)", "(1, 4097)", "(1, 1, 1, 4)"}) {
    check_says(npy_error(npy("'<f4'", shape, body)), {"expected N x 3 numbers"});
  }
  check_says(npy_error(npy("'<f4'", "(4294967295, 4294967295, 4)", body)), {"truncated"});
  check_says(npy_error(npy("'<f4'", "(4294967296, 4)", body)), {"not a count"});
  check_says(npy_error(npy("'<f4'", "(-1, 4)", body)), {"is damaged at its column"});
  for (const char* type : {"'|O'", "'<f2'", "'<f16'", "'<x4'", "'<f'", "''", "'<i3'"}) {
    check_says(npy_error(npy(type, "(1, 4)", body)), {"which is not read", "expected numbers"});
  }
  check_says(npy_error(npy("[('x', '|O')]", "(1,)", body)), {"'x' has the type '|O'"});
  check_says(npy_error(npy("[('x', '<f4')]", "(4,)", body)), {"no field 'y'"});
  check_says(npy_error(npy("[]", "(0,)", "")), {"no bytes"});
  check_says(npy_error(npy("[('x', '<f4', (70000,))]", "(1,)", body)), {"more than 65,536 values"});
  check_says(npy_error(npy("[('x', '<f8', (65536,)), ('y', '<f8', (65536,)), ('z', '<f8')]", "(1,)",
                           body)),
             {"more than 1 MiB"});
  check_says(npy_error(npy("[('a', [('x', '<f4')], (2,))]", "(1,)", body)), {"repeats a group"});
  check_says(npy_error(npy("'<f4'", "(1, 4), 'a': " + std::string(5000, '['), body, 2)),
             {"is damaged at its column"});
  check_says(npy_error(npy("__import__('os')", "(1, 4)", body)), {"is damaged at its column"});
  check_says(npy_error(npy("'<f4", "(1, 4)", body)), {"head of the array is damaged"});
}

TEST_CASE("an archive gives its only array, or the one of a usual name", "[numpy]") {
  const TemporaryFolder folder;
  const auto size_of = [&](const std::vector<ZipFile>& files, bool zip64 = false) {
    return read_records(folder.write("a.npz", zip_of(files, zip64))).size();
  };
  const std::string none = npy("'<f4'", "(0, 3)", "");
  CHECK(size_of({{"_.npy", kTwoPoints}}) == 2);
  CHECK(size_of({{"_.npy", kTwoPoints, true}}) == 2);
  CHECK(size_of({{"a.npy", none}, {"points.npy", kTwoPoints, true}, {"b.txt", ""}}) == 2);
  CHECK(size_of({{"a.npy", none}, {"arr_0.npy", kTwoPoints}}) == 2);
  CHECK(size_of({{"a.npy", kTwoPoints, true, true}}, true) == 2);
  CHECK(read_cloud(folder.write("a.npz", zip_of({{"a.npy", kTwoPoints}}))).intensity ==
        std::vector<float>{4, 8});
  check_says(npy_error(zip_of({{"a.npy", none}, {"b.npy", none}}), "a.npz"),
             {"holds the arrays a, b", "points or arr_0"});
  check_says(npy_error(zip_of({{"a.txt", "x"}}), "a.npz"), {"holds no array"});
  check_says(npy_error(zip_of({}), "a.npz"), {"holds no array"});
  check_says(npy_error(zip_of({{"a.npy", "x"}}), "a.npz"), {"a.npz: a: is not a .npy file"});
}

TEST_CASE("cuts and flipped bytes of an archive give points or a DataError", "[numpy]") {
  for (const std::string& good : {zip_of({{"a.npy", kTwoPoints, true}}),
                                  zip_of({{"a.npy", kTwoPoints, false, true}}, true)}) {
    read_cut_and_flipped("a.npz", good, 2, [](const std::filesystem::path& path) {
      const std::size_t points = read_records(path).size();
      CHECK(points == 2);
    });
  }
}

TEST_CASE("a member of an archive that is too large for its bytes is not unpacked", "[numpy]") {
  const std::string bomb = zip_of({{"a.npy", std::string(4 << 20, '\0'), true}});
  check_says(npy_error(bomb, "a.npz"),
             {"is not a .npy file"});  // 1,000 times and a MiB are allowed.
  std::string lies = zip_of({{"a.npy", kTwoPoints, true}});
  const std::size_t directory = lies.find("PK\x01\x02");
  lies.replace(directory + 24, 4, raw(0x7FFFFFFFU));
  check_says(npy_error(lies, "a.npz"), {"decompresses to more than", "1,000 times"});
}
