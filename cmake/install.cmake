# The package: `find_package(slideway CONFIG)` gives slideway::slideway.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(package ${CMAKE_INSTALL_DATADIR}/cmake/slideway)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/slidewayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(TARGETS slideway_kernel EXPORT slideway)
install(EXPORT slideway NAMESPACE slideway:: DESTINATION ${package} FILE slidewayTargets.cmake COMPONENT kernel)
install(FILES cmake/slidewayConfig.cmake ${PROJECT_BINARY_DIR}/slidewayConfigVersion.cmake
  DESTINATION ${package} COMPONENT kernel)
install(DIRECTORY kernel/slideway DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT kernel)
