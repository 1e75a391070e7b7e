// SPDX-License-Identifier: MIT
// Allowed effects of a change of the input on a method's answer: `claims` lists them for each
// variant, and small random worlds test them.
//
// The worlds are the same in every run. For a larger campaign, with a summary of changes:
//   RAYMOVAL_WORLDS=100 RAYMOVAL_SEED=7 build/release/test_methods '[properties]'
#include <fmt/format.h>
#include <rapidcheck.h>
#include <rapidcheck/detail/TestListenerAdapter.h>
#include <sstream>
#include <unordered_map>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <iostream>
#include <map>

#include "core/simd/instruction_set_scope.h"
#include "core/simd/instruction_sets.h"
#include "tests/methods/moved_world.h"
#include "tests/methods/properties/changes.h"
#include "tests/methods/properties/claims.h"

namespace raymoval::properties_test {
using toy::Claim;

namespace {

constexpr std::size_t kWorlds = 2;
/// In this many worlds, each allowed change must occur for some variant of the method; else a
/// stricter claim would hold.
constexpr std::size_t kEnoughWorlds = 60;
const std::string kLastLeftOut = "the last scans left out";

std::size_t from_environment(const char* name, std::size_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::stoul(text);
}

/// Seconds from a scan to its answer, for a method that waits so long: the worlds last for one.
constexpr double kDelay = 0.2;
/// Times are multiples of a tenth, which round.
constexpr double kRounding = 1e-9;

/// Delay of a method's answer to a scan, seconds; 0 for methods without such a parameter.
double answer_delay(const ConfiguredMethod& method) {
  for (const auto& [name, value] : method.configuration) {
    if (name == "delay") return std::get<double>(value);
  }
  return 0.0;
}

/// Images of removert with a fifth of the pixels along each side, and a map of 0.4 m.
void coarsen_removert(Configuration& configuration) {
  for (auto& [name, value] : configuration) {
    if (name.find("_resolution_") != std::string::npos) value = 0.2 * std::get<double>(value);
  }
  set_parameter(configuration, "map_voxel", 0.4);
}

/// A method of claims, with directions and cells as coarse as the sensor of the worlds, so that
/// points share them.
ConfiguredMethod configured(const std::string& variant) {
  ConfiguredMethod method = MethodRegistry::built_in().configure(variant);
  if (method.entry->name == "raymoval") {
    set_parameter(method.configuration, "azimuth_bins", std::int64_t{0});
    set_parameter(method.configuration, "elevation_bins", std::int64_t{0});
  }
  toy::coarsen_octomap(method);
  if (method.entry->name == "removert") coarsen_removert(method.configuration);
  if (method.entry->name == "hmm_mos") {  // Worlds are moved by whole numbers of 0.2 m.
    set_parameter(method.configuration, "voxel_size", 0.2);
  }
  if (answer_delay(method) > 0.0) set_parameter(method.configuration, "delay", kDelay);
  return method;
}

/// Verdicts that a change has changed.
struct Difference {
  std::size_t points = 0, lost = 0, gained = 0;  ///< Compared, no longer removed, now removed.
};

Difference difference(const MaskStore& before, const MaskStore& after,
                      const toy::ChangedWorld& changed) {
  std::vector<Mask> now;
  for (std::size_t i = 0; i < changed.scans.size(); ++i) now.push_back(after.get(i));
  Difference found;
  for (std::size_t i = 0; i < changed.now.size(); ++i) {
    const Mask was = before.get(i);
    for (std::size_t k = 0; k < was.size(); ++k) {
      const auto [scan, point] = changed.now[i][k];
      ++found.points;
      found.lost += was[k] > now[scan][point] ? 1 : 0;
      found.gained += was[k] < now[scan][point] ? 1 : 0;
    }
  }
  return found;
}

bool holds(Claim claim, const Difference& found) {
  switch (claim) {
    case Claim::kSame:
      return found.lost + found.gained == 0;
    case Claim::kRounding:
      return found.lost + found.gained <= found.points / 1000;
    case Claim::kMore:
      return found.lost == 0;
    case Claim::kFewer:
      return found.gained == 0;
    case Claim::kOpen:
      return true;
  }
  return false;
}

/// Leaves out scans whose answers came after the last remaining scan: a method with a delay answers
/// these with fewer scans than otherwise.
void compare_answered(const toy::HeldScans& world, double delay, toy::ChangedWorld& changed) {
  const double last = changed.scans.scans().back().time_s;
  while (!changed.now.empty() &&
         world.scans()[changed.now.size() - 1].time_s + delay > last + kRounding) {
    changed.now.pop_back();
  }
}

std::size_t parted_twins(const MaskStore& masks, const toy::ChangedWorld& changed) {
  std::size_t parted = 0;
  for (const auto& [a, b] : changed.twins) {
    parted += masks.get(a.scan)[a.point] != masks.get(b.scan)[b.point] ? 1 : 0;
  }
  return parted;
}

/// Results of a variant in the worlds up to now.
struct Findings {
  std::size_t removed = 0;
  std::map<std::string, int> changed_worlds;  ///< By change.
};

void fail(const std::string& what, const Difference& found = {}) {
  RC_FAIL(fmt::format("{}: of {} points {} are no longer removed, {} now are", what, found.points,
                      found.lost, found.gained));
}

/// Tries all changes on one world.
void try_changes(const toy::Claims& claims, const toy::HeldScans& world, std::mt19937& random,
                 Findings& findings) {
  const ConfiguredMethod method = configured(claims.variant);
  const double delay = answer_delay(method);
  const std::unique_ptr<Remover> remover = method.make();
  const MaskStore before = toy::masks_of(*remover, world);
  findings.removed += before.removed_count();
  for (std::size_t c = 0; c < toy::changes().size(); ++c) {
    const toy::Change& change = toy::changes()[c];
    toy::ChangedWorld changed = change.make(world, random);
    const MaskStore after = toy::masks_of(*remover, changed.scans);
    if (change.name == kLastLeftOut) compare_answered(world, delay, changed);
    const Difference found = difference(before, after, changed);
    if (found.lost + found.gained > 0) ++findings.changed_worlds[change.name];
    if (!holds(claims.about[c], found)) fail(change.name, found);
    if (parted_twins(after, changed) > 0) fail("points in one place have two verdicts");
  }
  // The remover has seen other worlds meanwhile, which must not matter either.
  // A delay is in seconds, and so are the speeds of raymoval_plus's tracks.
  const bool knows_times = delay > 0.0 || claims.variant.starts_with("raymoval_plus:");
  const MaskStore again = toy::masks_of(*remover, toy::with_other_labels(world, !knows_times));
  if (toy::different_verdicts(before, again, world.size()) > 0) {
    fail("other times, names, intensities and numbers in files");
  }
  const std::vector<InstructionSet> sets = supported_instruction_sets();
  const InstructionSet set = sets[random() % sets.size()];
  const InstructionSetScope scope(set);
  const MaskStore computed = toy::masks_of(*configured(claims.variant).make(), world);
  if (toy::different_verdicts(before, computed, world.size()) > 0) {
    fail(instruction_set_name(set) + std::string(" instructions"));
  }
}

Findings check_claims(const toy::Claims& claims, std::size_t worlds) {
  Findings findings;
  rc::detail::TestParams parameters;
  parameters.seed = from_environment("RAYMOVAL_SEED", 22);
  parameters.maxSuccess = static_cast<int>(worlds);
  const auto property = [&] {
    toy::WorldPlan plan;
    plan.scans = *rc::gen::inRange(8, 11);
    plan.walls = *rc::gen::inRange(1, 6);
    plan.movers = *rc::gen::inRange(1, 4);
    plan.seed = *rc::gen::noShrink(rc::gen::arbitrary<unsigned>());
    std::mt19937 random(plan.seed + 1);
    try_changes(claims, toy::random_world(plan), random, findings);
  };
  // The shorter call would read, and print, a configuration with a seed of its own.
  rc::detail::TestListenerAdapter listener;
  const auto result =
      rc::detail::checkTestable(property, rc::detail::TestMetadata{claims.variant, ""}, parameters,
                                listener, std::unordered_map<std::string, rc::detail::Reproduce>{});
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  INFO(text.str());
  CHECK(result.is<rc::detail::SuccessResult>());
  CHECK((findings.removed > 0) == (claims.variant != "noop:default"));
  return findings;
}

bool may_change(Claim claim) {
  return claim != Claim::kSame && claim != Claim::kRounding;
}

void check_method(const std::string& name) {
  const std::size_t worlds = from_environment("RAYMOVAL_WORLDS", kWorlds);
  std::map<std::string, int> open, changed;  // By change: variants that may, worlds that did.
  for (const toy::Claims& claims : toy::claims()) {
    if (!claims.variant.starts_with(name + ":")) continue;
    if (!MethodRegistry::built_in().configure(claims.variant).variant.is_available) continue;
    INFO(claims.variant);
    Findings findings = check_claims(claims, worlds);
    for (std::size_t c = 0; c < claims.about.size(); ++c) {
      const char* change = toy::changes()[c].name;
      const int found = findings.changed_worlds[change];
      open[change] += may_change(claims.about[c]) ? 1 : 0;
      changed[change] += found;
      if (worlds <= kWorlds) continue;
      std::cout << fmt::format("{}: {} [{}] changed {} of {} worlds\n", claims.variant, change,
                               static_cast<char>(claims.about[c]), found, worlds);
    }
  }
  for (const auto& [change, variants] : open) {
    if (worlds < kEnoughWorlds || variants == 0) continue;
    INFO(change << " is said to change something, and does not");
    CHECK(changed[change] > 0);
  }
}

}  // namespace

TEST_CASE("every variant says what may change its answer", "[properties]") {
  std::map<std::string, int> lines;
  for (const toy::Claims& claims : toy::claims()) {
    ++lines[claims.variant];
    INFO(claims.variant);
    CHECK(claims.about.size() == toy::changes().size());
    CHECK_NOTHROW(MethodRegistry::built_in().configure(claims.variant));
  }
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    if (entry->needs_truth) continue;  // It answers from labels, which these worlds have not.
    for (const MethodVariant& variant : entry->variants) {
      INFO("tests/methods/properties/claims.cpp: " << entry->name << ":" << variant.name);
      CHECK(lines[entry->name + ":" + variant.name] == 1);
    }
  }
}

// Only what came before a scan may decide on it, or, if the method has a delay, before its answer.
TEST_CASE("online variants claim that later scans change nothing", "[properties]") {
  for (const toy::Claims& claims : toy::claims()) {
    INFO(claims.variant);
    for (std::size_t c = 0; c < claims.about.size(); ++c) {
      if (toy::changes()[c].name != kLastLeftOut) continue;
      const bool online = MethodRegistry::built_in().configure(claims.variant).variant.online;
      CHECK((!online || claims.about[c] == Claim::kSame));
    }
  }
}

TEST_CASE("what may change an answer of raymoval_plus", "[properties][slow]") {
  check_method("raymoval_plus");
}

TEST_CASE("what may change an answer of a method", "[properties][slow]") {
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    if (entry->name != "raymoval_plus") check_method(entry->name);
  }
}

}  // namespace raymoval::properties_test
