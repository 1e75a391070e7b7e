# Programs that measure. They are built when they are asked for.

# Measures how sure methods are, and how often they are right: `scripts/calibrate.cpp`.
add_executable(calibrate EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/scripts/calibrate.cpp)
target_link_libraries(calibrate PRIVATE raymoval_datasets raymoval_methods raymoval_eval raymoval_options)
