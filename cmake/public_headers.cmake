# `raymoval_public_headers`: the headers that are installed, and that Doxygen reads. They are those
# below, which a method in C++, or a program that reads data and scores answers, starts with, and
# what these include. tests/consumer/consumer_test.sh compiles each of them alone.
set(first_headers
  benchmark/harness.h
  core/parallel.h
  core/scan/local_frame.h
  core/scan/mask_store.h
  core/scan/voxel_key.h
  datasets/open_sequence.h
  datasets/sequence.h
  eval/checked_scan.h
  eval/points/scan_loops.h
  eval/scan_passes.h
  eval/protocol.h
  eval/protocol_registry.h
  methods/common/scan_passes.h
  methods/registry.h
  methods/remover.h)

set(raymoval_public_headers "")
while(first_headers)
  list(POP_FRONT first_headers header)
  if(header IN_LIST raymoval_public_headers)
    continue()
  endif()
  list(APPEND raymoval_public_headers ${header})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
  file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"[^\"]+\"")
  foreach(line ${lines})
    string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
    list(APPEND first_headers ${included})
  endforeach()
endwhile()
list(SORT raymoval_public_headers)
