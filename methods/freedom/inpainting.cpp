// SPDX-License-Identifier: MIT
#include "methods/freedom/depth_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <queue>

namespace raymoval::freedom_method {
namespace {

constexpr double kNever = 1e6;

enum class State : std::uint8_t {
  kWall,     ///< The front never enters.
  kFar,      ///< Not reached yet.
  kBand,     ///< On the front.
  kReached,  ///< The front has passed.
};

/// A front that moves with speed 1 from the pixels it begins with (|grad T| = 1).
class Front {
 public:
  /// @param states one per pixel, in rows of `width`; edge pixels are walls
  Front(std::vector<State>& states, std::vector<double>& times, int width)
      : states_(states), times_(times), width_(width) {}

  /// Moves the front from the pixels of `edge` (in order) up to the time `limit`. `enter(pixel)` is
  /// called for each pixel when its time is known for the first time.
  template <class Enter>
  void move(const std::vector<int>& edge, double limit, Enter&& enter) {
    for (const int pixel : edge) {
      times_[at(pixel)] = 0.0;
      states_[at(pixel)] = State::kBand;
    }
    for (const int pixel : edge) pass(pixel, limit, enter);
    while (!band_.empty()) {
      const auto pixel = static_cast<int>(band_.top() & 0xFFFFFFFF);
      band_.pop();
      if (states_[at(pixel)] != State::kReached) pass(pixel, limit, enter);
    }
  }

 private:
  static std::size_t at(int pixel) { return static_cast<std::size_t>(pixel); }

  template <class Enter>
  void pass(int pixel, double limit, Enter&& enter) {
    states_[at(pixel)] = State::kReached;
    for (const int next : {pixel - width_, pixel - 1, pixel + width_, pixel + 1}) {
      State& state = states_[at(next)];
      if (state == State::kWall || state == State::kReached) continue;
      const double time = solve(next);
      if (state == State::kBand && time >= times_[at(next)]) continue;
      if (time > limit) continue;
      const bool is_new = state == State::kFar;
      state = State::kBand;
      times_[at(next)] = time;
      band_.push(entry(time, next));
      if (is_new) enter(next);
    }
  }

  /// The time at which the front arrives from the reached pixels around.
  [[nodiscard]] double solve(int pixel) const {
    const double upright = std::min(passed(pixel - width_), passed(pixel + width_));
    const double level = std::min(passed(pixel - 1), passed(pixel + 1));
    const double first = std::min(upright, level), second = std::max(upright, level);
    const double difference = second - first;
    if (difference >= 1.0) return first + 1.0;
    return 0.5 * (first + second + std::sqrt(2.0 - difference * difference));
  }
  [[nodiscard]] double passed(int pixel) const {
    return states_[at(pixel)] == State::kReached ? times_[at(pixel)] : kNever;
  }

  /// Orders pixels by time and then by number. Bits of positive numbers have the numbers' order.
  using Entry = std::uint64_t;
  static Entry entry(double time, int pixel) {
    return static_cast<Entry>(std::bit_cast<std::uint32_t>(static_cast<float>(time))) << 32 |
           static_cast<Entry>(pixel);
  }

  std::vector<State>& states_;
  std::vector<double>& times_;
  int width_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> band_;
};

/// Fills one image, which has a border of unknown pixels.
class Inpainting {
 public:
  Inpainting(const HoleImage& image, int radius)
      : frame_(radius + 1), width_(image.columns + 2 * frame_) {
    const auto size = static_cast<std::size_t>(width_ * (image.rows + 2 * frame_));
    values_.assign(size, 0);
    is_known_.assign(size, 0);
    times_.assign(size, kNever);
    is_image_.assign(size, 0);
    for_each_pixel(image, [&](std::size_t from, int to) {
      is_image_[at(to)] = 1;
      is_known_[at(to)] = image.is_hole[from] == 0 ? 1 : 0;
      if (is_known_[at(to)] != 0) values_[at(to)] = image.values[from];
    });
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        const double square = x * x + y * y;
        if (square == 0.0 || square > radius * radius) continue;
        near_.push_back({y * width_ + x, -x, -y, 1.0 / (square * std::sqrt(square))});
      }
    }
    find_edge();
  }

  void run(double radius) {
    // The distances of known pixels from the holes are negative, so that T has a gradient there.
    move_into(1, radius, [](int) {});
    for (std::size_t i = 0; i < times_.size(); ++i) {
      if (is_known_[i] != 0) times_[i] = -std::min(times_[i], radius);
    }
    move_into(0, kNever, [this](int pixel) { fill(pixel); });
  }

  void write(HoleImage& image) const {
    for_each_pixel(image, [&](std::size_t to, int from) { image.values[to] = values_[at(from)]; });
  }

 private:
  /// A pixel within the radius.
  struct Near {
    int offset;
    int x, y;        ///< The offset from it, pixels.
    double inverse;  ///< One over the third power of the distance.
  };

  static std::size_t at(int pixel) { return static_cast<std::size_t>(pixel); }

  template <class Visit>
  void for_each_pixel(const HoleImage& image, Visit&& visit) const {
    for (int row = 0; row < image.rows; ++row) {
      for (int column = 0; column < image.columns; ++column) {
        visit(static_cast<std::size_t>(row * image.columns + column),
              (row + frame_) * width_ + column + frame_);
      }
    }
  }

  /// The known pixels beside holes.
  void find_edge() {
    for (int pixel = 0; pixel < static_cast<int>(is_image_.size()); ++pixel) {
      if (is_known_[at(pixel)] == 0) continue;
      for (const int next : {pixel - width_, pixel - 1, pixel + width_, pixel + 1}) {
        if (is_image_[at(next)] == 0 || is_known_[at(next)] != 0) continue;
        edge_.push_back(pixel);
        break;
      }
    }
  }

  /// Moves a front from the edge into known (1) or unknown (0) pixels.
  template <class Enter>
  void move_into(int known, double limit, Enter&& enter) {
    std::vector<State> states(is_image_.size(), State::kWall);
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (is_image_[i] != 0 && is_known_[i] == known) states[i] = State::kFar;
    }
    Front front(states, times_, width_);
    front.move(edge_, limit, enter);
  }

  /// The difference of `field` across a pixel, from its sides for which `is_there` is true.
  template <class Field, class IsThere>
  [[nodiscard]] static double slope(const Field& field, int pixel, int step, double central,
                                    IsThere&& is_there) {
    const bool before = is_there(pixel - step), after = is_there(pixel + step);
    const auto value = [&](int of) { return static_cast<double>(field[at(of)]); };
    if (before && after) return central * (value(pixel + step) - value(pixel - step));
    if (after) return value(pixel + step) - value(pixel);
    return before ? value(pixel) - value(pixel - step) : 0.0;
  }

  void fill(int pixel) {
    constexpr double kCentral = 2.0;  // OpenCV doubles instead of halving.
    const double time = times_[at(pixel)];
    const auto is_known = [this](int of) { return is_known_[at(of)] != 0; };
    const auto has_time = [&](int of) { return is_known(of) || is_image_[at(of)] == 0; };
    const double time_x = slope(times_, pixel, 1, 0.5, has_time);
    const double time_y = slope(times_, pixel, width_, 0.5, has_time);
    double weights = 0.0, sum = 0.0, rise_x = 0.0, rise_y = 0.0;
    for (const Near& near : near_) {
      const int from = pixel + near.offset;
      if (is_known_[at(from)] == 0) continue;
      const double along = std::abs(near.x * time_x + near.y * time_y);
      const double direction = along <= 0.01 ? 1e-6 : along;
      const double weight = direction * near.inverse / (1.0 + std::abs(times_[at(from)] - time));
      weights += weight;
      sum += weight * values_[at(from)];
      rise_x += weight * slope(values_, from, 1, kCentral, is_known) * near.x;
      rise_y += weight * slope(values_, from, width_, kCentral, is_known) * near.y;
    }
    const double rise = std::sqrt(rise_x * rise_x + rise_y * rise_y) + 1e-20;
    const double value = sum / weights - (rise_x + rise_y) / rise + 0.5;
    values_[at(pixel)] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    is_known_[at(pixel)] = 1;
  }

  int frame_, width_;
  std::vector<Near> near_;
  std::vector<std::uint8_t> values_, is_image_;
  std::vector<std::uint8_t> is_known_;  ///< Known from the beginning, or filled.
  std::vector<double> times_;           ///< T.
  std::vector<int> edge_;
};

}  // namespace

void inpaint(HoleImage& image, int radius) {
  Inpainting inpainting(image, radius);
  inpainting.run(radius);
  inpainting.write(image);
}

}  // namespace raymoval::freedom_method
