# cmake -DSOURCE=FOLDER -DOUTPUT=FILE -P build_commit.cmake
# Writes FILE, a C++ source that says which commit of FOLDER is built and whether what is compiled
# differs from it. Where FOLDER is no repository of its own, as the source archive of a release, its
# file COMMIT says the commit, and the tree is unknown. Else both are unknown.
set(commit "unknown")
set(tree "unknown")
find_program(git git)
if(git)
  execute_process(COMMAND ${git} -C ${SOURCE} rev-parse --show-toplevel HEAD
                  RESULT_VARIABLE status OUTPUT_VARIABLE told ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(REPLACE "\n" ";" told "${told}")
  if(status EQUAL 0)
    list(GET told 0 top)
    list(GET told 1 head)
    file(REAL_PATH "${top}" top)
    file(REAL_PATH "${SOURCE}" source)
    if(top STREQUAL source)
      set(commit ${head})
      # Folders with results of runs do not count.
      execute_process(COMMAND ${git} -C ${SOURCE} --no-optional-locks status --porcelain --
                              CMakeLists.txt cmake core datasets methods eval benchmark
                      RESULT_VARIABLE status OUTPUT_VARIABLE changes ERROR_QUIET)
      if(status EQUAL 0)
        set(tree "clean")
        if(NOT changes STREQUAL "")
          set(tree "changed")
        endif()
      endif()
    endif()
  endif()
endif()
if(commit STREQUAL "unknown" AND EXISTS ${SOURCE}/COMMIT)
  file(STRINGS ${SOURCE}/COMMIT told LIMIT_COUNT 1 LIMIT_INPUT 64)
  if(told MATCHES "^[0-9a-f]+$")
    set(commit ${told})
  endif()
endif()
set(text "// Written by cmake/build_commit.cmake.
#include \"benchmark/process/build_commit.h\"

namespace raymoval {
const char* build_commit() { return \"${commit}\"; }
const char* build_tree() { return \"${tree}\"; }
}  // namespace raymoval
")
set(known "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} known)
endif()
if(NOT known STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
