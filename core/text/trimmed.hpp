#pragma once

#include <cstddef>
#include <string_view>

namespace zerocount::text {

/// The text without these characters at both ends.
constexpr std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\n\v\f\r") {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return text.substr(0, 0);
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

}  // namespace zerocount::text
