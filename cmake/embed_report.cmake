# Writes a C++ source that holds the files of a page.
# Run as a script: cmake "-DFILES=a|b" -DOUTPUT=... -P embed_report.cmake
string(REPLACE "|" ";" files "${FILES}")
set(arrays "")
set(entries "")
foreach(path ${files})
  get_filename_component(name ${path} NAME)
  string(MAKE_C_IDENTIFIER ${name} array)
  file(READ ${path} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(REGEX REPLACE "(0x0a,|0x3b,)" "\\1\n" bytes "${bytes}")
  string(APPEND arrays "constexpr unsigned char ${array}[] = {\n${bytes}};\n")
  string(APPEND entries "  if (name == \"${name}\") return text_of(${array}, sizeof(${array}));\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by cmake/embed_report.cmake; do not edit.
#include \"benchmark/report/page_files.h\"

namespace raymoval {
namespace {
std::string_view text_of(const unsigned char* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}
${arrays}}  // namespace

std::string_view page_file(std::string_view name) {
${entries}  return {};
}

}  // namespace raymoval
")
