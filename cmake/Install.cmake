# install() and the exported package: find_package(blackleaf) gives blackleaf::blackleaf (everything but foreign file
# formats and planning); find_package(blackleaf COMPONENTS io) adds blackleaf::io, which needs ITK, GDCM, libtiff,
# libpng, toml++, assimp and Cairo; COMPONENTS plan adds blackleaf::plan, which needs OMPL.
include(CMakePackageConfigHelpers)

add_library(blackleaf INTERFACE)
add_library(blackleaf::blackleaf ALIAS blackleaf)
target_link_libraries(blackleaf INTERFACE
  blackleaf::octree blackleaf::build blackleaf::motion blackleaf::contact blackleaf::draw blackleaf::plot
  blackleaf::file)

install(TARGETS blackleaf blackleaf_octree blackleaf_build blackleaf_motion blackleaf_contact blackleaf_draw blackleaf_plot
  blackleaf_file
  EXPORT blackleafTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS blackleaf_io EXPORT blackleafIoTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS blackleaf_plan EXPORT blackleafPlanTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/blackleaf DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/licenses/blackleaf)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/blackleaf)
install(EXPORT blackleafTargets NAMESPACE blackleaf:: DESTINATION ${package_dir})
install(EXPORT blackleafIoTargets NAMESPACE blackleaf:: DESTINATION ${package_dir})
install(EXPORT blackleafPlanTargets NAMESPACE blackleaf:: DESTINATION ${package_dir})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/blackleafConfig.cmake.in
  ${PROJECT_BINARY_DIR}/blackleafConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/blackleafConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/blackleafConfig.cmake ${PROJECT_BINARY_DIR}/blackleafConfigVersion.cmake
  ${CMAKE_CURRENT_LIST_DIR}/BlackleafOmpl.cmake DESTINATION ${package_dir})
