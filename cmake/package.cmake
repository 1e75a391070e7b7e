# cpack makes a Debian package of each component of cmake/install.cmake: `raymoval`, `raymoval-dev`,
# and `python3-raymoval` if the build has the Python module.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME raymoval)
set(CPACK_PACKAGE_VENDOR "The raymoval authors")
# The maintainer is whoever hands a package out. An address that ends in .invalid (RFC 2606) has no
# reader: it is for packages made for one's own machines.
set(RAYMOVAL_PACKAGE_CONTACT "The raymoval authors <nobody@raymoval.invalid>" CACHE STRING
    "Maintainer of the Debian packages, as Name <address>")
set(CPACK_PACKAGE_CONTACT "${RAYMOVAL_PACKAGE_CONTACT}")
# CPack would put a summary of the project in front of each description, whose first line is the
# summary of its package.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
# The libraries that programs and modules load, in the versions that they were linked with.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME raymoval)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "${PROJECT_DESCRIPTION}
Runs methods that remove moving objects from LiDAR maps, scores them by published protocols
and compares the results.")
# The font of pictures.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS fonts-dejavu-core)
# The examples of methods: python3-numpy for those in Python, raymoval-dev for the one in C++.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-numpy, raymoval-dev")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME raymoval-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "${PROJECT_DESCRIPTION} (C++ library)
Static libraries, headers and CMake configuration, to add a method in C++ or to read, clean and
score sequences in a C++ program.")
# The packages that raymovalConfig.cmake looks for. A program that contains the benchmark reads the
# suites and published tables of the package raymoval.
set(needed "raymoval (= ${PROJECT_VERSION})" pkg-config libeigen3-dev nlohmann-json3-dev libfmt-dev
    libtbb-dev robin-map-dev libxxhash-dev libhwy-dev libembree-dev liblzf-dev libbz2-dev liblz4-dev
    libzstd-dev libsqlite3-dev libyaml-cpp-dev libzip-dev zlib1g-dev liboctomap-dev libcairo2-dev)
if(raymoval_has_pcl)
  list(APPEND needed libpcl-dev)
endif()
list(JOIN needed ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "cmake, g++ (>= 4:11)")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-raymoval)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "${PROJECT_DESCRIPTION} (Python)
Cleans LiDAR maps from NumPy arrays, runs and scores methods, also those written in Python.")
if(RAYMOVAL_PYTHON)
  # The module fits one minor version of Python, in Debian's notation.
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-tqdm)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib")
endif()
include(CPack)
