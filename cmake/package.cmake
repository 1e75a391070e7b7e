# cpack makes a Debian package of the program, the library and its headers.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME raymoval)
set(CPACK_PACKAGE_VENDOR "The raymoval authors")
# Who answers for a package is whoever hands it out. Nobody reads an address that ends in .invalid
# (RFC 2606): it stands for packages that were made for one's own machines.
set(RAYMOVAL_PACKAGE_CONTACT "The raymoval authors <nobody@raymoval.invalid>" CACHE STRING
    "Maintainer of the Debian package, as Name <address>")
set(CPACK_PACKAGE_CONTACT "${RAYMOVAL_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
    "Runs methods that remove moving objects from LiDAR maps, scores them by published protocols
and compares the results. With the library to add a method of one's own in C++.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# What the program loads, with the versions it was linked with.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The letters of pictures.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "fonts-dejavu-core")
# What building against the library takes; a machine that only runs the program can do without.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "cmake, g++ (>= 4:11), pkg-config, libeigen3-dev,
 nlohmann-json3-dev, libtbb-dev, robin-map-dev, libxxhash-dev, libembree-dev,
 liblzf-dev, libbz2-dev, liblz4-dev, libzstd-dev, libsqlite3-dev, liboctomap-dev, libfmt-dev,
 libhwy-dev, zlib1g-dev, librsvg2-dev, libcairo2-dev")
string(REPLACE "\n" "" CPACK_DEBIAN_PACKAGE_RECOMMENDS "${CPACK_DEBIAN_PACKAGE_RECOMMENDS}")
if(raymoval_has_pcl)
  string(APPEND CPACK_DEBIAN_PACKAGE_RECOMMENDS ", libpcl-dev")
endif()
# The example of a method in Python.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-numpy")
# With the Python package there are two packages: all that has no component, and that one.
if(RAYMOVAL_PYTHON)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENTS_ALL Unspecified python)
  set(CPACK_COMPONENTS_GROUPING IGNORE)
  set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME raymoval)
  set(CPACK_COMPONENT_UNSPECIFIED_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION}")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-raymoval)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "${PROJECT_DESCRIPTION} (Python)
Cleans LiDAR maps from NumPy arrays, runs and scores methods, also those written in Python.")
  # The module fits one minor version of Python, as Debian says it.
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-tqdm")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib")
endif()
include(CPack)
