// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>

#include "core/error.h"

namespace raymoval {

/// Calls `call` with a zero of the number type of `type` (F real, I signed, U unsigned) and `size`
/// (bytes), and returns its result. All number types are listed here.
/// @throws InternalError for a type that no reader accepts
template <class Call>
decltype(auto) with_number_type(char type, int size, Call&& call) {
  if (type == 'F' && size == 4) return call(float{});
  if (type == 'F' && size == 8) return call(double{});
  if (type == 'I' && size == 1) return call(std::int8_t{});
  if (type == 'I' && size == 2) return call(std::int16_t{});
  if (type == 'I' && size == 4) return call(std::int32_t{});
  if (type == 'I' && size == 8) return call(std::int64_t{});
  if (type == 'U' && size == 1) return call(std::uint8_t{});
  if (type == 'U' && size == 2) return call(std::uint16_t{});
  if (type == 'U' && size == 4) return call(std::uint32_t{});
  if (type == 'U' && size == 8) return call(std::uint64_t{});
  throw InternalError("a field of a point has a number type that does not exist");
}

}  // namespace raymoval
