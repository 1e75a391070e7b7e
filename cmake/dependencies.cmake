# Everything comes from the system's packages: scripts/install_dependencies.sh installs it. What is
# not there is said in one message, below. docs/platforms.md says which versions were tried.
set(raymoval_lacks "")

# raymoval_need(FOUND WHAT PACKAGE): notes WHAT, which Debian and Ubuntu have in PACKAGE.
function(raymoval_need found what package)
  if(NOT ${found})
    list(APPEND raymoval_lacks "${what}: ${package}")
    set(raymoval_lacks "${raymoval_lacks}" PARENT_SCOPE)
  endif()
endfunction()

# raymoval_need_package(NAME VERSION PACKAGE [OPTION...]): find_package. VERSION may be empty.
macro(raymoval_need_package name version package)
  find_package(${name} ${version} QUIET ${ARGN})
  if(${name}_FOUND)
    message(STATUS "Found ${name} ${${name}_VERSION}")
  endif()
  # A find_package that wants VERSION says which ones it saw and did not take.
  set(seen "")
  if(NOT ${name}_FOUND AND ${name}_CONSIDERED_VERSIONS)
    set(seen ", found ${${name}_CONSIDERED_VERSIONS}")
  endif()
  set(wanted "${version}")
  if(wanted)
    set(wanted " ${version} or later")
  endif()
  raymoval_need(${name}_FOUND "${name}${wanted}${seen}" ${package})
endmacro()

# raymoval_need_module(NAME PACKAGE MODULE...): pkg-config, as PkgConfig::NAME.
macro(raymoval_need_module name package)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(${name} QUIET IMPORTED_TARGET ${ARGN})
  endif()
  if(${name}_FOUND)
    message(STATUS "Found ${name} ${${name}_VERSION}")
  endif()
  string(REPLACE ";" ", " wanted "${ARGN}")
  raymoval_need(${name}_FOUND "${wanted}" ${package})
endmacro()

# Only octomap's ground plane needs PCL, which brings along VTK and Qt: 2.3 GB of packages.
set(RAYMOVAL_PCL AUTO CACHE STRING
    "The ground plane of octomap, which needs PCL: ON, OFF, or AUTO (if PCL is found)")
set_property(CACHE RAYMOVAL_PCL PROPERTY STRINGS AUTO ON OFF)
set(raymoval_has_pcl OFF)

# PCL only where a method says so. Its own configuration knows the folder of its headers, whose name
# has the version. It sets much else, which ends with this function.
function(raymoval_find_pcl)
  set(CMAKE_POLICY_DEFAULT_CMP0167 OLD)  # It asks for Boost by a module that CMake 3.30 retired.
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
  set(CMAKE_WARN_DEPRECATED OFF CACHE INTERNAL "")
  find_package(PCL 1.12 QUIET CONFIG COMPONENTS common sample_consensus)
  unset(CMAKE_WARN_DEPRECATED CACHE)
  set(raymoval_has_pcl ${PCL_FOUND} PARENT_SCOPE)
  set(PCL_VERSION ${PCL_VERSION} PARENT_SCOPE)
  # It also names the folders of Eigen and Boost.
  foreach(folder ${PCL_INCLUDE_DIRS})
    if(EXISTS ${folder}/pcl/point_cloud.h)
      set(RAYMOVAL_PCL_INCLUDE_DIRS ${folder} PARENT_SCOPE)
      break()
    endif()
  endforeach()
endfunction()

# The ray tracer of the simulator. Versions 3 and 4 differ in names, see
# datasets/simulation/sensor/embree.h.
macro(raymoval_find_embree)
  find_package(embree 4 QUIET CONFIG)
  if(NOT embree_FOUND)
    find_package(embree 3.12 QUIET CONFIG)
  endif()
  string(REGEX MATCH "^[0-9]+" RAYMOVAL_EMBREE "${embree_VERSION}")
endmacro()

if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux")
  list(APPEND raymoval_lacks "Linux, which this is not (${CMAKE_SYSTEM_NAME}), with prctl and /proc: \
the container of docs/platforms.md runs elsewhere")
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 11)
  list(APPEND raymoval_lacks "GCC 11 or later, found ${CMAKE_CXX_COMPILER_VERSION}: g++")
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  list(APPEND raymoval_lacks "Clang 14 or later, found ${CMAKE_CXX_COMPILER_VERSION}: clang")
endif()
find_package(PkgConfig QUIET)
raymoval_need(PKG_CONFIG_FOUND "pkg-config" "pkg-config")
raymoval_need_package(Eigen3 3.4 libeigen3-dev NO_MODULE)
raymoval_need_package(nlohmann_json 3.10 nlohmann-json3-dev)
raymoval_need_package(CLI11 2.1 libcli11-dev)
# Messages: fmt::format, by <fmt/format.h>.
raymoval_need_package(fmt 8 libfmt-dev)
raymoval_need_package(TBB "" libtbb-dev)
# Deflates the points of a report; checksums of recordings.
raymoval_need_package(ZLIB "" zlib1g-dev)
raymoval_need_package(nanoflann "" libnanoflann-dev)
raymoval_need_package(tsl-robin-map "" robin-map-dev)
raymoval_need_module(xxhash libxxhash-dev libxxhash)
# SIMD chosen at run time.
raymoval_need_module(hwy libhwy-dev libhwy)
# Compressions of recordings, and the databases that ROS 2 records to.
raymoval_need_package(BZip2 "" libbz2-dev)
raymoval_need_module(lz4 liblz4-dev liblz4)
raymoval_need_module(zstd libzstd-dev libzstd)
raymoval_need_module(sqlite3 libsqlite3-dev sqlite3)
raymoval_need_module(yaml_cpp libyaml-cpp-dev yaml-cpp)
# Archives of NumPy arrays (.npz).
raymoval_need_module(libzip libzip-dev libzip)
if(RAYMOVAL_PCL)  # ON or AUTO.
  raymoval_find_pcl()
endif()
if(RAYMOVAL_PCL AND NOT RAYMOVAL_PCL STREQUAL "AUTO")
  raymoval_need(raymoval_has_pcl "PCL 1.12 or later" libpcl-dev)
endif()
raymoval_need_package(octomap 1.9 liboctomap-dev)
raymoval_find_embree()
raymoval_need(embree_FOUND "Embree 3.12 or later, or 4" libembree-dev)
# Draws pictures.
raymoval_need_module(cairo libcairo2-dev cairo-png>=1.16 cairo-ft)
include(cmake/system_libraries.cmake)
foreach(library lzf pcl_common octomap octomath)
  set(package liblzf-dev)
  if(library MATCHES "pcl")
    set(package libpcl-dev)
  elseif(library MATCHES "octo")
    set(package liboctomap-dev)
  endif()
  if(library IN_LIST raymoval_missing_libraries)
    list(APPEND raymoval_lacks "the library ${library}: ${package}")
  endif()
endforeach()

if(RAYMOVAL_BUILD_TESTS)
  # Without a version, for Catch2 3 refuses whoever asks for 2.
  raymoval_need_package(Catch2 "" catch2)
  raymoval_need_package(rapidcheck "" librapidcheck-dev)
  if(Catch2_FOUND AND Catch2_VERSION VERSION_LESS 2.13)
    list(APPEND raymoval_lacks "Catch2 2.13 or later, or 3, found ${Catch2_VERSION}: catch2")
  endif()
endif()

if(raymoval_lacks)
  string(REPLACE ";" "\n    " told "${raymoval_lacks}")
  message(FATAL_ERROR "raymoval cannot be built here. It lacks (and Debian's package of it is):\n"
          "    ${told}\n"
          "On Debian and Ubuntu scripts/install_dependencies.sh installs all of it. Elsewhere install "
          "what your system calls these. docs/platforms.md says what was tried where.")
endif()
if(raymoval_has_pcl)
  message(STATUS "Found PCL ${PCL_VERSION}")
else()
  message(STATUS "Without PCL (RAYMOVAL_PCL is ${RAYMOVAL_PCL}): octomap has no ground plane")
endif()
message(STATUS "Found Embree ${embree_VERSION}")
