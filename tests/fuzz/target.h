// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/error.h"

namespace raymoval::fuzz {

/// Tries one input on a parser. Whatever it lets through (an exception, a crash) is a finding.
using Target = void (*)(std::string_view bytes);

/// Makes `target` known to the replay under `name`. @return anything
bool add_target(const char* name, Target target);

/// What holds of anything that was read; broken, it is a finding.
inline void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// Runs `read`, which may refuse its input: with an error of the kinds that blame the input, and
/// that says something.
template <class Read>
void may_refuse(Read&& read) {
  try {
    read();
  } catch (const DataError& error) {
    require(error.what()[0] != '\0', "an error without a message");
  } catch (const ConfigurationError& error) {
    require(error.what()[0] != '\0', "an error without a message");
  } catch (const UsageError& error) {
    require(error.what()[0] != '\0', "an error without a message");
  }
}

}  // namespace raymoval::fuzz

/// Names the function of a file that tries an input: a libFuzzer program, or a part of the replay.
#ifdef RAYMOVAL_LIBFUZZER
#define RAYMOVAL_FUZZ_TARGET(name, target)                                            \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    (target)(std::string_view(reinterpret_cast<const char*>(data), size));            \
    return 0;                                                                         \
  }
#else
#define RAYMOVAL_FUZZ_TARGET(name, target) \
  [[maybe_unused]] static const bool name##_is_known = raymoval::fuzz::add_target(#name, target);
#endif
