# Kernels that are compiled once for each instruction set give the same numbers on all of them: no
# multiplication and addition may be fused behind their back.
set_source_files_properties(
  ${PROJECT_SOURCE_DIR}/methods/raymoval/first_hit_sweep.cpp
  ${PROJECT_SOURCE_DIR}/methods/raymoval/scan_kernels.cpp
  ${PROJECT_SOURCE_DIR}/methods/raymoval_plus/sight_kernels.cpp
  PROPERTIES COMPILE_OPTIONS -ffp-contract=off)
