#include "core/text/text.hpp"

#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace zerocount::text {

double round_to_digits(double value, int digits) {
  return parse_number<double>(fmt::format("{:.{}g}", value, digits)).value_or(value);
}

namespace {

/// Whether a spreadsheet reads the text as a number, maybe with a percent sign.
bool is_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} &&
         std::string_view(end, text.data() + text.size()).find_first_not_of(" %") == std::string_view::npos;
}

}  // namespace

bool is_formula(std::string_view text) {
  if (text.empty()) return false;
  const bool is_signed = text.front() == '+' || text.front() == '-';
  return text.front() == '=' || text.front() == '@' || (is_signed && !is_number(text.substr(1)));
}

std::string csv_field(std::string_view text) {
  if (is_formula(text)) return csv_field(fmt::format("'{}", text));
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char character : text) {
    if (character == '"') quoted += '"';
    quoted += character;
  }
  return quoted + '"';
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789%+,-./:=@_";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shell_path(const std::string& path) {
  return shell_word(path.size() > 1 && path.starts_with('-') ? "./" + path : path);
}

CodePoint decode(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
  char32_t value = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    value = (value << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  if (value < least[bytes] || (value >= 0xD800 && value <= 0xDFFF) || value > 0x10FFFF) return {};
  return {value, bytes, true};
}

bool is_control(char32_t value) {
  const bool directs = (value >= 0x202A && value <= 0x202E) || (value >= 0x2066 && value <= 0x2069);
  return value < 0x20 || (value >= 0x7F && value < 0xA0) || value == 0x2028 || value == 0x2029 || directs;
}

bool is_printable(std::string_view text) {
  while (!text.empty()) {
    const CodePoint point = decode(text);
    if (!point.valid || is_control(point.value)) return false;
    text.remove_prefix(point.bytes);
  }
  return true;
}

std::string printable_lines(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const CodePoint point = decode(text);
    const bool shown =
        point.valid && (point.value == U'\n' || point.value == U'\t' || !is_control(point.value));
    result += shown ? text.substr(0, point.bytes) : replacement_utf8;
    text.remove_prefix(point.bytes);
  }
  return result;
}

}  // namespace zerocount::text
