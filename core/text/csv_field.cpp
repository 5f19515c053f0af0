#include "core/text/csv_field.hpp"

#include <charconv>
#include <system_error>

#include <fmt/format.h>

namespace zerocount::text {
namespace {

/// Whether a spreadsheet reads it as a number, maybe with a percent sign.
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

}  // namespace zerocount::text
