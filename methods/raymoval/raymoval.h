// SPDX-License-Identifier: MIT
#pragma once

#include "methods/registry.h"

namespace raymoval {

MethodEntry raymoval_entry();

}  // namespace raymoval
