# Several source files compiled as one: a third of the work where headers cost more than
# what is in the files. For builds that nobody edits in: names in anonymous namespaces have to
# differ within a group. A forgotten #include may go unnoticed by the compiler;
# scripts/check_own_includes.py looks for those.
set(RAYMOVAL_UNITY core datasets methods eval benchmark python tests CACHE STRING
    "Rooms, and tests, that are compiled several files at a time, such as core;benchmark;tests")

# raymoval_unity(NAME TARGET [BY_FOLDER] SOURCE...): groups of up to ten files in the order of their
# paths, if NAME is in RAYMOVAL_UNITY. BY_FOLDER keeps files of different folders apart, as tests have
# to be, each of which uses the namespace of what it tests.
function(raymoval_unity name target)
  if(NOT name IN_LIST RAYMOVAL_UNITY)
    return()
  endif()
  cmake_parse_arguments(given "BY_FOLDER" "" "" ${ARGN})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # A class with members of an unnamed namespace is at home in a source file, and is taken for a
  # header's here.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  set(group ${name})
  foreach(source ${given_UNPARSED_ARGUMENTS})
    if(given_BY_FOLDER)
      file(RELATIVE_PATH group ${PROJECT_SOURCE_DIR} ${source})
      get_filename_component(group ${group} DIRECTORY)
      string(MAKE_C_IDENTIFIER ${group} group)
    endif()
    math(EXPR count_${group} "${count_${group}} + 0")
    math(EXPR part "${count_${group}} / 10")
    math(EXPR count_${group} "${count_${group}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${part})
  endforeach()
endfunction()

# What nearly every file includes, compiled once for all rooms. It saves half a second for each file,
# and a touched file compiles quicker, too. A compiler cache mostly cannot work with it, so with one
# it is off. Each file includes what it needs all the same. nlohmann/json.hpp is not among these
# headers: it would make every file that does not use it slower.
set(pch ON)
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(pch OFF)
endif()
option(RAYMOVAL_PCH "Compile common headers once (precompiled headers)" ${pch})
if(RAYMOVAL_PCH)
  # A target of its own, without the definitions of any room, for these would not fit the others.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/no_code.cpp CONTENT "")
  add_library(raymoval_headers OBJECT ${PROJECT_BINARY_DIR}/generated/no_code.cpp)
  target_link_libraries(raymoval_headers PRIVATE raymoval_options Eigen3::Eigen)
  set(raymoval_common_headers <algorithm> <array> <cmath> <cstdint> <cstdio> <filesystem> <functional>
    <limits> <map> <memory> <optional> <set> <string> <string_view> <utility> <variant> <vector>
    <Eigen/Geometry>)
  target_precompile_headers(raymoval_headers PRIVATE ${raymoval_common_headers})
  # GCC 12 does not take what is inlined of these headers for a system's, and warns wrongly on it
  # (the kin of GCC bug 105651). A build without them has these warnings.
  target_compile_options(raymoval_options INTERFACE
    "$<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>"
    # Where they do not fit a file, it is compiled without them.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-error=invalid-pch>)
endif()

# raymoval_precompile(TARGET [HEADER...]): for a library. With more headers, or options of its own, it
# has precompiled headers of its own, for those of others would not fit.
function(raymoval_precompile target)
  if(NOT RAYMOVAL_PCH)
    return()
  endif()
  if(ARGN)
    target_precompile_headers(${target} PRIVATE ${raymoval_common_headers} ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM raymoval_headers)
  endif()
endfunction()

# raymoval_optimise_little(TARGET): for a library of which nothing runs for long. More takes half as
# long again to compile.
function(raymoval_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-O1>)
endfunction()

# A room is a folder of the house and one static library, raymoval::<name>. Every source file below
# the folder belongs to it.
function(raymoval_room name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${name}/*.cpp)
  if(NOT sources)
    message(FATAL_ERROR "no source file in ${name}/")
  endif()
  add_library(raymoval_${name} STATIC ${sources})
  raymoval_unity(${name} raymoval_${name} ${sources})
  raymoval_precompile(raymoval_${name})
  add_library(raymoval::${name} ALIAS raymoval_${name})
  target_compile_features(raymoval_${name} PUBLIC cxx_std_20)
  target_include_directories(raymoval_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/raymoval>)
  target_link_libraries(raymoval_${name} PRIVATE $<BUILD_INTERFACE:raymoval_options>
                                                 $<BUILD_INTERFACE:raymoval_coverage>)
  set_target_properties(raymoval_${name} PROPERTIES EXPORT_NAME ${name})
endfunction()

# raymoval_takes_no_bytes(TARGET): spares a library checks that take a fifth of the time to compile it
# for sanitizers. The bytes of files, which may lie anywhere, become numbers in core and datasets.
function(raymoval_takes_no_bytes target)
  if(RAYMOVAL_SANITIZE MATCHES "undefined")
    target_compile_options(${target} PRIVATE -fno-sanitize=alignment)
  endif()
endfunction()
