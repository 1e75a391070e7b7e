// SPDX-License-Identifier: MIT
// The header of Catch2 2 for a system that has Catch2 3, whose headers and names are others. Tests
// are written for version 2; tests/CMakeLists.txt puts this folder in their way if it found
// version 3.
#pragma once

#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/catch_tostring.hpp>
#include <catch2/generators/catch_generators_all.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <catch2/matchers/catch_matchers_vector.hpp>
#ifdef CATCH_CONFIG_MAIN
#include <catch2/catch_session.hpp>
#endif

#include <string>

namespace Catch {
namespace Matchers {

// Version 3 has another Contains, for ranges, in a header that is not included above.
inline StringContainsMatcher Contains(const std::string& part,
                                      CaseSensitive sensitive = CaseSensitive::Yes) {
  return ContainsSubstring(part, sensitive);
}

}  // namespace Matchers

using namespace Matchers;

}  // namespace Catch

using Catch::Approx;

#ifdef CATCH_CONFIG_MAIN
int main(int count, char** arguments) {
  return Catch::Session().run(count, arguments);
}
#endif
