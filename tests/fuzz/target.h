// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "core/error.h"

namespace raymoval::fuzz {

/// Tries one input on a parser. An exception or a crash is a finding.
using Target = void (*)(std::string_view bytes);

/// Makes `target` known under `name`. @return anything
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

/// Begins the function that tries `bytes` as an input of the target `name`.
#define RAYMOVAL_FUZZ_TARGET(name)                                                               \
  void try_##name(std::string_view bytes);                                                       \
  [[maybe_unused]] const bool name##_is_known = ::raymoval::fuzz::add_target(#name, try_##name); \
  void try_##name(std::string_view bytes)
