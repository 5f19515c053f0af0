#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace zerocount::text {

/// U+FFFD, the replacement character.
inline constexpr std::string_view replacement_utf8 = "\xEF\xBF\xBD";

struct CodePoint {
  char32_t value{0xFFFD};
  std::size_t bytes{1};
  bool valid{false};
};

/// The code point at the start of `text` (not empty); an invalid one takes one byte. Overlong forms,
/// surrogates and values beyond U+10FFFF are invalid (RFC 3629).
CodePoint decode(std::string_view text);

/// True for the control characters C0, DEL and C1, the line and paragraph separators, and the characters that
/// change the direction of the text after them (Unicode Standard Annex 9: embeddings, overrides and
/// isolates), which can make a text read as another.
bool is_control(char32_t value);

/// True if `text` is UTF-8 without control characters.
bool is_printable(std::string_view text);

/// `text` with each control character but line feeds and tabs, and each byte that is not UTF-8, replaced by
/// U+FFFD. For messages that repeat what a file or the user says.
std::string printable_lines(std::string_view text);

}  // namespace zerocount::text
