# The ray tracer and the data files of the simulator.
target_link_libraries(raymoval_datasets PRIVATE embree TBB::tbb)
target_compile_definitions(raymoval_datasets PRIVATE RAYMOVAL_EMBREE=${RAYMOVAL_EMBREE})
file(GLOB simulated_data CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/datasets/simulation/worlds/*.json
     ${PROJECT_SOURCE_DIR}/datasets/simulation/sensors/*.json)
set(simulated_source ${PROJECT_BINARY_DIR}/generated/simulated_data.cpp)
add_custom_command(OUTPUT ${simulated_source}
  COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR}/datasets/simulation
          -DOUTPUT=${simulated_source} -P ${PROJECT_SOURCE_DIR}/cmake/embed_simulated.cmake
  DEPENDS ${simulated_data} ${PROJECT_SOURCE_DIR}/cmake/embed_simulated.cmake
  COMMENT "Embedding simulated worlds and sensors" VERBATIM)
target_sources(raymoval_datasets PRIVATE ${simulated_source})
