# The page of `raymoval report`. Its 3-D view is drawn with three.js, which comes from the npm
# registry by npm, pinned by version and SHA-512, and is bundled by esbuild into one script. The source
# archive of a release has it in third_party/, so that it is built without a network.
set(RAYMOVAL_REPORT_3D AUTO CACHE STRING
    "Reports with a 3-D view, which needs npm, its registry, and esbuild: ON, OFF, or AUTO (if they are there)")
set_property(CACHE RAYMOVAL_REPORT_3D PROPERTY STRINGS AUTO ON OFF)
set(three_version 0.187.0)
set(three_sha512 422bbb47e0a687c0acb59b18d6e24e4969d595fa3b66d34b57b985f0996d9372c1dc0b43bbd71166572744a90093c638cfa28ac37e73ed8ed4addee3598f1eb4)
set(report_web ${PROJECT_SOURCE_DIR}/benchmark/report/web)
set(report_build ${PROJECT_BINARY_DIR}/report)
file(MAKE_DIRECTORY ${report_build})

# Gets three.js into report_build/node_modules. It is fetched once for a build folder; a file that is
# not what was pinned is never used. `problem` is set to what is missing, or to nothing.
function(raymoval_fetch_three problem)
  set(${problem} "" PARENT_SCOPE)
  set(archive ${report_build}/three-${three_version}.tgz)
  set(brought ${PROJECT_SOURCE_DIR}/third_party/three-${three_version}.tgz)
  if(NOT EXISTS ${archive} AND EXISTS ${brought})
    file(COPY ${brought} DESTINATION ${report_build})
  endif()
  if(EXISTS ${archive})
    file(SHA512 ${archive} found)
  endif()
  if(NOT "${found}" STREQUAL ${three_sha512})
    find_program(RAYMOVAL_NPM npm)
    if(NOT RAYMOVAL_NPM)
      set(${problem} "npm is missing; scripts/install_dependencies.sh installs it" PARENT_SCOPE)
      return()
    endif()
    message(STATUS "Fetching three ${three_version}")
    execute_process(COMMAND ${RAYMOVAL_NPM} pack three@${three_version} --loglevel=error
                            --fetch-retries=1 --fetch-retry-mintimeout=1000 --fetch-timeout=60000
                            --pack-destination ${report_build}
                    WORKING_DIRECTORY ${report_build} INPUT_FILE /dev/null RESULT_VARIABLE status
                    OUTPUT_VARIABLE told ERROR_VARIABLE told)
    if(NOT status EQUAL 0 OR NOT EXISTS ${archive})
      set(${problem} "npm could not fetch three ${three_version}:\n${told}" PARENT_SCOPE)
      return()
    endif()
    file(SHA512 ${archive} found)
    if(NOT found STREQUAL ${three_sha512})
      file(REMOVE ${archive})
      message(FATAL_ERROR "three ${three_version} came with SHA-512 ${found}, expected "
                          "${three_sha512}. Find out why, or configure with "
                          "-DRAYMOVAL_REPORT_3D=OFF for reports without the 3-D view")
    endif()
  endif()
  if(NOT EXISTS ${report_build}/node_modules/three/package.json)
    file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${report_build}/unpacked)
    file(MAKE_DIRECTORY ${report_build}/node_modules)
    file(RENAME ${report_build}/unpacked/package ${report_build}/node_modules/three)
  endif()
endfunction()

# What is wanted, what can be had, and `raymoval_report_3d`: what is built.
if(RAYMOVAL_REPORT_3D STREQUAL "AUTO")
  # The registry is asked once for a build folder, for asking takes long where it does not answer.
  set(wanted ON)
  if(RAYMOVAL_REPORT_3D_TRIED)
    set(wanted ${raymoval_report_3d})
  endif()
else()
  set(wanted ${RAYMOVAL_REPORT_3D})
endif()
set(problem "")
if(wanted)
  find_program(RAYMOVAL_ESBUILD esbuild)
  if(NOT RAYMOVAL_ESBUILD)
    set(problem "esbuild is missing; scripts/install_dependencies.sh installs it")
  else()
    raymoval_fetch_three(problem)
  endif()
endif()
if(problem AND RAYMOVAL_REPORT_3D STREQUAL "AUTO")
  message(WARNING "Reports are built without the 3-D view: ${problem}\n"
                  "Once this is mended, configure with -DRAYMOVAL_REPORT_3D=ON.")
  set(wanted OFF)
elseif(problem)
  message(FATAL_ERROR "${problem}\nMend this, or configure with -DRAYMOVAL_REPORT_3D=OFF for "
                      "reports without the 3-D view.")
endif()
set(RAYMOVAL_REPORT_3D_TRIED TRUE CACHE INTERNAL "AUTO has been decided for this build folder")
set(raymoval_report_3d ${wanted} CACHE INTERNAL "Whether reports have the 3-D view")

set(report_parts ${report_web}/page.css ${report_web}/page.js)
if(raymoval_report_3d)
  file(GLOB view_sources CONFIGURE_DEPENDS ${report_web}/view/*.js)
  set(view_bundle ${report_build}/view.js)
  add_custom_command(OUTPUT ${view_bundle}
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${report_build}/node_modules
            ${RAYMOVAL_ESBUILD} ${report_web}/view/main.js --bundle --minify --format=iife
            --target=es2020 --legal-comments=none --charset=ascii --log-level=warning
            --outfile=${view_bundle}
    DEPENDS ${view_sources}
    COMMENT "Bundling the 3-D view of reports" VERBATIM)
  list(APPEND report_parts ${report_web}/view.html ${view_bundle}
       ${report_build}/node_modules/three/LICENSE)
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
set_source_files_properties(${PROJECT_SOURCE_DIR}/benchmark/report/page_parts.cpp PROPERTIES
  COMPILE_DEFINITIONS RAYMOVAL_THREE_VERSION="${three_version}")
