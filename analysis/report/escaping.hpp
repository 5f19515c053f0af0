#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// Escapes texts from a manifest for the different parts of the page.
namespace zerocount::report {

/// For the text of an element or a quoted attribute: escapes & < > " '; replaces control characters other
/// than tab and line feed, and bytes that are not UTF-8, by U+FFFD.
std::string html_text(std::string_view text);

/// As html_text, without line breaks before percent signs.
std::string html_prose(std::string_view text);

/// For the content of <script type="application/json">: escapes every '<', so that the content cannot end the
/// script or open a comment. Replaces bytes that are not UTF-8 by U+FFFD; NaN and infinity become null.
std::string script_json(const nlohmann::ordered_json& json);

/// JavaScript for the content of <script>: escapes "</script" and "<!--" in its literals.
std::string script_source(std::string_view source);

}  // namespace zerocount::report
