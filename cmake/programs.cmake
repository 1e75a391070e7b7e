# Programs that measure. They are built when they are asked for.

# The fixed kernel by itself, for scripts/record.sh.
add_executable(raymoval_yardstick EXCLUDE_FROM_ALL
               ${PROJECT_SOURCE_DIR}/benchmark/kernels/yardstick_main.cpp
               ${PROJECT_SOURCE_DIR}/benchmark/kernels/yardstick.cpp)
target_include_directories(raymoval_yardstick PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(raymoval_yardstick PRIVATE raymoval_options)

# Measures how sure methods are, and how often they are right: `scripts/calibrate.cpp`.
add_executable(calibrate EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/scripts/calibrate.cpp)
target_link_libraries(calibrate PRIVATE raymoval_datasets raymoval_methods raymoval_eval raymoval_options)
