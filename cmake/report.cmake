# The files of the pages of `raymoval report` and `raymoval clean --html`, as byte arrays of a C++
# source, found by name.
file(GLOB report_parts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/benchmark/report/web/*)
set(report_source ${PROJECT_BINARY_DIR}/generated/report_files.cpp)
string(REPLACE ";" "|" report_list "${report_parts}")
add_custom_command(OUTPUT ${report_source}
  COMMAND ${CMAKE_COMMAND} "-DFILES=${report_list}" -DOUTPUT=${report_source}
          -P ${PROJECT_SOURCE_DIR}/cmake/embed_report.cmake
  DEPENDS ${report_parts} ${PROJECT_SOURCE_DIR}/cmake/embed_report.cmake
  COMMENT "Embedding the parts of reports" VERBATIM)
target_sources(raymoval_benchmark PRIVATE ${report_source})
