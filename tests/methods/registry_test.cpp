// SPDX-License-Identifier: MIT
#include "methods/registry.h"

#include <catch2/catch.hpp>

#include "methods/controls/controls.h"
#include "tests/methods/toy_world.h"

using namespace raymoval;

namespace {

toy::World small_world() {
  toy::World world{toy::Scanner{}};
  for (int i = 0; i < 3; ++i) world.scan({{{5, -1, -1}, {6, 1, 1}}}, Pose::Identity());
  return world;
}

}  // namespace

TEST_CASE("controls remove nothing, everything, or what they are told") {
  const toy::World world = small_world();
  const auto& methods = MethodRegistry::built_in();
  CHECK(toy::masks_of(*methods.configure("noop").make(), world).removed_count() == 0);
  CHECK(toy::masks_of(*methods.configure("remove-all").make(), world).removed_count() ==
        3 * world.load(0).size());
  const auto second =
      make_replay([](const Scan& scan) { return Mask(scan.size(), scan.index == 1 ? 1 : 0); });
  CHECK(toy::masks_of(*second, world).removed_count() == world.load(1).size());
  CHECK_THROWS_AS(methods.configure("oracle").make(), UsageError);
}

TEST_CASE("an unknown method or variant suggests a near one") {
  const auto& methods = MethodRegistry::built_in();
  CHECK_THROWS_WITH(methods.configure("raymovl"), Catch::Contains("Did you mean 'raymoval'"));
  CHECK_THROWS_WITH(methods.configure("raymoval:ofline"),
                    Catch::Contains("Did you mean 'offline'"));
}

TEST_CASE("a method's name is taken once and it has a variant") {
  MethodRegistry methods;
  methods.add(noop_entry());
  CHECK_THROWS_AS(methods.add(noop_entry()), ConfigurationError);
  MethodEntry bare = remove_all_entry();
  bare.variants.clear();
  CHECK_THROWS_AS(methods.add(bare), ConfigurationError);
}

TEST_CASE("every parameter's default is legal and says what it does") {
  for (const auto& entry : MethodRegistry::built_in().entries()) {
    for (const ParameterSpec& spec : entry->parameters) {
      INFO(entry->name << "." << spec.name);
      CHECK_NOTHROW(checked_value_from_text(entry->name, spec, parameter_text(spec.default_value)));
      CHECK_FALSE(spec.notes.sentence.empty());
      CHECK_FALSE(spec.notes.source.empty());
    }
    for (const MethodVariant& variant : entry->variants) {
      CHECK_NOTHROW(MethodRegistry::built_in().configure(entry->name + ":" + variant.name));
    }
  }
}
