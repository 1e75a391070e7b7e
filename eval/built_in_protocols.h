// SPDX-License-Identifier: MIT
#pragma once

#include "eval/protocol.h"

namespace raymoval {

// The protocols of the registry. Each is described where it is defined.
ProtocolEntry erasor_protocol_entry();
ProtocolEntry dynamicmap_protocol_entry();
ProtocolEntry strict_protocol_entry();
ProtocolEntry mos_protocol_entry();

}  // namespace raymoval
