// SPDX-License-Identifier: MIT
// The table of parameters says when each has an effect. Here it is held against what methods do: a
// parameter said to have none never changes a mask, one said to act does so for some value.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <optional>
#include <set>

#include "core/parameter_condition.h"
#include "tests/methods/moved_world.h"

using namespace raymoval;

namespace {

/// Parameters that act on data only that the scenes here do not have, and why.
const std::map<std::string, std::string> kNeedOtherData = {
    {"raymoval:online.group_gap", "clusters of one scan must stand a voxel apart"},
    {"raymoval_plus.track_width", "a wide cluster must move"},
    {"raymoval_plus:online.tracks", "the scans are too few to follow anything"},
    {"raymoval_plus:online.object_points", "a cluster of three points must be dynamic"},
    {"raymoval_plus:online.low_points", "something dynamic must reach the ground"},
    {"beautymap.public_top", "a column must be higher than 30 slices (see beautymap_test)"},
    {"hmm_mos.map_scans", "what moves must be out of sight for some scans (see oracle_test)"},
    {"hmm_mos.map_range_factor", "the sensor must go far away and come back (see oracle_test)"},
    {"hmm_mos.public_lattice", "something must move in the origin's planes (see steps_test)"},
    {"dynablox.temporal_buffer", "a voxel must be occupied for long, with breaks"},
    {"dynablox.separation", "clusters must be near each other (see dynablox/steps_test)"},
    {"dynablox.frames_to_reset", "something must stay where it was free"},
    {"dynablox.max_weight", "free space must have been occupied for a while (see field_test)"},
    {"raymoval_plus:online.recent_scans", "as for tracks"},
    {"freedom.counts_to_revert", "something must stay in free space (see free_map_test)"},
    {"mapcleaner.noise_reflectance", "points must have reflectance (see ground_segmentation_test)"},
    {"mapcleaner.public_height", "the sensor must be much lower (see ground_segmentation_test)"},
    {"mapcleaner.public_axes", "the sensor must turn"},
    {"mapcleaner.submap_travel", "the sensor must go farther (see votes_test)"},
    {"removert.clamp_fov", "the sensor must see beyond the images' field of view"},
};

bool needs_other_data(const ConfiguredMethod& method, const std::string& parameter) {
  return kNeedOtherData.count(method.entry->name + "." + parameter) > 0 ||
         kNeedOtherData.count(method.full_name() + "." + parameter) > 0;
}

/// A street with two movers: what is seen ahead of the sensor, and all around, which takes longer.
struct Scenes {
  toy::World ahead, around;
};
const Scenes& scenes() {
  static const Scenes made = [] {
    toy::Scanner scanner;
    scanner.azimuth_from = -60;
    scanner.azimuth_to = 60;
    return Scenes{toy::street(10, 7, scanner), toy::street(10)};
  }();
  return made;
}

double clamped(const ParameterSpec& spec, double value) {
  return std::clamp(value, spec.notes.minimum, spec.notes.maximum);
}

/// Values other than `present` to try, small changes first.
std::vector<ParameterValue> other_values(const ParameterSpec& spec, const ParameterValue& present) {
  std::vector<ParameterValue> values;
  const auto add = [&](const ParameterValue& value) {
    if (value != present && std::find(values.begin(), values.end(), value) == values.end()) {
      values.push_back(value);
    }
  };
  if (const bool* flag = std::get_if<bool>(&present)) add(!*flag);
  for (const std::string& choice : spec.choices) add(choice);
  if (const double* number = std::get_if<double>(&present)) {
    for (const double factor : {2.0, 0.5, 0.1, 10.0, 0.0}) add(clamped(spec, factor * *number));
    for (const double step : {0.1, 1.0, 10.0}) add(clamped(spec, *number + step));
  }
  if (const auto* whole = std::get_if<std::int64_t>(&present)) {
    const auto now = static_cast<double>(*whole);
    for (const double other : {2.0 * now, now + 1.0, now - 1.0, 0.0, 1.0, 5.0, 20.0, 10.0 * now}) {
      add(static_cast<std::int64_t>(clamped(spec, other)));
    }
  }
  return values;
}

/// Two values that are far from each other.
std::vector<ParameterValue> far_values(const ParameterSpec& spec, const ParameterValue& present) {
  std::vector<ParameterValue> values = other_values(spec, present);
  if (values.size() > 2) values = {values.front(), values.back()};
  return values;
}

/// A variant, and its answer with its configuration.
class Variant {
 public:
  explicit Variant(ConfiguredMethod configured) : method(std::move(configured)) {}

  /// Points judged otherwise if a parameter is set; nothing if the method refuses the value.
  std::optional<std::size_t> changed_by(const std::string& name, const ParameterValue& value,
                                        const toy::World& scene) {
    const MaskStore& before = answer(scene);
    ConfiguredMethod other = method;
    set_parameter(other.configuration, name, value);
    try {
      const MaskStore after = toy::masks_of(*other.make(), scene);
      return toy::different_verdicts(before, after, scene.size());
    } catch (const ConfigurationError&) {
      return std::nullopt;
    }
  }

  const ConfiguredMethod method;

 private:
  const MaskStore& answer(const toy::World& scene) {
    const auto found = answers_.find(&scene);
    if (found != answers_.end()) return found->second;
    return answers_.emplace(&scene, toy::masks_of(*method.make(), scene)).first->second;
  }

  std::map<const toy::World*, MaskStore> answers_;
};

/// A variant with directions as coarse as the scanner of the scene.
ConfiguredMethod configured(const std::string& name) {
  ConfiguredMethod method = MethodRegistry::built_in().configure(name);
  if (method.entry->name == "raymoval") {
    set_parameter(method.configuration, "azimuth_bins", std::int64_t{360});
    set_parameter(method.configuration, "elevation_bins", std::int64_t{44});
  }
  toy::coarsen_octomap(method);
  if (method.entry->name == "octomap") {  // Neighbours of outliers take most of the time.
    set_parameter(method.configuration, "noise_neighbours", std::int64_t{5});
  }
  if (method.entry->name == "dynablox") {  // The scanner leaves few points on anything.
    set_parameter(method.configuration, "min_points", std::int64_t{3});
  }
  if (method.entry->name == "hmm_mos") {  // The time mostly depends on the number of voxels.
    set_parameter(method.configuration, "voxel_size", 0.4);
  }
  return method;
}

void check_inert(Variant& variant, const ParameterSpec& spec, const ParameterValue& present) {
  for (const ParameterValue& value : far_values(spec, present)) {
    INFO("said to be without effect, set to " << parameter_text(value));
    // Refused is more than without effect.
    CHECK(variant.changed_by(spec.name, value, scenes().ahead).value_or(0) == 0);
  }
}

/// Whether some value changes what is removed, or is refused.
bool acts(Variant& variant, const ParameterSpec& spec, const ParameterValue& present) {
  const std::vector<ParameterValue> values = other_values(spec, present);
  for (const toy::World* scene : {&scenes().ahead, &scenes().around}) {
    for (const ParameterValue& value : values) {
      if (variant.changed_by(spec.name, value, *scene).value_or(1) > 0) return true;
    }
  }
  return false;
}

/// Variants of a method that have the same parameters acting need only one of them tested.
void check_variant(const std::string& name, std::set<std::string>& tested) {
  Variant variant(configured(name));
  const ConfiguredMethod& method = variant.method;
  const auto& specs = method.entry->parameters;
  std::string acting;
  for (const ParameterSpec& spec : specs) {
    if (has_effect(spec, method.configuration)) acting += spec.name + " ";
  }
  const bool is_new = tested.insert(acting).second;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const ParameterValue& present = method.configuration[i].second;
    INFO(name << "." << specs[i].name << " = " << parameter_text(present));
    if (!has_effect(specs[i], method.configuration)) {
      check_inert(variant, specs[i], present);
    } else if (is_new && !needs_other_data(method, specs[i].name)) {
      CHECK(acts(variant, specs[i], present));
    }
  }
}

void check_method(const std::string& name) {
  std::set<std::string> tested;
  for (const MethodVariant& variant : MethodRegistry::built_in().find(name).variants) {
    if (variant.is_available) check_variant(name + ":" + variant.name, tested);
  }
}

/// A parameter that conditions name, and a value for which they may be false.
struct TurnedOff {
  std::string name;
  ParameterValue value;
};
std::vector<TurnedOff> ways_to_turn_off(const ConfiguredMethod& method) {
  const auto& specs = method.entry->parameters;
  std::vector<TurnedOff> ways;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const bool is_named = std::any_of(specs.begin(), specs.end(), [&](const ParameterSpec& spec) {
      return (" " + spec.notes.acts_when).find(" " + specs[i].name + " ") != std::string::npos;
    });
    if (!is_named) continue;
    const ParameterValue& present = method.configuration[i].second;
    if (const bool* flag = std::get_if<bool>(&present)) {
      ways.push_back({specs[i].name, !*flag});
    } else if (std::holds_alternative<std::int64_t>(present)) {
      ways.push_back({specs[i].name, static_cast<std::int64_t>(clamped(specs[i], 0.0))});
    }
  }
  return ways;
}

/// Turns off what conditions name, one parameter or two at a time, and checks that what is then
/// said to be without effect is so.
/// @param tested what was tested with another variant, which is not tested again
void check_turned_off(const std::string& name, std::set<std::string>& tested) {
  const ConfiguredMethod method = configured(name);
  const std::vector<TurnedOff> ways = ways_to_turn_off(method);
  const auto without = [&](const TurnedOff& a, const TurnedOff& b) {
    ConfiguredMethod other = method;
    for (const TurnedOff* const way : {&a, &b}) {
      set_parameter(other.configuration, way->name, way->value);
    }
    return other;
  };
  const auto& specs = method.entry->parameters;
  for (std::size_t a = 0; a < ways.size(); ++a) {
    for (std::size_t b = a; b < ways.size(); ++b) {
      Variant variant(without(ways[a], ways[b]));
      const auto acts_with = [&](const ParameterSpec& spec, const TurnedOff& way) {
        return has_effect(spec, without(way, way).configuration);
      };
      for (std::size_t i = 0; i < specs.size(); ++i) {
        if (!has_effect(specs[i], method.configuration)) continue;
        if (has_effect(specs[i], variant.method.configuration)) continue;
        // One of the two suffices, and was tested alone.
        if (a != b && !(acts_with(specs[i], ways[a]) && acts_with(specs[i], ways[b]))) continue;
        if (!tested.insert(specs[i].name + " " + ways[a].name + " " + ways[b].name).second)
          continue;
        INFO(name << "." << specs[i].name << " without " << ways[a].name << ", " << ways[b].name);
        check_inert(variant, specs[i], variant.method.configuration[i].second);
      }
    }
  }
}

}  // namespace

TEST_CASE("raymoval_plus's parameters are without effect where their conditions do not hold",
          "[slow]") {
  std::set<std::string> tested;
  for (const char* const variant : {"offline", "online"}) {
    check_turned_off(std::string("raymoval_plus:") + variant, tested);
  }
  CHECK(tested.count("recent_scans tracks tracks") == 1);
  CHECK(tested.count("object_points objects objects") == 1);
}

TEST_CASE("raymoval_plus's parameters act when they are said to", "[slow]") {
  check_method("raymoval_plus");
}

TEST_CASE("parameters act when they are said to", "[slow]") {
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    if (entry->name != "raymoval_plus") check_method(entry->name);
  }
}

TEST_CASE("every condition names parameters of its method", "[slow]") {
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    for (const MethodVariant& variant : entry->variants) {
      const ConfiguredMethod method =
          MethodRegistry::built_in().configure(entry->name + ":" + variant.name);
      for (const ParameterSpec& spec : entry->parameters) {
        INFO(entry->name << "." << spec.name << ": " << spec.notes.acts_when);
        CHECK_NOTHROW(has_effect(spec, method.configuration));
        CHECK(spec.notes.acts_when.find(spec.name + " ") != 0);
      }
    }
  }
}
