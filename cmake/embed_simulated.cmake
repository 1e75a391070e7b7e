# Writes a C++ source that holds the data files of the simulator, so that a program finds them
# wherever it is installed. Run as a script: cmake -DROOT=... -DOUTPUT=... -P embed_simulated.cmake
function(raymoval_embed folder function_name result)
  file(GLOB files ${ROOT}/${folder}/*.json)
  list(SORT files)
  set(entries "")
  foreach(path ${files})
    get_filename_component(name ${path} NAME_WE)
    string(MAKE_C_IDENTIFIER ${folder}_${name} array)
    file(READ ${path} hex HEX)
    string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
    string(REGEX REPLACE "(0x0a,)" "\\1\n" bytes "${bytes}")
    string(APPEND arrays "constexpr unsigned char ${array}[] = {\n${bytes}};\n")
    string(APPEND entries "      {\"${name}\", text_of(${array}, sizeof(${array}))},\n")
  endforeach()
  set(${result} "${${result}}${arrays}" PARENT_SCOPE)
  set(${function_name}_entries "${entries}" PARENT_SCOPE)
endfunction()

set(arrays_all "")
raymoval_embed(worlds built_in_worlds arrays_all)
raymoval_embed(sensors built_in_sensors arrays_all)
file(WRITE ${OUTPUT} "// Made by cmake/embed_simulated.cmake; do not edit.
#include \"datasets/simulation/scene/library.h\"

namespace raymoval::simulated {
namespace {
std::string_view text_of(const unsigned char* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}
${arrays_all}}  // namespace

const std::vector<BuiltInFile>& built_in_worlds() {
  static const std::vector<BuiltInFile> files = {
${built_in_worlds_entries}  };
  return files;
}

const std::vector<BuiltInFile>& built_in_sensors() {
  static const std::vector<BuiltInFile> files = {
${built_in_sensors_entries}  };
  return files;
}

}  // namespace raymoval::simulated
")
