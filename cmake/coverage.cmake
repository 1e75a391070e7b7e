# What the rooms count while they run, for scripts/coverage.sh: only functions that are written in this
# repository, and no tests. Counts of threads may get lost, which does not matter for whether a line
# ran, and locked counting would cost much more.
add_library(raymoval_coverage INTERFACE)
if(RAYMOVAL_COVERAGE)
  target_compile_options(raymoval_coverage INTERFACE --coverage -fprofile-update=single
    "-fprofile-filter-files=^${PROJECT_SOURCE_DIR}/(core|datasets|methods|eval|benchmark)/")
  add_link_options(--coverage)
endif()
