#pragma once

#include <cstddef>
#include <string_view>

/// UTF-8 (RFC 3629) and what of it can be shown.
namespace zerocount::unicode {

inline constexpr char32_t replacement_character = 0xFFFD;
inline constexpr std::string_view replacement_utf8 = "\xEF\xBF\xBD";

struct CodePoint {
  char32_t value{replacement_character};
  std::size_t bytes{1};
  bool valid{false};
};

/// The code point at the start of `text` (not empty); an invalid one takes one byte. Overlong forms,
/// surrogates and values beyond U+10FFFF are invalid.
CodePoint decode(std::string_view text);

/// True for characters that do not show and change what a terminal or an editor does: the control characters
/// C0, DEL and C1, the line and paragraph separators, and those that change the direction of the text after
/// them (Unicode Standard Annex 9: embeddings, overrides and isolates), which can make a text read as
/// another.
bool is_control(char32_t value);

}  // namespace zerocount::unicode
