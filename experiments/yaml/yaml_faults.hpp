#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "experiments/yaml/problems.hpp"

namespace zerocount::yaml {

/// Translates the message of a yaml-cpp exception for readers who do not know the YAML specification.
std::string syntax_fault(const std::string& message);

/// The place of a byte of `text`.
Place place_of(std::string_view text, std::size_t offset, std::string_view source);

/// The first place in `text` that is not UTF-8, or is a control character; line 0 if there is none.
Place first_bad_byte(const std::string& text, std::string_view source);

/// The first control character of a scalar, which an escape sequence can name, as "U+001B"; nothing if there
/// is none. Line feeds and tabs are allowed.
std::optional<std::string> unprintable_character(std::string_view text);

}  // namespace zerocount::yaml
