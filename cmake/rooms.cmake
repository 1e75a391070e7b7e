# A room is a folder of the house and one static library, raymoval::<name>. Every source file below
# the folder belongs to it.
function(raymoval_room name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${name}/*.cpp)
  if(NOT sources)
    message(FATAL_ERROR "no source file in ${name}/")
  endif()
  add_library(raymoval_${name} STATIC ${sources})
  add_library(raymoval::${name} ALIAS raymoval_${name})
  target_compile_features(raymoval_${name} PUBLIC cxx_std_20)
  target_include_directories(raymoval_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/raymoval>)
  target_link_libraries(raymoval_${name} PRIVATE $<BUILD_INTERFACE:raymoval_options>)
  set_target_properties(raymoval_${name} PROPERTIES EXPORT_NAME ${name})
endfunction()
