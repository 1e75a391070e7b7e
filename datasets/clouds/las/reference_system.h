// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace raymoval {

/// The coordinate reference system `text` as WKT: `text` itself, the content of the file of that
/// name, or for "EPSG:n" what can be said without a database: UTM zones on WGS 84 (32601 to 32660,
/// 32701 to 32760), ETRS89 (25828 to 25838) and NAD83 (26901 to 26923).
/// @throws UsageError for another code (LAS 1.4 has no place for a bare code in points of the
/// formats
///   6 and up), and for what is neither WKT nor a file; DataError if the file cannot be read
std::string reference_system_text(const std::string& text);

/// The WKT of an EPSG code, if it is one of those above.
std::optional<std::string> epsg_text(int code);

}  // namespace raymoval
