# Libraries that have no CMake configuration of their own, one that drags in VTK and Qt (PCL), or one
# that names files by absolute path (OctoMap). Read by the build and by the installed configuration:
# what links to these targets tells no path of the machine it was built on. `raymoval_has_pcl` says
# whether the library was built with PCL.
set(raymoval_missing_libraries "")
set(raymoval_libraries octomap octomath lzf)
if(raymoval_has_pcl)
  list(APPEND raymoval_libraries pcl_common)
endif()
foreach(name ${raymoval_libraries})
  if(NOT TARGET raymoval::${name})
    find_library(RAYMOVAL_${name}_LIBRARY ${name})
    mark_as_advanced(RAYMOVAL_${name}_LIBRARY)
    if(RAYMOVAL_${name}_LIBRARY)
      add_library(raymoval::${name} UNKNOWN IMPORTED)
      set_target_properties(raymoval::${name} PROPERTIES
                            IMPORTED_LOCATION "${RAYMOVAL_${name}_LIBRARY}")
    else()
      list(APPEND raymoval_missing_libraries ${name})
    endif()
  endif()
endforeach()
