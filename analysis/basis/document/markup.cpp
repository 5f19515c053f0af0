#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/text/text.hpp"
#include "core/text/text.hpp"

namespace zerocount::document {

std::string markup(std::string_view text) {
  return text::escaped_markup(text::printable_lines(text));
}

std::string prose_markup(std::string_view text) {
  constexpr std::string_view breakable = " %";
  constexpr std::string_view joined = "&nbsp;%";
  std::string prose = markup(text);
  for (std::size_t at = prose.find(breakable); at != std::string::npos;
       at = prose.find(breakable, at + joined.size()))
    prose.replace(at, breakable.size(), joined);
  return prose;
}

}  // namespace zerocount::document
