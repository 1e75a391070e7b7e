// SPDX-License-Identifier: MIT
#include "datasets/clouds/las/reference_system.h"

#include "core/error.h"
#include "core/files/file_kind.h"
#include "core/files/files.h"
#include "core/text.h"

namespace raymoval {
namespace {

/// A family of UTM zones. Facts: EPSG's register.
struct UtmFamily {
  int first, last;  ///< Codes.
  int first_zone;
  bool south;
  const char *name, *datum, *spheroid;
  int system, datum_code, spheroid_code;
};

constexpr UtmFamily kFamilies[] = {
    {32601, 32660, 1, false, "WGS 84", "WGS_1984", "\"WGS 84\",6378137,298.257223563", 4326, 6326,
     7030},
    {32701, 32760, 1, true, "WGS 84", "WGS_1984", "\"WGS 84\",6378137,298.257223563", 4326, 6326,
     7030},
    {25828, 25838, 28, false, "ETRS89", "European_Terrestrial_Reference_System_1989",
     "\"GRS 1980\",6378137,298.257222101", 4258, 6258, 7019},
    {26901, 26923, 1, false, "NAD83", "North_American_Datum_1983",
     "\"GRS 1980\",6378137,298.257222101", 4269, 6269, 7019}};

std::string authority(int code) {
  return ",AUTHORITY[\"EPSG\",\"" + std::to_string(code) + "\"]]";
}

bool looks_like_wkt(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] >= 'A' && text[first] <= 'Z' &&
         text.find('[') != std::string::npos && text.find(']') != std::string::npos;
}

std::string checked(const std::string& wkt, const std::string& where) {
  // A record of variable length has 65,535 bytes, and the text ends with a zero.
  if (looks_like_wkt(wkt) && wkt.size() < 65535 && wkt.find('\0') == std::string::npos) return wkt;
  throw UsageError(where +
                   ": is no reference system as WKT of up to 65,534 letters, such as PROJCS[...].");
}

}  // namespace

std::optional<std::string> epsg_text(int code) {
  for (const UtmFamily& family : kFamilies) {
    if (code < family.first || code > family.last) continue;
    const int zone = family.first_zone + code - family.first;
    return "PROJCS[\"" + std::string(family.name) + " / UTM zone " + std::to_string(zone) +
           (family.south ? "S" : "N") + "\",GEOGCS[\"" + family.name + "\",DATUM[\"" +
           family.datum + "\",SPHEROID[" + family.spheroid + authority(family.spheroid_code) +
           authority(family.datum_code) + ",PRIMEM[\"Greenwich\",0" + authority(8901) +
           ",UNIT[\"degree\",0.0174532925199433" + authority(9122) + authority(family.system) +
           ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],"
           "PARAMETER[\"central_meridian\"," +
           std::to_string(6 * zone - 183) +
           "],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],"
           "PARAMETER[\"false_northing\"," +
           (family.south ? "10000000" : "0") + "],UNIT[\"metre\",1" + authority(9001) +
           ",AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]" + authority(code);
  }
  return std::nullopt;
}

std::string reference_system_text(const std::string& text) {
  if (text.starts_with("EPSG:") || text.starts_with("epsg:")) {
    const auto code = parse_number<int>(text.substr(5));
    const auto wkt = code ? epsg_text(*code) : std::nullopt;
    if (wkt) return *wkt;
    throw UsageError(
        "'" + text.substr(0, 40) +
        "': of EPSG's codes the UTM zones on WGS 84 (32601 to 32660, 32701 to 32760), "
        "ETRS89 (25828 to 25838) and NAD83 (26901 to 26923) are known. Give the WKT of "
        "others, or a file with it: gdalsrsinfo -o wkt1 " +
        text.substr(0, 40) + " > crs.wkt");
  }
  if (looks_like_wkt(text)) return checked(text, "the reference system");
  if (has_file(text)) return checked(read_text(text), text);
  throw UsageError("'" + text.substr(0, 200) +
                   "' is no reference system: expected EPSG:CODE, WKT, or a file with WKT.");
}

}  // namespace raymoval
