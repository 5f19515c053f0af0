#include "tests/support/marked_text.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace zerocount {

MarkedText marked_text(std::string_view text) {
  constexpr std::string_view open = "«";
  constexpr std::string_view close = "»";
  MarkedText marked;
  TextPlace here;
  std::size_t opened = 0;
  while (!text.empty()) {
    const std::size_t plain = std::min(text.find_first_of("\xc2\n"), text.size());  // 0xc2 begins a mark
    marked.text += text.substr(0, plain);
    here.column += static_cast<int>(plain);
    text.remove_prefix(plain);
    if (text.starts_with(open)) {
      marked.places.push_back(here);
      ++opened;
      text.remove_prefix(open.size());
    } else if (text.starts_with(close)) {
      if (opened == 0) throw std::invalid_argument("a mark is closed that is not open");
      --opened;
      text.remove_prefix(close.size());
    } else if (!text.empty()) {
      marked.text += text.front();
      here = text.front() == '\n' ? TextPlace{here.line + 1, 1} : TextPlace{here.line, here.column + 1};
      text.remove_prefix(1);
    }
  }
  if (opened > 0) throw std::invalid_argument("a mark is not closed");
  return marked;
}

std::string with_marks(std::string message, std::string_view name, const MarkedText& text) {
  for (std::size_t i = 0; i < text.places.size(); ++i) {
    const std::string place = fmt::format("{}:{}:{}: ", name, text.places[i].line, text.places[i].column);
    const std::string mark =
        text.places.size() == 1 ? fmt::format("{}:«»: ", name) : fmt::format("{}:«{}»: ", name, i + 1);
    for (std::size_t at = 0; (at = message.find(place, at)) != std::string::npos; at += mark.size())
      message.replace(at, place.size(), mark);
  }
  return message;
}

}  // namespace zerocount
