# Installs the Python package of runners/python for Debian's interpreter, as the component python.
file(STRINGS runners/python/zerocount/version.py version REGEX "^VERSION = ")
if(NOT version STREQUAL "VERSION = \"${PROJECT_VERSION}\"")
  message(FATAL_ERROR "runners/python/zerocount/version.py has another version than project(): ${version}")
endif()
file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/zerocount.egg-info" CONTENT "Metadata-Version: 2.1
Name: zerocount
Version: ${PROJECT_VERSION}
Summary: statistics of the zero-count positioning of axes with friction
Requires-Dist: numpy
Requires-Dist: h5py
")
set(python_folder lib/python3/dist-packages)
install(DIRECTORY runners/python/zerocount DESTINATION ${python_folder} COMPONENT python
  FILES_MATCHING PATTERN "*.py" PATTERN "py.typed")
install(FILES "${CMAKE_BINARY_DIR}/zerocount.egg-info" RENAME zerocount-${PROJECT_VERSION}.egg-info
  DESTINATION ${python_folder} COMPONENT python)

list(APPEND CPACK_COMPONENTS_ALL python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-zerocount)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "zerocount (= ${PROJECT_VERSION}), libzerocount1 (= ${PROJECT_VERSION}), python3 (>= 3.10), python3-numpy, python3-h5py")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas, python3-matplotlib, python3-xarray")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "jupyter, nodejs, python3-distributed, python3-openturns, python3-scipy, python3-sklearn")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "the Python package: studies, their results as tables and figures, trials in process")
