# Writes the header OUTPUT with the commit of the checkout SOURCE_DIR, at every build, touching it only when that changes.
# Without git, outside a checkout or before the first commit the commit is "unknown".
set(commit "unknown")
find_program(GIT git)
if(GIT AND EXISTS "${SOURCE_DIR}/.git")
  execute_process(
    COMMAND "${GIT}" -C "${SOURCE_DIR}" describe --always --dirty --abbrev=40 --exclude=*
    OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE result)
  if(result EQUAL 0 AND described)
    set(commit "${described}")
  endif()
endif()
set(text "#pragma once\n\n#define ZEROCOUNT_GIT_COMMIT \"${commit}\"\n")
set(previous "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" previous)
endif()
if(NOT text STREQUAL previous)
  file(WRITE "${OUTPUT}" "${text}")
endif()
