# Installs the Python package of runners/python for Debian's interpreter, as the component python.
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
install(FILES runners/python/_zerocount.pyi DESTINATION ${python_folder} COMPONENT python)
install(FILES "${CMAKE_BINARY_DIR}/zerocount.egg-info" RENAME zerocount-${PROJECT_VERSION}.egg-info
  DESTINATION ${python_folder} COMPONENT python)
install(TARGETS _zerocount LIBRARY DESTINATION ${python_folder} COMPONENT python)

list(APPEND CPACK_COMPONENTS_ALL python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-zerocount)
math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "zerocount (= ${PROJECT_VERSION}), python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy, python3-h5py")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas, python3-matplotlib, python3-xarray")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "jupyter, nodejs, python3-distributed, python3-openturns, python3-scipy, python3-sklearn")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "the Python package: studies, their results as tables and figures, trials in process")
