// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_writer.h"

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/replacements.h"
#include "datasets/clouds/cloud_file.h"
#include "tests/datasets/temporary_folder.h"

using namespace raymoval;
using test::TemporaryFolder;

namespace {

const std::vector<Eigen::Vector3f> kPoints = {{1, 2, 3}, {-4, 5.5F, 6}, {7, 8, -9e6F}};
const std::vector<float> kIntensity = {0.5F, 252.0F, -1.0F};

}  // namespace

TEST_CASE("A cloud written in pieces reads back as one, in every format", "[cloud]") {
  const TemporaryFolder folder;
  for (const std::string extension : {".pcd", ".ply", ".bin", ".npy"}) {
    const auto path = folder / ("map" + extension);
    CloudWriter writer(path);
    writer.start(true);
    writer.add({kPoints[0], kPoints[1]}, {kIntensity[0], kIntensity[1]});
    writer.add({}, {});
    writer.add({kPoints[2]}, {kIntensity[2]});
    writer.finish();
    CHECK_FALSE(std::filesystem::exists(path));
    writer.commit();
    CHECK(read_cloud(path).points == kPoints);
    CHECK(read_cloud(path).intensity == kIntensity);

    const auto whole = folder / ("whole" + extension);
    write_cloud(whole, kPoints, kIntensity);
    CHECK(read_text(whole) == read_text(path));
  }
}

TEST_CASE("A cloud gets its name with other files if that is asked for", "[cloud]") {
  const TemporaryFolder folder;
  Replacements together;
  CloudWriter writer(folder / "map.pcd");
  writer.start(false);
  writer.add(kPoints, {});
  writer.finish();
  writer.commit_with(together);
  CHECK_FALSE(std::filesystem::exists(folder / "map.pcd"));
  together.commit();
  CHECK(read_cloud(folder / "map.pcd").points == kPoints);
}

TEST_CASE("Missing intensities count as 0, or have no field", "[cloud]") {
  const TemporaryFolder folder;
  for (const bool with_intensity : {true, false}) {
    CloudWriter writer(folder / "map.ply");
    writer.start(with_intensity);
    writer.add(kPoints, {});
    writer.finish();
    writer.commit();
    const Cloud cloud = read_cloud(folder / "map.ply");
    CHECK(cloud.points == kPoints);
    CHECK(cloud.intensity == std::vector<float>(with_intensity ? 3 : 0, 0.0F));
  }
}

TEST_CASE("The head has the same length for any count of points", "[cloud]") {
  // 12 bytes a point: whatever is left beside them is the head.
  const TemporaryFolder folder;
  const auto head = [&](const char* name, std::size_t count) {
    write_cloud(folder / name, std::vector<Eigen::Vector3f>(count, Eigen::Vector3f::Zero()));
    CHECK(read_cloud(folder / name).points.size() == count);
    return std::filesystem::file_size(folder / name) - 12 * count;
  };
  CHECK(head("a.pcd", 0) == head("b.pcd", 12345));
  CHECK(head("a.ply", 9) == head("b.ply", 10));
}

TEST_CASE("An unknown format is refused before anything is made", "[cloud]") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(CloudWriter(folder / "map.xyz"), UsageError);
  CHECK_THROWS_AS(CloudWriter(folder / "no/map.pcd"), DataError);
  CHECK(std::filesystem::is_empty(folder.text()));
}
