// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/parameters.h"

namespace raymoval {

/// Whether a condition on the values of other parameters holds. A condition is a text, because it
/// is also what people read: comparisons joined by "and" and "or", of which "and" binds closer. A
/// comparison is `NAME is VALUE`, `NAME is not VALUE`, `NAME > NUMBER` or the same with `<`, `>=`
/// and
/// `<=`. The empty condition always holds, and `never` never does (the parameter changes time or
/// memory only).
/// @throws InternalError if the condition is malformed or names no parameter of `configuration`
bool condition_holds(const std::string& condition, const Configuration& configuration);

/// Whether the parameter can change anything while the others have the values of `configuration`.
bool has_effect(const ParameterSpec& spec, const Configuration& configuration);

/// "it acts when erase is true", or "it changes time or memory only".
std::string effect_text(const ParameterSpec& spec);

/// "raymoval:naive.tau0 has no effect here: it acts when map_source is not naive." for each
/// parameter of `names` that has none.
/// @param owner whose parameters they are, "raymoval:naive"
/// @throws ConfigurationError if a name is not among `specs`
std::vector<std::string> without_effect(const std::string& owner,
                                        const std::vector<ParameterSpec>& specs,
                                        const Configuration& configuration,
                                        const std::vector<std::string>& names);

}  // namespace raymoval
