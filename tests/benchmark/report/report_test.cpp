// SPDX-License-Identifier: MIT
#include <zlib.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/process/checked_sink.h"
#include "benchmark/report/html.h"
#include "benchmark/report/pack.h"
#include "benchmark/report/scene.h"
#include "benchmark/result/removals/reasons.h"
#include "core/error.h"
#include "core/utf8.h"
#include "tests/benchmark/small_world.h"

using namespace raymoval;
using Catch::Contains;

namespace {

ShownPoint at(int x, int y = 0, int z = 0, std::uint32_t scan = 0, std::uint16_t label = 40) {
  return {{x, y, z}, scan, label};
}

const std::vector<std::uint8_t> kNoVerdict;

std::string inflated(const std::string& packed, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf length = size;
  REQUIRE(::uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  bytes.resize(length);
  return bytes;
}

std::string from_printable(const std::string& text) {
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  const auto digit = [&](std::size_t i) {
    return text[i] == '!' ? 25U : static_cast<unsigned>(text[i] - '#');
  };
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const bool is_pair = i + 1 < text.size();
    bits |= (is_pair ? digit(i) + 91 * digit(i + 1) : digit(i)) << count;
    for (count += is_pair ? 13 : 6; count >= 8; count -= 8, bits >>= 8U) {
      bytes += static_cast<char>(bits & 0xFFU);
    }
  }
  return bytes;
}

/// Value `i` of a stream of folded differences, as the page's script reads it.
int value_of(const std::string& bytes, std::size_t offset, std::size_t count, std::size_t i) {
  int value = 0;
  for (std::size_t k = 0; k <= i; ++k) {
    const int folded = static_cast<unsigned char>(bytes[offset + k]) |
                       static_cast<unsigned char>(bytes[offset + count + k]) << 8;
    value = (value + ((folded & 1) != 0 ? -((folded + 1) / 2) : folded / 2)) & 0xFFFF;
  }
  return value;
}

/// The labels of `TwoScans`: a static, a moving and an ignored point, then a moving one.
class FourLabels : public LabelSource {
 public:
  [[nodiscard]] std::vector<std::uint32_t> labels(const Scan& scan) const override {
    return scan.index == 0 ? std::vector<std::uint32_t>{40, 252, 0}
                           : std::vector<std::uint32_t>{252};
  }
};

Sequence two_scans() {
  Sequence sequence;
  sequence.name = "two";
  sequence.scans = std::make_shared<test::TwoScans>();
  sequence.labels = std::make_shared<FourLabels>();
  sequence.label_rule.ignored = {0};
  return sequence;
}

SceneCell cell_with(const std::string& name, const Mask& first, const Mask& second) {
  SceneCell cell;
  cell.name = name;
  cell.masks = MaskStore(2);
  cell.masks.set(0, first);
  cell.masks.set(1, second);
  return cell;
}

}  // namespace

TEST_CASE("without need every point stays", "[report]") {
  ReportPoints points(3, 0, 0);
  for (int i = 0; i < 3; ++i) points.add(at(0), 0, kNoVerdict);
  CHECK(points.size() == 3);
  CHECK(points.cell() == 0);
}

TEST_CASE("one point of a cell stays, the first", "[report]") {
  ReportPoints points(10, 1, 16);
  points.add(at(0), 0, std::vector<std::uint8_t>{7});
  points.add(at(15), 0, std::vector<std::uint8_t>{8});  // The same cell.
  points.add(at(16), 0, std::vector<std::uint8_t>{9});
  points.add(at(-1), 0, std::vector<std::uint8_t>{10});  // Left of the origin: another cell.
  points.add(at(1), 5, std::vector<std::uint8_t>{11});   // The same cell, another group.
  REQUIRE(points.size() == 4);
  CHECK(points.verdict(0)[0] == 7);
  CHECK(points.verdict(1)[0] == 9);
  CHECK(points.verdict(2)[0] == 10);
  CHECK(points.verdict(3)[0] == 11);
}

TEST_CASE("cells grow until the limit holds", "[report]") {
  ReportPoints points(100, 1, 0);
  for (int i = 0; i < 1000; ++i) {
    points.add(at(i), 0, std::vector<std::uint8_t>{static_cast<std::uint8_t>(i % 251)});
  }
  CHECK(points.size() <= 100);
  CHECK(points.size() > 50);
  CHECK(points.cell() >= 10);  // 1000 places in 100 cells.
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(points.verdict(i)[0] == points.points()[i].step[0] % 251);  // Bytes go with their points.
  }
}

TEST_CASE("more groups than the limit still end", "[report]") {
  ReportPoints points(10, 0, 0);
  for (std::uint64_t group = 0; group < 50; ++group) points.add(at(0), group, kNoVerdict);
  CHECK(points.size() == 10);
}

TEST_CASE("bytes of a page come back from its text, which cannot end its element", "[report]") {
  CHECK(printable("") == "");
  // 65 has eight bits: 65 in the first of two characters. The value 25 is not written as '<'.
  CHECK(printable("A") == "d#");
  CHECK(printable(std::string(1, 25)) == "!#");
  std::string bytes, all;
  for (int i = 0; i < 300; ++i) {
    bytes += static_cast<char>(i * i * 7 + i / 3);
    const std::string text = printable(bytes);
    CHECK(from_printable(text) == bytes);
    all += text;
  }
  CHECK(all.find('<') == std::string::npos);
  CHECK(std::ranges::all_of(all, [](char letter) { return letter > ' ' && letter < '~'; }));
}

TEST_CASE("text cannot leave its place in a page", "[report]") {
  CHECK(html_text("<b a=\"&\">") == "&lt;b a=&quot;&amp;&quot;&gt;");
  CHECK(script_json("</script><!--<script>") == "\"\\u003c/script>\\u003c!--\\u003cscript>\"");
  CHECK(id_text("raymoval:a b") == "raymoval-a-b");
  TextTable table{"<t>", "c", {{"<g>", {"<h>"}}}, {{"<r>", {{"<x>"}}, false}}, {"<n>"}};
  const std::string html = html_table(table);
  for (const char* raw : {"<t>", "<g>", "<h>", "<r>", "<x>", "<n>"}) {
    CHECK_THAT(html, !Contains(raw));
  }
}

TEST_CASE("a name is broken where its parts end", "[report]") {
  CHECK(html_name("raymoval_plus:offline") == "raymoval_<wbr>plus:<wbr>offline");
  CHECK(html_name("a<b:") == "a&lt;b:");
}

TEST_CASE("blocks of a table have a heading each", "[report]") {
  const TextTable table{"t",
                        "method",
                        {{"", {"PR"}}},
                        {{"x", {{"1"}}, false, "a&b"}, {"x", {{"2"}}, false, "c"}},
                        {}};
  const std::string html = html_table(table);
  CHECK_THAT(html,
             Contains("<tr class=\"block\"><th scope=\"rowgroup\" colspan=\"2\">a&amp;b</th>"));
  CHECK(html.find("<tbody>") != html.rfind("<tbody>"));
}

TEST_CASE("a table says what its cells are", "[report]") {
  TextTable table{"T", "method", {{"p", {"PR", "why"}}}, {}, {}};
  table.rows.push_back({"a", {{"1,234.5", Mark::kBest}, {"3 of them"}}, false});
  table.rows.push_back({"b", {{"n/a"}, {"so it is"}}, false});
  table.rows.push_back({"mean", {{"2", Mark::kSecond}, {""}}, true});
  const std::string html = html_table(table);
  CHECK_THAT(html, Contains("<caption>T</caption>"));
  CHECK_THAT(html, Contains("scope=\"colgroup\" class=\"group\" colspan=\"2\">p<"));
  CHECK_THAT(html, Contains("<th scope=\"row\">a</th><td class=\"number\"><strong>1,234.5<"));
  CHECK_THAT(html, Contains("<td>3 of them</td>"));  // One cell of its column is words.
  CHECK(html.find("<tfoot>") < html.find("mean"));
  CHECK_THAT(html, Contains("<u>2</u>"));
}

TEST_CASE("a scene has every point's verdict by every cell", "[report]") {
  // The first method removes the moving points, the second the static one.
  const Scene scene = build_scene(
      two_scans(), {cell_with("right", {0, 1, 0}, {1}), cell_with("wrong", {1, 0, 1}, {0})}, 1000,
      nullptr);
  CHECK(scene.points_in_range == 4);
  CHECK(scene.counts[0].kept_static == 1);
  CHECK(scene.counts[0].true_positive == 2);
  CHECK(scene.counts[0].false_positive + scene.counts[0].false_negative == 0);
  CHECK(scene.counts[1].false_positive == 1);
  CHECK(scene.counts[1].false_negative == 2);
  CHECK(scene.scans == std::vector<std::string>{"000007", "000008"});
  REQUIRE(scene.labels.size() == 3);
  CHECK(scene.labels[0].kind == LabelClass::kIgnored);
  CHECK(scene.labels[2].kind == LabelClass::kMoving);

  // Points at x = 1, 2 and 3 m of the first scan, x = 1 m of the second; along x in this order.
  const PackedScene packed = pack_scene(scene, 4);
  const auto head = nlohmann::json::parse(packed.head);
  REQUIRE(packed.streams.size() == 3);
  CHECK(packed.streams[0].first == "scene-4");
  CHECK(packed.streams[2].first == "scene-4-1");
  CHECK(head["points"] == 4);
  CHECK(head["origin"][0] == 5);  // 1 m in voxels of 0.2 m.
  const std::string bytes = inflated(from_printable(packed.streams[0].second), 9 * 4);
  REQUIRE(bytes.size() == 36);
  const std::string right = inflated(from_printable(packed.streams[1].second), 4);
  const std::string wrong = inflated(from_printable(packed.streams[2].second), 4);
  std::vector<std::string> found;
  for (std::size_t i = 0; i < 4; ++i) {
    found.push_back(std::to_string(value_of(bytes, 0, 4, i)) + " scan " +
                    std::to_string(value_of(bytes, 24, 4, i)) + " label " +
                    std::to_string(static_cast<int>(bytes[32 + i])) + " verdicts " +
                    std::to_string(static_cast<int>(right[i])) +
                    std::to_string(static_cast<int>(wrong[i])));
  }
  // A unit is two steps of 0.0125 m, so there are 40 in a metre.
  CHECK(found ==
        std::vector<std::string>{"0 scan 0 label 1 verdicts 01", "0 scan 1 label 2 verdicts 10",
                                 "40 scan 0 label 2 verdicts 10", "80 scan 0 label 0 verdicts 01"});
}

TEST_CASE("points are in chunks, each of which begins anew", "[report]") {
  Scene scene;
  scene.labels = {{40, "road", LabelClass::kStatic}};
  for (int i = 0; i < 16386; ++i) scene.points.push_back(at(2 * i));
  const std::string bytes =
      inflated(from_printable(pack_scene(scene, 0).streams[0].second), 9 * 16386);
  REQUIRE(bytes.size() == 9 * 16386);
  CHECK(value_of(bytes, 0, 16384, 16383) == 16383);
  CHECK(value_of(bytes, 9 * 16384, 2, 0) == 16384);
  CHECK(value_of(bytes, 9 * 16384, 2, 1) == 16385);
}

TEST_CASE("points beyond the range limits are not shown", "[report]") {
  Sequence sequence = two_scans();
  sequence.range_m = {1.5, 2.5};
  const Scene scene = build_scene(sequence, {cell_with("a", {0, 0, 0}, {0})}, 1000, nullptr);
  CHECK(scene.points_in_range == 1);
  CHECK(scene.points.size() == 1);
}

TEST_CASE("reasons go with their points, and are held to their contract", "[report]") {
  const test::TwoScans source;
  const TimedSource scans(source);
  CheckedReasons store("m", scans);
  CHECK_THROWS_WITH(store.accept(0, {0, 0, 0}), Contains("before their sentences"));
  store.explain({"so", "because"});
  CHECK_THROWS_WITH(store.explain({"so"}), Contains("twice"));
  CHECK_THROWS_WITH(store.accept(0, {0, 0}), Contains("expected one for each of the scan's 3"));
  CHECK_THROWS_WITH(store.accept(0, {0, 2, 0}), Contains("no sentence"));
  CHECK_THROWS_WITH(store.accept(2, {0}), Contains("only 2 scans"));
  store.accept(0, {0, 1, 0});
  CHECK(store.finish().codes[0] == std::vector<std::uint8_t>{0, 1, 0});
}

TEST_CASE("a scene tells reasons beside verdicts", "[report]") {
  const test::TwoScans source;
  const test::TemporaryFolder folder;
  Reasons reasons{{"so", "because"}, {{1, 0, 1}, {1}}};
  write_reasons(folder.path(), source, reasons);
  SceneCell cell = cell_with("m", {1, 0, 0}, {1});
  cell.removals = folder.path();
  cell.sentences = reasons.sentences;
  const Scene scene = build_scene(two_scans(), {cell}, 1000, nullptr);
  // By x, then scan: removed because (1 + 2 * 2), removed because, kept so (2), kept because.
  CHECK(scene.verdicts[0] == std::vector<std::uint8_t>{5, 5, 2, 4});
}
