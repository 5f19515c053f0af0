# What every target of this project has in common.
#
# zerocount_target(<target>): C++20, include paths from the repository root (`#include "core/..."`), our warnings, and
# no contraction of a·b + c into one rounding: the same source must give the same bits in every build, or the quantisers of
# the loop would turn a last-bit difference into a different count.
function(zerocount_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_include_directories(${target} PUBLIC "${CMAKE_SOURCE_DIR}")
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(ZEROCOUNT_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(ZEROCOUNT_NATIVE)
    # GCC 12 warns of its own AVX-512 intrinsics (GCC bug 105593).
    target_compile_options(${target} PRIVATE -march=native -Wno-maybe-uninitialized)
  endif()
  if(ZEROCOUNT_SANITIZE)
    # GCC 12 warns of its own <regex> where it is instrumented (GCC bug 105562).
    target_compile_options(${target} PRIVATE -fsanitize=${ZEROCOUNT_SANITIZE} -fno-omit-frame-pointer
                                             -Wno-maybe-uninitialized)
    target_link_options(${target} PUBLIC -fsanitize=${ZEROCOUNT_SANITIZE})
  endif()
endfunction()

# zerocount_unity(<target> <largest>): compiles the sources of each folder together, at most <largest> to a unit, because parsing
# headers is most of the work of the compiler. Helpers in the anonymous namespaces of one folder have distinct names for that
# reason. Sources with compile options of their own stay apart.
function(zerocount_unity target largest)
  if(NOT ZEROCOUNT_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(folder "${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "at_${folder}" group)
    list(APPEND members_${group} x)
    list(LENGTH members_${group} count)
    math(EXPR part "(${count} - 1) / ${largest}")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${group}_${part}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# zerocount_library(<name> SOURCES ... LINKS ...): one layer, as a static library zerocount_<name>.
function(zerocount_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_library(zerocount_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(zerocount_${name} PUBLIC ${ARG_LINKS})
  zerocount_target(zerocount_${name})
  zerocount_unity(zerocount_${name} 12)
endfunction()

# zerocount_test(<name> SOURCES ... LINKS ...): one GoogleTest executable, each of its tests known to CTest.
function(zerocount_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gtest_main)
  zerocount_target(${name})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
endfunction()
