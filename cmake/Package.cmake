# What `cmake --install` and `cpack` make: a prefix that can be moved, and Debian packages of the program and of the library.
include(CMakePackageConfigHelpers)

install(DIRECTORY experiments/manifests/ DESTINATION share/zerocount/manifests COMPONENT program FILES_MATCHING PATTERN "*.yaml")
install(FILES README.md CHANGELOG.md LICENSE DESTINATION share/doc/zerocount COMPONENT program)

set(package_folder lib/cmake/zerocount)
install(EXPORT zerocount NAMESPACE zerocount:: FILE zerocount-targets.cmake DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(cmake/zerocount-config.cmake.in "${CMAKE_BINARY_DIR}/zerocount-config.cmake"
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file("${CMAKE_BINARY_DIR}/zerocount-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/zerocount-config.cmake" "${CMAKE_BINARY_DIR}/zerocount-config-version.cmake"
  DESTINATION ${package_folder} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME zerocount)
set(CPACK_PACKAGE_CONTACT "zerocount <root@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "statistics of the zero-count positioning of axes with friction")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program library development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME zerocount)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "chromium, librsvg2-bin, fonts-dejavu-core, g++")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libzerocount1)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME zerocount-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "zerocount (= ${PROJECT_VERSION}), libzerocount1 (= ${PROJECT_VERSION}), libboost-dev, libeigen3-dev, libfmt-dev, librandom123-dev, libsleef-dev, nettle-dev")
include(PythonPackage)
include(CPack)
