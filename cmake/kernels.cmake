# Kernels that are compiled once for each instruction set give the same numbers on all of them: no
# multiplication and addition may be fused behind their back. Whatever file is compiled so names
# itself to Highway, and is found by that.
file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/core/*.cpp
     ${PROJECT_SOURCE_DIR}/methods/*.cpp)
foreach(source ${sources})
  file(STRINGS ${source} names_itself REGEX "define HWY_TARGET_INCLUDE")
  if(names_itself)
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS -ffp-contract=off)
  endif()
endforeach()
