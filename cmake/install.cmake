# find_package(raymoval) gives raymoval::core, raymoval::datasets, raymoval::methods, raymoval::eval,
# and raymoval::harness: the whole program as a function.
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/raymoval)

# Each component becomes one Debian package (cmake/package.cmake): `program`, `dev` for the library,
# and `python` (python/CMakeLists.txt).
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
install(TARGETS raymoval_core raymoval_datasets raymoval_methods raymoval_eval raymoval_benchmark
        EXPORT raymovalTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(TARGETS raymoval_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(header ${raymoval_public_headers})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/raymoval/${folder} COMPONENT dev)
endforeach()
install(DIRECTORY benchmark/suites DESTINATION ${CMAKE_INSTALL_DATADIR}/raymoval
        FILES_MATCHING PATTERN "*.json")
install(DIRECTORY results/published results/schema DESTINATION ${CMAKE_INSTALL_DATADIR}/raymoval)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} USE_SOURCE_PERMISSIONS
        PATTERN "__pycache__" EXCLUDE)
if(NOT RAYMOVAL_SANITIZE)
  install(FILES ${PROJECT_BINARY_DIR}/share/shell/raymoval.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()
install(FILES benchmark/cli/shell/raymoval.bash RENAME raymoval
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
# Where pages and pictures stand in the repository, so that their links lead there.
install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md SECURITY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})
file(GLOB pages CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
     docs/*.md docs/recipes/*.md methods/README.md methods/*/*.md datasets/*/README.md
     results/pictures/*.png results/pictures/*.svg results/schema/*.json)
foreach(page ${pages})
  get_filename_component(folder ${page} DIRECTORY)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder})
endforeach()
file(READ LICENSE copyright)
file(WRITE ${PROJECT_BINARY_DIR}/copyright "${copyright}")
# Debian asks for this file in a folder with the name of the package.
install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/raymoval-dev
        COMPONENT dev)
if(RAYMOVAL_PYTHON)
  install(FILES ${PROJECT_BINARY_DIR}/copyright
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-raymoval COMPONENT python)
endif()
install(DIRECTORY scripts/workflow DESTINATION ${CMAKE_INSTALL_DATADIR}/raymoval
        USE_SOURCE_PERMISSIONS)
install(EXPORT raymovalTargets NAMESPACE raymoval:: DESTINATION ${config_dir} COMPONENT dev)
configure_package_config_file(cmake/raymovalConfig.cmake.in raymovalConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(raymovalConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/raymovalConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/raymovalConfigVersion.cmake
              cmake/system_libraries.cmake DESTINATION ${config_dir} COMPONENT dev)
