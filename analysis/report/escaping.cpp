#include "analysis/report/escaping.hpp"

#include <cstddef>

#include "analysis/text/text.hpp"

namespace zerocount::report {
namespace {

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// As printable(), but keeps tabs and line feeds.
std::string cleaned(std::string_view text) {
  std::string clean;
  std::size_t begin = 0;
  for (std::size_t at = text.find_first_of("\n\t"); at != std::string_view::npos;
       at = text.find_first_of("\n\t", begin)) {
    clean += text::printable(text.substr(begin, at - begin));
    clean += text[at];
    begin = at + 1;
  }
  return clean + text::printable(text.substr(begin));
}

}  // namespace

std::string html_text(std::string_view text) {
  return text::escaped_markup(cleaned(text));
}

std::string html_prose(std::string_view text) {
  return replaced(html_text(text), " %", "&nbsp;%");
}

std::string script_json(const nlohmann::ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return replaced(text, "<", "\\u003c");
}

std::string script_source(std::string_view source) {
  return replaced(replaced(std::string(source), "</script", "<\\/script"), "<!--", "<\\!--");
}

}  // namespace zerocount::report
