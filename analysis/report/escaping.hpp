#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// What may come from a manifest, made harmless for the place in the page where it stands.
namespace zerocount {

/// As the text of an element or a quoted attribute: & < > " ' escaped; control characters other than tab and
/// line feed, and bytes that are not UTF-8, replaced by U+FFFD.
std::string html_text(std::string_view text);

/// html_text of a sentence, in which no line breaks before a percent sign.
std::string html_prose(std::string_view text);

/// As the content of <script type="application/json">: no '<' is left in it, so that nothing in it can end
/// the script or open a comment. Bytes that are not UTF-8 are replaced by U+FFFD; NaN and infinity are null.
std::string script_json(const nlohmann::ordered_json& json);

/// JavaScript as the content of <script>: "</script" and "<!--" in its literals are written another way.
std::string script_source(std::string_view source);

}  // namespace zerocount
