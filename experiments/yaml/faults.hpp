#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "experiments/yaml/problems.hpp"

namespace zerocount::yaml {

/// Translates the message of a yaml-cpp exception for readers who do not know the YAML specification.
std::string syntax_fault(const std::string& message);

/// The place (line and column) in `text` of the byte at this offset.
Place place_of(std::string_view text, std::size_t offset, std::string_view source);

/// The first place in `text` that is not UTF-8, or is a control character; line 0 if there is none.
Place first_bad_byte(const std::string& text, std::string_view source);

/// The first control character of a scalar as text, "U+001B"; empty if there is none. An escape sequence can
/// produce such a character. Line feeds and tabs are allowed.
std::optional<std::string> unprintable_character(std::string_view text);

/// A fault of a YAML text that the parser yaml-cpp 0.7 accepts, or reports far behind its cause.
struct LexicalFault {
  std::size_t offset{0};  ///< offset of the fault's first byte in the text
  std::string_view what;
  std::string_view expected;
};

/// The first fault of the following kinds in a YAML document; empty if there is none:
/// - a quoted text that does not end, ends among the lines of other keys, or is followed by more text on its
///   line. YAML requires each further line of a quoted text to be indented more than the key or list entry to
///   which it belongs, and a key to stand on one line;
/// - a tab in the indentation of a line in block style;
/// - a line in block style, at the indentation of keys, that is not a key with a colon and a blank.
std::optional<LexicalFault> first_lexical_fault(std::string_view text);

}  // namespace zerocount::yaml
