# cmake --build build/release --target documentation: pages of the installed headers, made by Doxygen
# in BUILD/documentation/html. A warning is an error.
find_program(RAYMOVAL_DOXYGEN doxygen)
set(settings ${PROJECT_BINARY_DIR}/documentation/Doxyfile)
list(TRANSFORM raymoval_public_headers PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE headers)
list(JOIN headers " \\\n  " headers)
configure_file(cmake/Doxyfile.in ${settings} @ONLY)
if(RAYMOVAL_DOXYGEN)
  add_custom_target(documentation COMMAND ${RAYMOVAL_DOXYGEN} ${settings}
                    COMMENT "Making pages of the public headers" VERBATIM)
else()
  add_custom_target(documentation
    COMMAND ${CMAKE_COMMAND} -E echo "doxygen is missing; install it, and configure again."
    COMMAND ${CMAKE_COMMAND} -E false)
endif()
