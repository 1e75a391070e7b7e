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
add_executable(calibrate EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/scripts/calibrate.cpp)
target_link_libraries(calibrate PRIVATE raymoval_datasets raymoval_methods raymoval_eval raymoval_options)
