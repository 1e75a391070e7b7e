// SPDX-License-Identifier: MIT
#include "datasets/layouts.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "datasets/semantickitti/semantickitti.h"
#include "datasets/simulation/street/street.h"

namespace raymoval {
namespace {

std::list<Layout>& registry() {
  // One line per layout.
  static std::list<Layout> all = [] {
    std::list<Layout> list;
    list.push_back(street_layout());
    list.push_back(scenes_layout());
    list.push_back(bags_layout());
    list.push_back(helimos_layout());  // Before SemanticKITTI, whose layout its sensors have.
    list.push_back(semantickitti_layout());
    list.push_back(dynamicmap_layout());
    list.push_back(files_layout());
    list.push_back(semantickitti_root_layout());
    return list;
  }();
  return all;
}

const Layout* find_layout(const std::string& name) {
  const auto found = std::find_if(layouts().begin(), layouts().end(),
                                  [&](const Layout& layout) { return layout.name == name; });
  return found == layouts().end() ? nullptr : &*found;
}

}  // namespace

const std::list<Layout>& layouts() {
  return registry();
}

void register_layout(Layout layout) {
  if (find_layout(layout.name) != nullptr) {
    throw UsageError("there is already a layout '" + layout.name + "'; choose another name.");
  }
  const auto behind_scenes =
      std::find_if(registry().begin(), registry().end(),
                   [](const Layout& other) { return !other.scenes.has_value(); });
  registry().insert(behind_scenes, std::move(layout));
}

const Layout* recognised_layout(const std::string& path) {
  const auto found = std::find_if(layouts().begin(), layouts().end(),
                                  [&](const Layout& layout) { return layout.recognise(path); });
  return found == layouts().end() ? nullptr : &*found;
}

const Layout& layout_of(const Sequence& sequence) {
  static const Layout unknown;
  const Layout* found = find_layout(sequence.layout);
  return found != nullptr ? *found : unknown;
}

}  // namespace raymoval
