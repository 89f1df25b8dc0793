# What `cmake --install` puts in place: the program with the parts that it opens late, and for other programs the libraries,
# headers and the package of `find_package(canyon COMPONENTS gnss)`. Nothing in it names the folder that it was installed in: the program finds its
# parts by the way from its own folder to theirs (core/process/library_part.h), so all of it may be moved together.
include(CMakePackageConfigHelpers)

install(TARGETS canyon RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS canyon_flags canyon_geographiclib EXPORT canyon)
set_target_properties(canyon_flags PROPERTIES EXPORT_NAME flags)
foreach(folder IN ITEMS core scene gnss inertial lidar fusion mission study report)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/canyon FILES_MATCHING PATTERN "*.h")
endforeach()

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/canyon)
install(EXPORT canyon NAMESPACE canyon:: FILE canyonTargets.cmake DESTINATION ${package})
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/canyonConfig.cmake.in ${CMAKE_BINARY_DIR}/generated/canyonConfig.cmake
                              INSTALL_DESTINATION ${package})
# Nothing is promised between versions before 1.0.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/canyonConfigVersion.cmake COMPATIBILITY ExactVersion)
install(FILES ${CMAKE_BINARY_DIR}/generated/canyonConfig.cmake ${CMAKE_BINARY_DIR}/generated/canyonConfigVersion.cmake DESTINATION ${package})
