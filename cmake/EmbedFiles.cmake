# zerocount_embed(<target> <namespace>::<function> <name>=<path> ...): embeds the unchanged bytes of files in a target, and defines
# the function std::span<const zerocount::text::EmbeddedFile> <namespace>::<function>() that lists them.
#
# The assembler includes them (.incbin), so their size and contents do not matter.
function(zerocount_embed target table_of)
  string(REGEX MATCH "^(.+)::([^:]+)$" matched "${table_of}")
  set(namespace "${CMAKE_MATCH_1}")
  set(function "${CMAKE_MATCH_2}")
  set(bytes "")
  set(symbols "")
  set(rows "")
  set(paths "")
  set(index 0)
  foreach(entry IN LISTS ARGN)
    string(REGEX MATCH "^([^=]+)=(.+)$" matched "${entry}")
    set(symbol "${target}_embedded_${index}")
    string(APPEND bytes "${symbol}:\n.incbin \"${CMAKE_MATCH_2}\"\n${symbol}_end:\n")
    string(APPEND symbols "extern const char ${symbol}[];\nextern const char ${symbol}_end[];\n")
    string(APPEND rows
      "      {\"${CMAKE_MATCH_1}\", {${symbol}, static_cast<std::size_t>(${symbol}_end - ${symbol})}},\n")
    list(APPEND paths "${CMAKE_MATCH_2}")
    math(EXPR index "${index} + 1")
  endforeach()
  set(table "${CMAKE_CURRENT_BINARY_DIR}/embedded_files_table.cpp")
  configure_file("${PROJECT_SOURCE_DIR}/cmake/embedded_files_table.cpp.in" "${table}" @ONLY)
  target_sources(${target} PRIVATE "${table}")
  set_source_files_properties("${table}" TARGET_DIRECTORY ${target} PROPERTIES OBJECT_DEPENDS "${paths}")
endfunction()
