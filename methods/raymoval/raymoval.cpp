// SPDX-License-Identifier: MIT
#include "methods/raymoval/raymoval.h"

#include "methods/controls/controls.h"

namespace raymoval {

MethodEntry raymoval_entry() {
  MethodEntry entry = noop_entry();
  entry.name = "raymoval";
  return entry;
}

}  // namespace raymoval
