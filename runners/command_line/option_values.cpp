#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/text/text.hpp"
#include "experiments/study/point_label.hpp"
#include "experiments/yaml/problems.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::command_line {
namespace {

std::int64_t point_of(const Arguments& arguments, std::string_view option, const std::string& text,
                      std::span<const std::string> labels) {
  if (const auto point = study::point_named(text, labels)) return *point;
  const std::string_view near = yaml::nearest_name(text, labels);
  arguments.refuse(fmt::format(
      "option '--{}': '{}' is not a design point; expected a number from 0 to {}, or a label{}", option, text,
      std::ssize(labels) - 1, near.empty() ? "" : fmt::format(" such as '{}'", near)));
}

}  // namespace

double number_from(const Arguments& arguments, std::string_view option, std::string_view text, double least) {
  const std::optional<double> number = text::parse_number<double>(text);
  if (!number || !std::isfinite(*number) || *number < least) {
    arguments.refuse(fmt::format("option '--{}': '{}' is not a number{}", option, text,
                                 std::isfinite(least) ? fmt::format(" from {} upwards", least) : ""));
  }
  return *number;
}

std::optional<double> number_option(const Arguments& arguments, std::string_view option, double least) {
  const std::optional<std::string> text = arguments.value(option);
  return text ? std::optional(number_from(arguments, option, *text, least)) : std::nullopt;
}

Budget budget_option(const Arguments& arguments) {
  const std::optional<std::string> text = arguments.value("budget");
  if (!text) return {};
  double number = 0.0;
  const char* const end = text->data() + text->size();
  const auto [rest, error] = std::from_chars(text->data(), end, number);
  const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  const bool whole = !unit.empty() || number == std::floor(number);
  if (error != std::errc() || !(number > 0.0) || !(number < 1e12) || !whole ||
      (!unit.empty() && unit != "s" && unit != "min" && unit != "h"))
    arguments.refuse(
        fmt::format("option '--budget': '{}' is not a budget; expected a whole number, or a time such as "
                    "60s, 5min or 2h",
                    *text));
  if (unit.empty()) return {static_cast<std::int64_t>(number), std::nullopt};
  return {std::nullopt, number * (unit == "s" ? 1.0 : unit == "min" ? 60.0 : 3600.0)};
}

std::optional<double> probability_option(const Arguments& arguments, std::string_view option) {
  const std::optional<std::string> text = arguments.value(option);
  if (!text) return std::nullopt;
  const std::optional<double> number = text::parse_number<double>(*text);
  if (!number || !(*number > 0.0 && *number < 1.0)) {
    arguments.refuse(fmt::format("option '--{}': '{}' is not a number between 0 and 1", option, *text));
  }
  return number;
}

std::vector<std::int64_t> point_options(const Arguments& arguments, std::span<const std::string> labels) {
  std::vector<std::int64_t> points;
  for (const std::string& text : arguments.values("point"))
    points.push_back(point_of(arguments, "point", text, labels));
  return points;
}

std::optional<std::pair<std::int64_t, std::int64_t>> point_pair_option(const Arguments& arguments,
                                                                       std::string_view option,
                                                                       std::span<const std::string> labels) {
  const std::vector<std::string>& texts = arguments.values(option);
  if (texts.empty()) return std::nullopt;
  return std::pair(point_of(arguments, option, texts[0], labels),
                   point_of(arguments, option, texts[1], labels));
}

std::optional<std::int64_t> point_option(const Arguments& arguments, std::span<const std::string> labels) {
  const std::vector<std::int64_t> points = point_options(arguments, labels);
  return points.empty() ? std::nullopt : std::optional(points.front());
}

}  // namespace zerocount::command_line
