# Everything comes from Debian 12: scripts/install_dependencies.sh installs it.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 2.1 REQUIRED)
find_package(TBB REQUIRED)
find_package(nanoflann REQUIRED)
find_package(tsl-robin-map REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
# SIMD chosen at run time.
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET libhwy)

# PCL only where .pcd and .ply files are read. Its own CMake configuration drags in VTK and Qt, so
# its two libraries are looked up directly.
find_path(RAYMOVAL_PCL_INCLUDE_DIRS pcl/point_cloud.h PATH_SUFFIXES pcl-1.13 pcl-1.12 REQUIRED)
find_library(RAYMOVAL_PCL_COMMON_LIBRARY pcl_common REQUIRED)
find_library(RAYMOVAL_PCL_IO_LIBRARY pcl_io REQUIRED)
find_library(RAYMOVAL_PCL_IO_PLY_LIBRARY pcl_io_ply REQUIRED)
set(RAYMOVAL_PCL_LIBRARIES ${RAYMOVAL_PCL_IO_LIBRARY} ${RAYMOVAL_PCL_IO_PLY_LIBRARY}
    ${RAYMOVAL_PCL_COMMON_LIBRARY})
# Planes by random sample consensus, for the octomap method.
find_library(RAYMOVAL_PCL_SAMPLE_CONSENSUS_LIBRARY pcl_sample_consensus REQUIRED)
set(RAYMOVAL_PCL_CONSENSUS_LIBRARIES ${RAYMOVAL_PCL_SAMPLE_CONSENSUS_LIBRARY}
    ${RAYMOVAL_PCL_COMMON_LIBRARY})

find_package(octomap 1.9 REQUIRED)

# The simulator's ray tracer.
find_package(embree 3.13 CONFIG REQUIRED)
