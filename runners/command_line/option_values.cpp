#include "runners/command_line/option_values.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/yaml/nearest_name.hpp"

namespace zerocount::command_line {
namespace {

/// Labels take precedence over indices, because a label may be a number.
std::int64_t point_named(const Arguments& arguments, std::string_view option, const std::string& text,
                         std::span<const std::string> labels) {
  const auto found = std::find(labels.begin(), labels.end(), text);
  if (found != labels.end()) return found - labels.begin();
  const std::optional<std::int64_t> number = parse_number<std::int64_t>(text);
  if (number && *number >= 0 && *number < std::ssize(labels)) return *number;
  const std::string_view near = yaml::nearest_name(text, labels);
  arguments.refuse(fmt::format(
      "option '--{}': '{}' is not a design point; expected a number from 0 to {}, or a label{}", option, text,
      std::ssize(labels) - 1, near.empty() ? "" : fmt::format(" such as '{}'", near)));
}

}  // namespace

std::optional<double> probability_option(const Arguments& arguments, std::string_view option) {
  const std::optional<std::string> text = arguments.value(option);
  if (!text) return std::nullopt;
  const std::optional<double> number = parse_number<double>(*text);
  if (!number || !(*number > 0.0 && *number < 1.0)) {
    arguments.refuse(fmt::format("option '--{}': '{}' is not a number between 0 and 1", option, *text));
  }
  return number;
}

std::vector<std::int64_t> point_options(const Arguments& arguments, std::span<const std::string> labels) {
  std::vector<std::int64_t> points;
  for (const std::string& text : arguments.values("point"))
    points.push_back(point_named(arguments, "point", text, labels));
  return points;
}

std::optional<std::pair<std::int64_t, std::int64_t>> point_pair_option(const Arguments& arguments,
                                                                       std::string_view option,
                                                                       std::span<const std::string> labels) {
  const std::vector<std::string>& texts = arguments.values(option);
  if (texts.empty()) return std::nullopt;
  return std::pair(point_named(arguments, option, texts[0], labels),
                   point_named(arguments, option, texts[1], labels));
}

std::optional<std::int64_t> point_option(const Arguments& arguments, std::span<const std::string> labels) {
  const std::vector<std::int64_t> points = point_options(arguments, labels);
  return points.empty() ? std::nullopt : std::optional(points.front());
}

}  // namespace zerocount::command_line
