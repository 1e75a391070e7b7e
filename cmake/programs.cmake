# Programs that measure, each described in its own head. They are built when they are asked for.
#   realism      compares a simulated sequence with a real drive
#   calibrate    finds how a method's evidence becomes a confidence
#   bag_reading  compares how recordings and folders are read
foreach(program realism bag_reading)
  add_executable(${program} EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/scripts/${program}.cpp)
  target_link_libraries(${program} PRIVATE raymoval_benchmark raymoval_options)
endforeach()
target_sources(bag_reading PRIVATE ${PROJECT_SOURCE_DIR}/scripts/recorded_drive.cpp)
target_link_libraries(bag_reading PRIVATE PkgConfig::sqlite3)

# The fixed kernel by itself, for scripts/record.sh.
add_executable(raymoval_yardstick EXCLUDE_FROM_ALL
               ${PROJECT_SOURCE_DIR}/benchmark/kernels/yardstick_main.cpp
               ${PROJECT_SOURCE_DIR}/benchmark/kernels/yardstick.cpp)
target_include_directories(raymoval_yardstick PRIVATE ${PROJECT_SOURCE_DIR})
target_link_libraries(raymoval_yardstick PRIVATE raymoval_options)

# Measures how sure methods are, and how often they are right: `scripts/calibrate.cpp`.
add_executable(calibrate EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/scripts/calibrate.cpp)
target_link_libraries(calibrate PRIVATE raymoval_datasets raymoval_methods raymoval_eval raymoval_options)
