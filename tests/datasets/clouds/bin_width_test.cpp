// SPDX-License-Identifier: MIT
// Scans whose points do not have 4 numbers are distinguished from scans whose points have.
#include "datasets/clouds/cloud_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "datasets/open_sequence.h"
#include "datasets/simulation/scene/simulated.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using namespace raymoval::test;

namespace {

using Row = std::vector<float>;
using Rows = std::vector<Row>;

/// x y z intensity of a scan. The count is a multiple of 210, so that the size of the file fits
/// each checked width, for any true width.
Rows simulated_rows(const std::string& sensor) {
  SimulationOptions options;
  options.scene = "suburb";
  options.scans = 2;
  options.sensor = sensor;
  const Scan scan = make_simulated(options, 2)->load(1);
  Rows rows;
  for (std::size_t i = 0; i < scan.size() / 210 * 210; ++i) {
    const Eigen::Vector3f& p = scan.points[i];
    rows.push_back({p.x(), p.y(), p.z(), scan.reflectance[i]});
  }
  REQUIRE(rows.size() >= 630);
  return rows;
}

std::string content(const Rows& rows) {
  Row all;
  for (const Row& row : rows) all.insert(all.end(), row.begin(), row.end());
  return floats(all);
}

template <class Change>
Rows changed(Rows rows, Change&& change) {
  for (std::size_t i = 0; i < rows.size(); ++i) change(rows[i], i);
  return rows;
}

/// With whole-number intensities and more fields behind them, as nuScenes and others have it.
Rows widened(const Rows& rows, std::size_t width) {
  return changed(rows, [&](Row& row, std::size_t i) {
    row[3] = std::round(255.0F * row[3]);
    const auto ring = static_cast<float>(i % 32), time = 1e-6F * static_cast<float>(i);
    for (const float value : {ring, time, 0.0F}) row.push_back(value);
    row.resize(width);
  });
}

Rows shuffled(Rows rows) {
  std::mt19937 random(7);
  std::shuffle(rows.begin(), rows.end(), random);
  return rows;
}

void check_refused(const Rows& rows, std::size_t width) {
  const TemporaryFolder folder;
  const auto path = folder.write("0.bin", content(rows));
  CHECK_THROWS_WITH(check_bin_width({path}, {}),
                    Catch::Contains("0.bin") && Catch::Contains("--point-layout") &&
                        Catch::Contains(std::to_string(width) + " float32 numbers each"));
  CHECK_NOTHROW(check_bin_width({path}, {"x y z intensity"}));
}

void check_accepted(const Rows& rows) {
  const TemporaryFolder folder;
  CHECK_NOTHROW(check_bin_width({folder.write("0.bin", content(rows))}, {}));
}

/// What scans of 4 numbers may look like.
std::vector<Rows> forms_of(const Rows& rows) {
  std::vector<Rows> forms = {rows, shuffled(rows)};
  forms.push_back(rows);
  std::sort(forms.back().begin(), forms.back().end());  // In the order of a map.
  forms.push_back(changed(rows, [](Row& row, std::size_t) { row[3] = std::round(255 * row[3]); }));
  forms.push_back(changed(rows, [](Row& row, std::size_t) { row[3] = 0.0F; }));
  forms.push_back(changed(rows, [](Row& row, std::size_t i) { row[3] = float(i % 32); }));
  forms.push_back(changed(rows, [](Row& row, std::size_t) {
    for (float& value : row) value = std::round(value);
  }));
  forms.push_back(changed(rows, [](Row& row, std::size_t i) {
    if (i * 7919 % 10 < 7) row = {0, 0, 0, 0};  // No return.
  }));
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  forms.push_back(changed(rows, [](Row& row, std::size_t i) {
    if (i % 3 != 0) row = {kNone, kNone, kNone, 0};
  }));
  forms.push_back(changed(rows, [](Row& row, std::size_t) {
    row[0] += 691000.0F;  // Points of the world.
    row[1] += 5336000.0F;
  }));
  return forms;
}

}  // namespace

TEST_CASE("scans of 3, 5, 6 or 7 numbers a point are not read as scans of 4", "[bin]") {
  for (const std::string& sensor : simulated_sensor_names()) {
    const Rows rows = simulated_rows(sensor);
    for (const std::size_t width : {3, 5, 6, 7}) {
      INFO(sensor << ", " << width);
      check_refused(widened(rows, width), width);
      check_refused(shuffled(widened(rows, width)), width);
    }
    check_refused(changed(rows, [](Row& row, std::size_t) { row.push_back(0.0F); }), 5);
  }
}

TEST_CASE("no scan of 4 numbers a point is refused, whatever it looks like", "[bin]") {
  for (const std::string& sensor : simulated_sensor_names()) {
    const std::vector<Rows> forms = forms_of(simulated_rows(sensor));
    for (std::size_t k = 0; k < forms.size(); ++k) {
      INFO(sensor << ", form " << k);
      check_accepted(forms[k]);
    }
  }
}

TEST_CASE("all scans have to be of another width, and of a size that fits it", "[bin]") {
  const Rows four = simulated_rows("vlp16"), five = widened(four, 5);
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> scans;
  for (int i = 0; i < 5; ++i) {
    scans.push_back(folder.write(std::to_string(i) + ".bin", content(five)));
  }
  CHECK_THROWS_WITH(check_bin_width(scans, {}), Catch::Contains("5 float32"));
  scans.push_back(folder.write("9.pcd", "no .bin scan"));
  CHECK_THROWS_WITH(check_bin_width(scans, {}), Catch::Contains("5 float32"));
  folder.write("2.bin", content(four));
  CHECK_NOTHROW(check_bin_width(scans, {}));
  folder.write("2.bin", content(five) + floats({1, 2, 3, 4}));
  CHECK_NOTHROW(check_bin_width(scans, {}));
}

TEST_CASE("a sequence of 5 numbers a point asks for the point layout", "[bin]") {
  const std::string scan = content(widened(simulated_rows("hdl32e"), 5));
  const TemporaryFolder plain, kitti;
  plain.write("000000.bin", scan);
  plain.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  kitti.write("velodyne/000000.bin", scan);
  kitti.write("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  kitti.write("sequence.json", R"({"poses_are_lidar": true})");
  for (const std::string& folder : {plain.text(), kitti.text()}) {
    INFO(folder);
    CHECK_THROWS_WITH(open_sequence(folder, {}), Catch::Contains("--point-layout"));
    SequenceOptions options;
    options.point_layout = "x y z intensity ring";
    CHECK(open_sequence(folder, options).scans->load(0).stored_point_count * 20 == scan.size());
  }
}
