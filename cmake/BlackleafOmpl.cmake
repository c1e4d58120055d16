# The target blackleaf_ompl: OMPL's headers and library. Its own package also asks for Boost's libraries, which programs
# that use it do not link and Debian does not install with it.
if(NOT TARGET blackleaf_ompl)
  find_path(BLACKLEAF_OMPL_INCLUDE_DIR ompl/config.h PATH_SUFFIXES ompl-1.5 ompl REQUIRED)
  find_library(BLACKLEAF_OMPL_LIBRARY ompl REQUIRED)
  add_library(blackleaf_ompl INTERFACE IMPORTED GLOBAL)
  target_include_directories(blackleaf_ompl SYSTEM INTERFACE ${BLACKLEAF_OMPL_INCLUDE_DIR})
  target_link_libraries(blackleaf_ompl INTERFACE ${BLACKLEAF_OMPL_LIBRARY} Eigen3::Eigen)
endif()
