#pragma once

#include <string>
#include <string_view>

namespace zerocount::document {

/// Plain text for the text of an element or a quoted attribute of HTML: escapes & < > " '; replaces control
/// characters other than tab and line feed, and bytes that are not UTF-8, by U+FFFD.
std::string markup(std::string_view text);

/// As markup, without line breaks before percent signs.
std::string prose_markup(std::string_view text);

}  // namespace zerocount::document
