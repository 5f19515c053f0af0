#include "analysis/basis/text/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/text/text.hpp"

namespace zerocount::text {
namespace {

struct CodeRange {
  char32_t first, last;
};

bool in_any(char32_t value, const auto& ranges) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [value](const CodeRange& range) { return value >= range.first && value <= range.last; });
}

/// Width on a terminal of a Unicode code point, in columns: 0, 1 or 2, from the blocks of Unicode 15 that
/// contain only combining or only wide characters.
std::size_t columns(char32_t value) {
  constexpr std::array<CodeRange, 8> combining{{{0x0300, 0x036F},
                                                {0x1AB0, 0x1AFF},
                                                {0x1DC0, 0x1DFF},
                                                {0x200B, 0x200F},
                                                {0x20D0, 0x20FF},
                                                {0xFE00, 0xFE0F},
                                                {0xFE20, 0xFE2F},
                                                {0xFEFF, 0xFEFF}}};
  constexpr std::array<CodeRange, 9> wide{{{0x1100, 0x115F},
                                           {0x2E80, 0x303E},
                                           {0x3041, 0xA4CF},
                                           {0xAC00, 0xD7A3},
                                           {0xF900, 0xFAFF},
                                           {0xFE30, 0xFE6F},
                                           {0xFF01, 0xFF60},
                                           {0x1F300, 0x1F64F},
                                           {0x20000, 0x3FFFD}}};
  if (in_any(value, combining)) return 0;
  return in_any(value, wide) ? 2 : 1;
}

}  // namespace

std::string percentage(std::int64_t successes, std::int64_t trials) {
  if (trials == 0) return "–";
  if (successes == 0) return "0 %";
  if (successes == trials) return "100 %";
  const double percent = 100.0 * static_cast<double>(successes) / static_cast<double>(trials);
  if (percent < 0.05) return "< 0.1 %";
  if (percent >= 99.95) return "> 99.9 %";
  return fmt::format("{:.1f} %", percent);
}

std::string short_number(double value) {
  return std::isnan(value) ? "–" : fmt::format("{:.{}g}", value, short_digits);
}

std::size_t display_width(std::string_view text) {
  std::size_t width = 0;
  while (!text.empty()) {
    const CodePoint point = decode(text);
    width += columns(point.value);
    text.remove_prefix(point.bytes);
  }
  return width;
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const CodePoint point = decode(text);
    const bool shown = point.valid && !is_control(point.value);
    result += shown ? text.substr(0, point.bytes) : replacement_utf8;
    text.remove_prefix(point.bytes);
  }
  return result;
}

std::string escaped_markup(std::string_view text) {
  std::string escaped;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += letter;
    }
  }
  return escaped;
}

}  // namespace zerocount::text
