#include "runners/option_values.hpp"

#include <charconv>
#include <string>

#include <fmt/format.h>

namespace zerocount {
namespace {

/// The whole of `text` as a number, or none.
template <typename Number>
std::optional<Number> parsed(const std::string& text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

}  // namespace

std::optional<double> probability_option(const Arguments& arguments, std::string_view option) {
  const std::optional<std::string> text = arguments.value(option);
  if (!text) return std::nullopt;
  const std::optional<double> number = parsed<double>(*text);
  if (!number || !(*number > 0.0 && *number < 1.0)) {
    arguments.refuse(fmt::format("option '--{}': '{}' is no number between 0 and 1", option, *text));
  }
  return number;
}

std::vector<std::int64_t> whole_number_options(const Arguments& arguments, std::string_view option) {
  std::vector<std::int64_t> numbers;
  for (const std::string& text : arguments.values(option)) {
    const std::optional<std::int64_t> number = parsed<std::int64_t>(text);
    if (!number || *number < 0) {
      arguments.refuse(fmt::format("option '--{}': '{}' is no whole number from 0 on", option, text));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace zerocount
