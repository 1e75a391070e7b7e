# The page of `raymoval report`. Its 3-D view is drawn with three.js (Debian's libjs-three). esbuild
# bundles three.js and the sources of the view into one script.
set(RAYMOVAL_REPORT_3D AUTO CACHE STRING
    "Reports with a 3-D view, which needs esbuild and three.js: ON, OFF, or AUTO (if they are there)")
set_property(CACHE RAYMOVAL_REPORT_3D PROPERTY STRINGS AUTO ON OFF)
set(report_web ${PROJECT_SOURCE_DIR}/benchmark/report/web)
set(report_build ${PROJECT_BINARY_DIR}/report)
set(report_parts ${report_web}/page.css ${report_web}/page.js)
set(with_view OFF)
set(three_version "")

if(RAYMOVAL_REPORT_3D)
  find_program(RAYMOVAL_ESBUILD esbuild)
  find_path(RAYMOVAL_THREE three/build/three.module.js PATHS /usr/share/nodejs
            DOC "Folder that holds three/build/three.module.js")
  set(missing "")
  if(NOT RAYMOVAL_ESBUILD)
    list(APPEND missing "esbuild (Debian's package esbuild)")
  endif()
  if(NOT RAYMOVAL_THREE)
    list(APPEND missing "three.js (Debian's package libjs-three)")
  endif()
  list(JOIN missing " and " missing)
  if(NOT missing)
    set(with_view ON)
  elseif(RAYMOVAL_REPORT_3D STREQUAL "AUTO")
    message(WARNING "Reports are built without the 3-D view, which needs ${missing}.")
  else()
    message(FATAL_ERROR "The 3-D view of reports needs ${missing}. Install it, or configure with "
                        "-DRAYMOVAL_REPORT_3D=OFF for reports without the view.")
  endif()
endif()
set(raymoval_report_3d ${with_view} CACHE INTERNAL "Whether reports have the 3-D view")

if(with_view)
  set(three ${RAYMOVAL_THREE}/three/build)
  file(STRINGS ${three}/three.module.js revision REGEX "REVISION = '")
  if(NOT revision)  # Newer versions are split in two.
    file(STRINGS ${three}/three.core.js revision REGEX "REVISION = '")
  endif()
  string(REGEX REPLACE ".*'(.*)'.*" "r\\1" three_version "${revision}")
  file(GLOB view_sources CONFIGURE_DEPENDS ${report_web}/view/*.js)
  set(view_bundle ${report_build}/view.js)
  add_custom_command(OUTPUT ${view_bundle}
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${RAYMOVAL_THREE}
            ${RAYMOVAL_ESBUILD} ${report_web}/view/main.js --bundle --minify --format=iife
            --target=es2020 --legal-comments=none --charset=ascii --log-level=warning
            --outfile=${view_bundle}
    DEPENDS ${view_sources} ${three}/three.module.js
    COMMENT "Bundling the 3-D view of reports" VERBATIM)
  list(APPEND report_parts ${report_web}/view.html ${report_web}/three_licence.txt ${view_bundle})
endif()

# Files as byte arrays of a C++ source, found by name.
set(report_source ${PROJECT_BINARY_DIR}/generated/report_files.cpp)
string(REPLACE ";" "|" report_list "${report_parts}")
add_custom_command(OUTPUT ${report_source}
  COMMAND ${CMAKE_COMMAND} "-DFILES=${report_list}" -DOUTPUT=${report_source}
          -P ${PROJECT_SOURCE_DIR}/cmake/embed_report.cmake
  DEPENDS ${report_parts} ${PROJECT_SOURCE_DIR}/cmake/embed_report.cmake
  COMMENT "Embedding the parts of reports" VERBATIM)
target_sources(raymoval_benchmark PRIVATE ${report_source})
set_source_files_properties(${PROJECT_SOURCE_DIR}/benchmark/report/page.cpp PROPERTIES
  COMPILE_DEFINITIONS RAYMOVAL_THREE_VERSION="${three_version}")
