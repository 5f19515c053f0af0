# Functions that define the targets of this project.

# What a target is optimised for. trial: the loops of a trial; -O3, by the build type. numbers: statistics, draws, files. text:
# manifests, tables, pages, commands, and most tests: compiling them takes longer than running them.
set(zerocount_optimisation_numbers -O2)
set(zerocount_optimisation_text -Og)

# zerocount_target(<target> <optimisation>): sets the options of all targets: C++20, warnings, and no contraction of a·b + c into a
# fused operation. Every build must give the same bits, because the quantisers of the loop turn a last-bit difference into a
# different count.
function(zerocount_target target optimisation)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion)
  # Clang also warns of a local name that a constant of another file in the same unity build has.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wshadow>)
  target_compile_options(${target} PUBLIC -ffp-contract=off)
  # libzerocount.so is a shared library of the same objects. Nothing replaces their functions when it is loaded, so that they may be
  # inlined.
  target_compile_options(${target} PRIVATE -fPIC -fno-semantic-interposition)
  # Boost would compute in long double, by the x87 unit of the processor.
  target_compile_definitions(${target} PRIVATE BOOST_MATH_PROMOTE_DOUBLE_POLICY=false)
  if(ZEROCOUNT_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  # GCC searches its memory for garbage less often, for which units take some 300 MB more. The value is in kB.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
  if(DEFINED zerocount_optimisation_${optimisation})
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${zerocount_optimisation_${optimisation}}>)
  endif()
  if(ZEROCOUNT_NATIVE)
    # GCC 12 warns about its own AVX-512 intrinsics (GCC bug 105593); the option depends on the optimisation level.
    target_compile_options(${target} PRIVATE -march=native $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
                                             -Wno-uninitialized)
  endif()
  if(ZEROCOUNT_SANITIZE)
    set(sanitizers -fsanitize=${ZEROCOUNT_SANITIZE} -fno-sanitize-recover=all)
    set(level -O1)
    if(target MATCHES "tests?$")
      set(level -O0)
    endif()
    # Beyond this a sanitized build takes several times longer, and finds no more. GCC 12 warns about its own <regex> if it is
    # instrumented (GCC bug 105562).
    target_compile_options(${target} PRIVATE ${sanitizers} -fno-omit-frame-pointer ${level} -g1
                                             $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS ZEROCOUNT_SANITIZED)
    target_link_options(${target} PUBLIC ${sanitizers})
  endif()
  if(ZEROCOUNT_COVERAGE)
    # Threads may lose counts of one another. With atomic counts, or without optimisation, the tests take hours.
    target_compile_options(${target} PRIVATE --coverage -O1)
    target_link_options(${target} PUBLIC --coverage)
  endif()
endfunction()

# zerocount_precompiled(<name> <header> <optimisation> <library>...): a precompiled header for targets of this optimisation. Only for
# GCC, with which it is tried. ccache needs the option of the preprocessor.
function(zerocount_precompiled name header optimisation)
  if(NOT ZEROCOUNT_PRECOMPILED)
    return()
  endif()
  set(source "${CMAKE_BINARY_DIR}/precompiled/${name}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT "")
  add_library(zerocount_precompiled_${name} OBJECT "${source}")
  target_link_libraries(zerocount_precompiled_${name} PRIVATE ${ARGN})
  zerocount_target(zerocount_precompiled_${name} ${optimisation})
  target_compile_options(zerocount_precompiled_${name} PRIVATE -fpch-preprocess)
  target_precompile_headers(zerocount_precompiled_${name} PRIVATE "${CMAKE_SOURCE_DIR}/${header}")
endfunction()

# zerocount_use_precompiled(<target> <name>): lets a target use that precompiled header where there is one.
function(zerocount_use_precompiled target name)
  if(TARGET zerocount_precompiled_${name})
    target_precompile_headers(${target} REUSE_FROM zerocount_precompiled_${name})
    target_compile_options(${target} PRIVATE -fpch-preprocess)
  endif()
endfunction()

# zerocount_units(<variable> <largest> <source>...): combines sources to unity builds of at most <largest> files. A unit is a
# generated file that includes the sources by their path from the repository root, so that headers, most of the compiler's work, are
# parsed once per unit. Therefore names in the anonymous namespaces of one folder must be distinct. The units do not depend on the
# path of the repository, so that all checkouts share the ccache.
function(zerocount_units variable largest)
  if(NOT ZEROCOUNT_UNITY)
    set(${variable} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  file(RELATIVE_PATH name "${CMAKE_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  string(MAKE_C_IDENTIFIER "${name}" name)
  set(files "")
  set(index 0)
  foreach(source IN LISTS ARGN)
    math(EXPR part "${index} / ${largest}")
    math(EXPR index "${index} + 1")
    file(RELATIVE_PATH path "${CMAKE_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}/${source}")
    string(APPEND text_${part} "#include \"${path}\"\n")
  endforeach()
  foreach(number RANGE ${part})
    set(file "${CMAKE_CURRENT_BINARY_DIR}/${variable}/${name}_${number}.cpp")
    file(CONFIGURE OUTPUT "${file}" CONTENT "${text_${number}}" @ONLY)
    list(APPEND files "${file}")
  endforeach()
  set(${variable} ${files} PARENT_SCOPE)
endfunction()

# zerocount_includes(<target> <visibility> <folder>): lets a target include the headers of one folder only, by their path from
# the repository root: the include directory contains only a symbolic link to the folder. Other headers come with the linked
# targets.
function(zerocount_includes target visibility folder)
  string(MAKE_C_IDENTIFIER "${folder}" name)
  set(root "${CMAKE_BINARY_DIR}/include/${name}")
  get_filename_component(parent "${root}/${folder}" DIRECTORY)
  file(MAKE_DIRECTORY "${parent}")
  file(CREATE_LINK "${CMAKE_SOURCE_DIR}/${folder}" "${root}/${folder}" SYMBOLIC)
  target_include_directories(${target} ${visibility} "$<BUILD_INTERFACE:${root}>")
endfunction()

# zerocount_install(<target> <folder>): installs a folder of core as a library that others can link: its headers are found by their
# path from the repository root, as here.
function(zerocount_install target folder)
  string(REPLACE "/" "::" name "${folder}")
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${target} EXPORT zerocount COMPONENT development
    ARCHIVE COMPONENT development INCLUDES DESTINATION include/zerocount)
  install(DIRECTORY "${CMAKE_SOURCE_DIR}/${folder}" DESTINATION "include/zerocount/core" COMPONENT development
    FILES_MATCHING PATTERN "*.hpp")
endfunction()

# zerocount_folder([NUMBERS] SOURCES ... [ALONE ...] LINKS ...): makes the folder of this CMakeLists.txt a library; core/friction becomes the
# target zerocount::core::friction. NUMBERS: compiled with -O2, because a command takes more than 5 % longer without it. ALONE: sources with
# their own compile options. Measured without -O2 in one folder: record/fit and record/sliding_identification, `experiment` 1.44 and
# `identify --sliding` 3.2 times as long; experiments/rules, `tune` 1.10. Without it in all folders: `judge` 2.3, `learn` 2.1, `summary` of
# 100 000 points 1.25, `compare` 1.13.
function(zerocount_folder)
  cmake_parse_arguments(ARG "NUMBERS" "" "SOURCES;ALONE;LINKS" ${ARGN})
  file(RELATIVE_PATH folder "${CMAKE_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  string(MAKE_C_IDENTIFIER "zerocount_${folder}" target)
  string(REPLACE "/" "::" alias "zerocount::${folder}")
  if(ARG_SOURCES)
    zerocount_units(units 20 ${ARG_SOURCES})
    add_library(${target} STATIC ${units} ${ARG_ALONE})
    target_link_libraries(${target} PUBLIC ${ARG_LINKS})
    set(optimisation text)
    if(folder MATCHES "^core/")
      set(optimisation trial)
    elseif(ARG_NUMBERS)
      set(optimisation numbers)
    endif()
    zerocount_target(${target} ${optimisation})
    zerocount_use_precompiled(${target} ${optimisation})
    zerocount_includes(${target} PUBLIC "${folder}")
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${ARG_LINKS})
    zerocount_includes(${target} INTERFACE "${folder}")
  endif()
  add_library(${alias} ALIAS ${target})
  if(folder MATCHES "^core/")
    zerocount_install(${target} "${folder}")
  endif()
endfunction()

# zerocount_layer(<folder>...): adds the folders of a layer, lowest first, with the rooms in them (tuning/race), and a target for all of them, such as zerocount::core.
function(zerocount_layer)
  get_filename_component(layer "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
  add_library(zerocount_${layer} INTERFACE)
  add_library(zerocount::${layer} ALIAS zerocount_${layer})
  foreach(folder IN LISTS ARGN)
    add_subdirectory(${folder})
    string(REPLACE "/" "::" name "${layer}/${folder}")
    target_link_libraries(zerocount_${layer} INTERFACE zerocount::${name})
  endforeach()
endfunction()

# zerocount_test(<name> [THREADED] SOURCES ... [ALONE ...] LINKS ...): one GoogleTest executable; each of its suites is a CTest test,
# <suite>, or <suite>.<name> where another executable has a suite of that name. A suite is one process, because most tests take less
# time than a start of the program; it prints what fails. Tests named DISABLED_, which take long, are together the long
# test Long.<name>. THREADED: the thread sanitizer runs them too; the target threaded_tests builds them.
function(zerocount_test name)
  cmake_parse_arguments(ARG "THREADED" "" "SOURCES;ALONE;LINKS" ${ARGN})
  zerocount_units(${name}_units 10 ${ARG_SOURCES})
  add_executable(${name} ${${name}_units} ${ARG_ALONE})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gtest_main)
  zerocount_target(${name} text)
  zerocount_use_precompiled(${name} tests)
  target_compile_options(${name} PRIVATE -Wno-shadow)  # for constants of test files in the same unit
  set(properties TIMEOUT 600)
  if(ZEROCOUNT_SANITIZE)
    set(properties TIMEOUT 3000)
  endif()
  if(ARG_THREADED)
    list(APPEND properties LABELS threads)
    add_dependencies(threaded_tests ${name})
  endif()
  set(suites "")
  set(disabled FALSE)
  foreach(source IN LISTS ARG_SOURCES ARG_ALONE)
    get_filename_component(source "${source}" ABSOLUTE)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${source}")
    file(STRINGS "${source}" declarations REGEX "^(TYPED_)?TEST(_F|_P|_EACH_SEED)?\\(")
    foreach(declaration IN LISTS declarations)
      if(declaration MATCHES "^[A-Z_]+\\(([A-Za-z0-9_]+),")
        list(APPEND suites "${CMAKE_MATCH_1}")
      endif()
    endforeach()
    if(declarations MATCHES "DISABLED_")
      set(disabled TRUE)
    endif()
  endforeach()
  list(REMOVE_DUPLICATES suites)
  get_property(known GLOBAL PROPERTY zerocount_suites)
  set_property(GLOBAL APPEND PROPERTY zerocount_suites ${suites})
  set(others "")
  foreach(suite IN LISTS suites)
    set(tests "${suite}.*:*/${suite}.*:${suite}/?.*:*/${suite}/?.*")  # not ${suite}/Other.*, of which it is the prefix
    string(APPEND others ":${tests}")
    set(test "${suite}")
    if(suite IN_LIST known)
      set(test "${suite}.${name}")
    endif()
    add_test(NAME ${test} COMMAND ${name} --gtest_brief=1 "--gtest_filter=${tests}")
    set_tests_properties(${test} PROPERTIES ${properties})
  endforeach()
  # None, unless a suite is declared in another way than those above.
  add_test(NAME Others.${name} COMMAND ${name} --gtest_brief=1 "--gtest_filter=-${others}")
  set_tests_properties(Others.${name} PROPERTIES ${properties})
  if(disabled)
    zerocount_long_test(${name} COMMAND ${name} --gtest_also_run_disabled_tests --gtest_filter=*DISABLED_*)
  endif()
endfunction()

# zerocount_long_test(<name> COMMAND ...): the CTest test Long.<name>, which only `ctest -C long -L long` runs.
function(zerocount_long_test name)
  add_test(NAME Long.${name} ${ARGN} CONFIGURATIONS long)
  set_tests_properties(Long.${name} PROPERTIES LABELS long TIMEOUT 7200)
endfunction()
