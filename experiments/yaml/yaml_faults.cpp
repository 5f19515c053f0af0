#include <algorithm>
#include <cstdint>

#include <fmt/format.h>
#include <yaml-cpp/exceptions.h>

#include "core/text/text.hpp"
#include "experiments/yaml/faults.hpp"

namespace zerocount::yaml {

std::string syntax_fault(const std::string& message) {
  using namespace YAML::ErrorMsg;
  const auto starts = [&](const char* known) { return message.rfind(known, 0) == 0; };
  if (starts(MAP_VALUE)) return "unexpected ':'";
  if (starts(MAP_KEY)) return "unexpected key";
  if (starts(BLOCK_ENTRY)) return "unexpected '-'";
  if (starts(FLOW_END)) return "closing bracket without an opening one";
  if (starts(END_OF_MAP) || starts(END_OF_MAP_FLOW)) return "incomplete map (bracket, comma or indentation)";
  if (starts(END_OF_SEQ) || starts(END_OF_SEQ_FLOW)) return "incomplete list (bracket, comma or indentation)";
  if (starts(TAB_IN_INDENTATION)) return "tab in the indentation";
  if (starts(EOF_IN_SCALAR)) return "unclosed quotation mark";
  if (starts(DOC_IN_SCALAR)) return "document mark inside a quoted text";
  if (starts(INVALID_ESCAPE) || starts(INVALID_HEX) || starts(INVALID_UNICODE)) {
    return "unknown escape sequence in a quoted text";
  }
  if (starts(UNKNOWN_ANCHOR) || starts(ALIAS_NOT_FOUND) || starts(ALIAS_CONTENT)) {
    return "alias without an anchor before it";
  }
  if (starts(UNKNOWN_TOKEN)) return "unexpected character";
  return "not valid YAML from here on";
}

Place place_of(std::string_view text, std::size_t offset, std::string_view source) {
  const std::string_view before = text.substr(0, offset);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // 0 in the first line, where rfind() gives npos
  return {source, static_cast<int>(lines) + 1, static_cast<int>(offset - line_start) + 1};
}

Place first_bad_byte(const std::string& text, std::string_view source) {
  for (std::size_t at = 0; at < text.size();) {
    const text::CodePoint point = text::decode(std::string_view(text).substr(at));
    const bool blank = point.value == '\n' || point.value == '\r' || point.value == '\t';
    if (!point.valid || (text::is_control(point.value) && !blank)) return place_of(text, at, source);
    at += point.bytes;
  }
  return {source};
}

std::optional<std::string> unprintable_character(std::string_view text) {
  while (!text.empty()) {
    const text::CodePoint point = text::decode(text);
    const bool blank = point.value == '\n' || point.value == '\t';
    if (text::is_control(point.value) && !blank)
      return fmt::format("U+{:04X}", static_cast<std::uint32_t>(point.value));
    text.remove_prefix(point.bytes);
  }
  return std::nullopt;
}

}  // namespace zerocount::yaml
