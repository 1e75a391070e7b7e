// SPDX-License-Identifier: MIT
#include "datasets/clouds/cloud_writer.h"

#include <cstring>

#include "core/error.h"

namespace raymoval {

void check_coordinates(const std::filesystem::path& path, Coordinates coordinates) {
  if (coordinates == Coordinates::kFloat || path.extension() != ".bin") return;
  throw UsageError(path.string() +
                   ": a .bin file holds float32 numbers only, which lose more than a millimetre "
                   "more than 8 km from the world's origin, where this map lies. Name a .pcd or "
                   ".ply file, which then holds float64, or shift the poses.");
}

void CloudWriter::start(bool with_intensity, Coordinates coordinates) {
  check_coordinates(file_.path(), coordinates);
  coordinates_ = coordinates;
  with_intensity_ = with_intensity || file_.path().extension() == ".bin";
  RecordLayout layout;
  for (const char* axis : {"x", "y", "z"}) {
    layout.add(axis, 'F', coordinates == Coordinates::kDouble ? 8 : 4);
  }
  if (with_intensity_) layout.add("intensity", 'F', 4);
  file_.start(layout);
  rows_.layout = layout;
}

template <class Point>
void CloudWriter::add_points(const std::vector<Point>& points,
                             const std::vector<float>& intensity) {
  if (!intensity.empty() && intensity.size() != points.size()) {
    throw InternalError("a cloud of " + std::to_string(points.size()) + " points has " +
                        std::to_string(intensity.size()) + " intensities");
  }
  rows_.width = points.size();
  rows_.bytes.resize(points.size() * rows_.layout.row_bytes);
  std::byte* to = rows_.bytes.data();
  const auto put = [&](auto number) {
    std::memcpy(to, &number, sizeof number);
    to += sizeof number;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const auto coordinate : points[i]) {
      if (coordinates_ == Coordinates::kDouble) {
        put(static_cast<double>(coordinate));
      } else {
        put(static_cast<float>(coordinate));
      }
    }
    if (with_intensity_) put(intensity.empty() ? 0.0F : intensity[i]);
  }
  file_.add(rows_);
}

void CloudWriter::add_exact(const std::vector<Eigen::Vector3d>& points,
                            const std::vector<float>& intensity) {
  add_points(points, intensity);
}

void CloudWriter::add(const std::vector<Eigen::Vector3f>& points,
                      const std::vector<float>& intensity) {
  add_points(points, intensity);
}

void write_cloud(const std::filesystem::path& path, const std::vector<Eigen::Vector3f>& points,
                 const std::vector<float>& intensity) {
  CloudWriter file(path);
  file.start(!intensity.empty());
  file.add(points, intensity);
  file.finish();
  file.commit();
}

}  // namespace raymoval
