// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/scan/scan.h"
#include "core/scan/sensor_model.h"
#include "methods/raymoval_plus/common/parameters.h"
#include "methods/raymoval_plus/evidence/seen_through.h"
#include "methods/raymoval_plus/evidence/sight_kernels.h"

namespace raymoval::raymoval_plus_method {

/// What one scan says of a place.
enum class Observation : std::uint8_t { kUnknown, kAgree, kOccluded, kFree };

/// A place that a scan agrees with or sees through.
struct ObservedPlace {
  std::uint32_t place;  ///< Its number among those that were asked about.
  Observation observation;
  float range;               ///< Metres from the sensor.
  std::int32_t column, row;  ///< Of its bin; the row may lie beyond the image.
};

/// Whether a sensor looks in beams that are about evenly spaced. A rosette, which has neither beams
/// nor columns, leaves gaps anywhere; such a sensor has the same step both ways.
bool has_even_beams(const SensorModel& sensor);

/// Step 3: the nearest and the farthest return of a scan in each direction, about one beam to a
/// bin, and the three-way test of a place against the bins around it.
class RangeImage {
 public:
  RangeImage(const SensorModel& sensor, const Parameters& parameters);

  /// The number of bins. It is at most about four million, whatever the sensor's steps are.
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(image_.rows) * static_cast<std::size_t>(image_.columns);
  }

  /// Replaces the image with that of `scan`.
  void fill(const Scan& scan);
  /// What the scan says of a place of the sensor frame (metres). It **agrees** if any return of the
  /// window lies at the place's range. Else the place is **occluded** if any return is nearer and
  /// its own column of bins is no gap beside that, else **free** if there is a return at or below
  /// it, else **unknown**. So any agreement saves a place, and any occlusion says nothing. Near by,
  /// of what stands, only returns at the place's own height have a say, see `observe_at_height`.
  /// This looks at every bin of the window, which is slow: it is what the other `observe` is
  /// compared with.
  [[nodiscard]] Observation observe(const Eigen::Vector3f& place,
                                    SeenThrough seen = SeenThrough::kInRowOrBelow) const;
  /// Replaces `observed` with all places within the evidence range that the scan agrees with or
  /// sees through, in ascending order. Most places need no look at their window, so this is many
  /// times faster.
  /// @param places x y z, x y z, ... of any frame, metres, not far from its origin
  void observe(const std::vector<float>& places, const Pose& T_sensor_places, SeenThrough seen,
               std::vector<ObservedPlace>& observed) const;
  /// How the beams of the window of a place pass two heights there.
  struct Passing {
    bool between;        ///< Whether any passes between them.
    float below, above;  ///< If not, the heights of the next ones, or infinite.
  };
  /// Heights are metres above the sensor. Without even beams one passes between any, as far as is
  /// known.
  [[nodiscard]] Passing passing(const ObservedPlace& place, float low, float high) const;

 private:
  /// The range of a bin that has no return.
  static constexpr float kInfinite = std::numeric_limits<float>::infinity();
  struct Window {
    int wide, high;  ///< Half sizes, bins.
  };
  void choose_steps(const SensorModel& sensor);
  /// The place of a bin's two numbers in the arrays of `SightImage`.
  [[nodiscard]] std::size_t bin(int row, int column) const {
    return 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.stride()) +
                static_cast<std::size_t>(image_.margin + column));
  }
  /// A column up to a turn beyond either end, in the image.
  [[nodiscard]] int wrapped(int column) const {
    if (column < 0) return column + image_.columns;
    return column >= image_.columns ? column - image_.columns : column;
  }
  void fill_bins(const Scan& scan);
  [[nodiscard]] kernels::SightTest test() const;
  [[nodiscard]] Window window_at(float range) const;
  /// What returns at a place say, metres.
  struct Bounds {
    float range, agree;  ///< A return agrees if it is at most so far from the range of the place.
    float beyond;        ///< A nearer return hides the place.
    float from, to;      ///< No return before or beyond these agrees, and none beyond hides it.
  };
  [[nodiscard]] Bounds bounds_at(float range) const;
  /// What the window of a place says. @param row may lie beyond the image
  [[nodiscard]] Observation observe_every_bin(float range, int column, int row) const;
  /// The same for a place whose window is larger than the least one, by the least windows in it.
  [[nodiscard]] Observation observe_large_window(float range, int column, int row) const;
  /// Up to which range windows are larger than the least one, metres.
  [[nodiscard]] float near_range() const;
  /// Whether only returns at a place's own height have a say: near by, of what stands, and where
  /// some beam is sure to be at that height. Ground is asked for in the whole window, for it may
  /// slope.
  [[nodiscard]] bool is_asked_at_height(float range, SeenThrough seen) const {
    return has_even_beams_ && seen == SeenThrough::kInRowOrBelow && range <= near_range();
  }
  /// What the returns at a near place's own height say, and those before all that could agree,
  /// where any of its window agrees or hides it. That takes in what is lower as well: seen from
  /// above, the ground before a foot is as far away as the foot. Then only beams at that height see
  /// through the place.
  /// @param place metres, sensor frame
  [[nodiscard]] Observation observe_at_height(const Eigen::Vector3f& place, float range, int column,
                                              int row) const;
  /// Whether a return in these bins agrees. If not, notes whether any hides the place.
  bool agrees_in_row(const Bounds& bounds, int row, int column, int wide, bool& occluded) const;
  bool agrees_in_window(const Bounds& bounds, int row, int column, bool& occluded) const;
  [[nodiscard]] float nearest_in_row(int row, int column, int wide) const;
  /// What the kernels said of a place, where they are unsure after a look at its large window. Gaps
  /// are not looked for.
  [[nodiscard]] Observation observation_of(kernels::Sighted sighted, float range, int column,
                                           int row) const;
  /// Whether an occluded place is seen through in its own column of bins, beside what hides others
  /// of its window: all returns there are beyond a gap, and are not of a slope that the place
  /// itself is on. Or its own beams go on beyond it.
  /// @param place metres, sensor frame
  [[nodiscard]] bool sees_through_gap(const Eigen::Vector3f& place, SeenThrough seen, float range,
                                      int column, int row) const;
  /// Whether beams meet a place below the horizon that is less high than a bin, at its middle or
  /// lower, and go on beyond a gap. What is nearer in other rows ended other beams, which do not
  /// meet the place. A surface that beams graze is no such place: it is not half a voxel above the
  /// line between the returns of these beams and of the next below.
  [[nodiscard]] bool goes_on_beyond(const Eigen::Vector3f& place, float range, int column,
                                    int row) const;
  /// From what range on returns are beyond a gap at a place: `gap_margin` farther than those that
  /// do not hide it.
  [[nodiscard]] float beyond_gap(float range) const {
    return bounds_at(range).beyond + static_cast<float>(parameters_.gap_margin);
  }
  /// The sine of the least angle above the horizon of a bin's returns, or +infinity.
  [[nodiscard]] float lowest_at(int row, int column) const {
    return lowest_[static_cast<std::size_t>(row * image_.columns + column)];
  }
  /// The nearest return of some bins of a row.
  struct Return {
    int row;
    float range;  ///< Metres; infinite for none.
  };
  /// The first return in a column from a row on, up or down, if the next beam has one.
  [[nodiscard]] Return next_return(int row, int step, int column, int wide) const;
  /// Whether a place is on a plane that beams graze: the return of its column that passes it and
  /// the next one toward the horizon, which hides it, go on as a third one does. The inverse range
  /// of a plane is linear in the tangents of direction, so in a few rows.
  /// @param toward the horizon: 1 if that is up, else -1
  [[nodiscard]] bool is_on_slope(float range, int column, int row, int wide, int toward) const;
  /// A quick look at the place's own bin, which is false for most places that are not seen through.
  [[nodiscard]] bool may_be_gap(float range, int column, int row) const;
  /// Calls `stops` with the sines of the angles above the horizon of the returns in a window around
  /// a bin (infinite where there is none), until it returns true, and says whether it did.
  template <class Stops>
  bool any_beam(int column, int row, const Window& window, Stops&& stops) const;
  /// Whether a return of a window around a place is of a beam that does not pass above it.
  /// @param place metres, sensor frame
  [[nodiscard]] bool sees_at_or_below(const Eigen::Vector3f& place, float range, int column,
                                      int row, const Window& window) const;

  Parameters parameters_;
  kernels::SightKernels kernels_ = kernels::best_sight_kernels();
  kernels::SightGrid grid_;
  float azimuth_step_ = 0.0F, elevation_step_ = 0.0F;  ///< Size of a bin, radians.
  kernels::SightImage image_;
  bool has_even_beams_;
  float half_voxel_;                       ///< Metres.
  std::array<float, 2> agree_, occluded_;  ///< Metres at range 0, and for each metre of it.
  /// Returns of each bin, of `window_columns` around it, and of `window_rows` of these.
  std::vector<float> bins_, row_windows_, windows_;
  /// The direction of the world's z in the sensor frame, and the sine of the least angle above the
  /// horizon at which each bin has a return, row by row.
  Eigen::Vector3f up_ = Eigen::Vector3f::UnitZ();
  std::vector<float> lowest_;
};

}  // namespace raymoval::raymoval_plus_method
