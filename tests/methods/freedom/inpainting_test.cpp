// SPDX-License-Identifier: MIT
#include "methods/freedom/depth_image.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace raymoval::freedom_test {
using namespace raymoval::freedom_method;

namespace {

template <class Value>
HoleImage image_of(int rows, int columns, Value&& value) {
  HoleImage image{rows, columns, {}, {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      image.values.push_back(static_cast<std::uint8_t>(value(row, column)));
      image.is_hole.push_back(0);
    }
  }
  return image;
}

void dig(HoleImage& image, int row_from, int row_to, int column_from, int column_to) {
  for (int row = row_from; row <= row_to; ++row) {
    for (int column = column_from; column <= column_to; ++column) {
      const auto pixel = static_cast<std::size_t>(row * image.columns + column);
      image.is_hole[pixel] = 1;
      image.values[pixel] = 255;
    }
  }
}

/// Telea's algorithm as in OpenCV, in its simplest form: each step searches all pixels for the
/// pixel that the front reaches next.
class SlowInpainting {
 public:
  SlowInpainting(const HoleImage& image, int radius)
      : rows_(image.rows), columns_(image.columns), radius_(radius), hole_(image.is_hole) {
    known_.assign(hole_.size(), 0);
    for (std::size_t i = 0; i < hole_.size(); ++i) {
      known_[i] = hole_[i] == 0 ? 1 : 0;
      values_.push_back(known_[i] != 0 ? image.values[i] : 0);
    }
  }

  std::vector<std::uint8_t> run() {
    move(false, radius_);
    outside_ = times_;
    for (double& time : outside_) time = -std::min<double>(time, radius_);
    move(true, 1e6);
    return values_;
  }

 private:
  [[nodiscard]] bool inside(int row, int column) const {
    return row >= 0 && row < rows_ && column >= 0 && column < columns_;
  }
  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }
  [[nodiscard]] bool is_edge(int row, int column) const {
    if (hole_[at(row, column)] != 0) return false;
    for (const auto& [y, x] : {std::pair{-1, 0}, {0, -1}, {1, 0}, {0, 1}}) {
      if (inside(row + y, column + x) && hole_[at(row + y, column + x)] != 0) return true;
    }
    return false;
  }
  [[nodiscard]] double passed(int row, int column) const {
    return inside(row, column) && done_[at(row, column)] != 0 ? times_[at(row, column)] : 1e6;
  }
  [[nodiscard]] double solve(int row, int column) const {
    double best = 1e6;
    for (const int y : {-1, 1}) {
      for (const int x : {-1, 1}) {
        const double a = passed(row + y, column), b = passed(row, column + x);
        const double both = std::abs(a - b) < 1.0
                                ? 0.5 * (a + b + std::sqrt(2.0 - (a - b) * (a - b)))
                                : std::min(a, b) + 1.0;
        best = std::min(best, both);
      }
    }
    return best;
  }
  void move(bool into_holes, double limit) {
    times_.assign(hole_.size(), 1e6);
    done_.assign(hole_.size(), 0);
    std::vector<std::uint8_t> band(hole_.size(), 0);
    for (int i = 0; i < rows_ * columns_; ++i) {
      if (!is_edge(i / columns_, i % columns_)) continue;
      times_[static_cast<std::size_t>(i)] = 0.0;
      band[static_cast<std::size_t>(i)] = 1;
    }
    for (;;) {
      std::size_t next = hole_.size();
      for (std::size_t i = 0; i < hole_.size(); ++i) {
        if (band[i] != 0 && (next == hole_.size() ||
                             static_cast<float>(times_[i]) < static_cast<float>(times_[next])))
          next = i;
      }
      if (next == hole_.size()) return;
      band[next] = 0;
      done_[next] = 1;
      const int row = static_cast<int>(next) / columns_, column = static_cast<int>(next) % columns_;
      for (const auto& [y, x] : {std::pair{-1, 0}, {0, -1}, {1, 0}, {0, 1}}) {
        if (!inside(row + y, column + x)) continue;
        const std::size_t to = at(row + y, column + x);
        if (done_[to] != 0 || (hole_[to] != 0) != into_holes) continue;
        const double time = solve(row + y, column + x);
        if (time > limit) continue;
        times_[to] = std::min(times_[to], time);
        if (band[to] == 0 && into_holes) fill(row + y, column + x);
        band[to] = 1;
      }
    }
  }
  /// T; OpenCV has a margin around the image that is very far and known.
  [[nodiscard]] double time_at(int row, int column) const {
    if (!inside(row, column)) return 1e6;
    return hole_[at(row, column)] != 0 ? times_[at(row, column)] : outside_[at(row, column)];
  }
  /// A difference over (y, x) between neighbours that count, times `both` if there are two.
  template <class Counts, class Of>
  [[nodiscard]] static double slope(int row, int column, int y, int x, double both, Counts&& counts,
                                    Of&& of) {
    const bool before = counts(row - y, column - x), after = counts(row + y, column + x);
    if (before && after) return both * (of(row + y, column + x) - of(row - y, column - x));
    if (after) return of(row + y, column + x) - of(row, column);
    return before ? of(row, column) - of(row - y, column - x) : 0.0;
  }
  void fill(int row, int column) {
    const auto time = [&](int r, int c) { return time_at(r, c); };
    const auto grey = [&](int r, int c) { return static_cast<double>(values_[at(r, c)]); };
    const auto is_known = [&](int r, int c) { return inside(r, c) && known_[at(r, c)] != 0; };
    const auto has_time = [&](int r, int c) { return !inside(r, c) || known_[at(r, c)] != 0; };
    const double time_y = slope(row, column, 1, 0, 0.5, has_time, time);
    const double time_x = slope(row, column, 0, 1, 0.5, has_time, time);
    double weights = 0.0, greys = 0.0, rise_x = 0.0, rise_y = 0.0;
    for (int r = row - radius_; r <= row + radius_; ++r) {
      for (int c = column - radius_; c <= column + radius_; ++c) {
        if (!is_known(r, c)) continue;
        const double y = row - r, x = column - c, length = std::hypot(x, y);
        if (length > radius_ || length == 0.0) continue;
        double direction = std::abs(x * time_x + y * time_y);
        if (direction <= 0.01) direction = 1e-6;
        const double weight = direction / std::pow(length, 3) /
                              (1.0 + std::abs(time_at(r, c) - time_at(row, column)));
        greys += weight * grey(r, c);
        rise_x += weight * x * slope(r, c, 0, 1, 2.0, is_known, grey);
        rise_y += weight * y * slope(r, c, 1, 0, 2.0, is_known, grey);
        weights += weight;
      }
    }
    // Against the gradient by at most the root of 2, and half a level up, apart from rounding.
    double value = greys / weights + 0.5;
    if (const double length = std::hypot(rise_x, rise_y); length > 0.0) {
      value -= rise_x / length + rise_y / length;
    }
    values_[at(row, column)] =
        static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    known_[at(row, column)] = 1;
  }

  int rows_, columns_, radius_;
  std::vector<std::uint8_t> hole_, known_, values_, done_;
  std::vector<double> times_, outside_;
};

}  // namespace

TEST_CASE("freedom: where nothing is known, nothing is filled in") {
  HoleImage image = image_of(4, 5, [](int, int) { return 9; });
  dig(image, 0, 3, 0, 4);
  inpaint(image, 3);
  CHECK(std::count(image.values.begin(), image.values.end(), 0) == 20);
}

TEST_CASE("freedom: the fast inpainting gives what OpenCV does") {
  std::mt19937 random(3);
  for (int trial = 0; trial < 16; ++trial) {
    const int radius = 1 + trial % 4;
    HoleImage image = image_of(9, 14, [&](int row, int column) {
      return 60 + 4 * row + 6 * column + static_cast<int>(random() % 9);
    });
    for (int hole = 0; hole < 5; ++hole) {
      const int row = static_cast<int>(random() % 8), column = static_cast<int>(random() % 12);
      dig(image, row, std::min(8, row + static_cast<int>(random() % 4)), column,
          std::min(13, column + static_cast<int>(random() % 5)));
    }
    const std::vector<std::uint8_t> expected = SlowInpainting(image, radius).run();
    inpaint(image, radius);
    int largest = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      largest = std::max(largest, std::abs(expected[i] - image.values[i]));
    }
    CAPTURE(trial, radius);
    CHECK(largest <= 1);  // Sums in another order may round otherwise.
  }
}

}  // namespace raymoval::freedom_test
