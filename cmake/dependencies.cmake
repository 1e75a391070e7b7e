# Everything comes from Debian 12: scripts/install_dependencies.sh installs it.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
# Messages: fmt::format, by <fmt/format.h>.
find_package(fmt 9 REQUIRED)
find_package(TBB REQUIRED)
# Deflates the points of a report; unpacks clouds (.gz, .npz).
find_package(ZLIB REQUIRED)
find_package(nanoflann REQUIRED)
find_package(tsl-robin-map REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
# SIMD chosen at run time.
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET libhwy)
# Compressions of recordings, and the databases that ROS 2 records to.
find_package(BZip2 REQUIRED)
pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(sqlite3 REQUIRED IMPORTED_TARGET sqlite3)

# PCL only where a method says so.
find_path(RAYMOVAL_PCL_INCLUDE_DIRS pcl/point_cloud.h PATH_SUFFIXES pcl-1.13 pcl-1.12 REQUIRED)
find_package(octomap 1.9 REQUIRED)
include(cmake/system_libraries.cmake)
if(raymoval_missing_libraries)
  message(FATAL_ERROR "not found: ${raymoval_missing_libraries}; run scripts/install_dependencies.sh")
endif()

# The simulator's ray tracer.
find_package(embree 3.13 CONFIG REQUIRED)

# Pictures are drawn by cairo; charts as PDF and PNG by librsvg on it.
pkg_check_modules(rsvg IMPORTED_TARGET librsvg-2.0>=2.46 cairo-pdf cairo-png cairo-ft)
if(NOT rsvg_FOUND)
  message(FATAL_ERROR "librsvg (2.46 or later) or cairo was not found: they draw pictures and charts. "
                      "Run scripts/install_dependencies.sh, or install librsvg2-dev.")
endif()
