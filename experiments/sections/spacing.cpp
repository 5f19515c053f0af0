#include "experiments/sections/spacing.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numerics/elementary_functions.hpp"
#include "core/text/number_text.hpp"

namespace zerocount::sections {
namespace {

double without_rounding_noise(double value) {
  return text::round_to_digits(value, 15);
}

double spaced(const Spacing& spacing, std::size_t i) {
  if (i == 0) return spacing.from;
  if (i + 1 == spacing.count) return spacing.to;
  const double t = static_cast<double>(i) / static_cast<double>(spacing.count - 1);
  if (!spacing.logarithmic) return without_rounding_noise(std::lerp(spacing.from, spacing.to, t));
  return without_rounding_noise(numerics::exp_of_draws(
      std::lerp(numerics::log_of_draws(spacing.from), numerics::log_of_draws(spacing.to), t)));
}

}  // namespace

std::optional<Spacing> read_spacing(const yaml::Field& field, const std::string& name, std::size_t max_values,
                                    yaml::Problems& problems) {
  const bool logarithmic = name == "logspace";
  const std::string expected = fmt::format("{}: [first value, last value, number of values]", name);
  if (!yaml::check_list(field, expected, problems)) return std::nullopt;
  if (field.node->items.size() != 3) {
    problems.add(field, fmt::format("found a list of {}", field.node->items.size()), expected);
    return std::nullopt;
  }
  const numerics::Interval range = logarithmic ? numerics::above(0.0) : numerics::all_numbers();
  const auto from = yaml::read_real(yaml::item_of(field, 0), range, problems);
  const auto to = yaml::read_real(yaml::item_of(field, 1), range, problems);
  const auto count =
      yaml::read_whole(yaml::item_of(field, 2), 2, static_cast<std::int64_t>(max_values), problems);
  if (!from || !to || !count) return std::nullopt;
  if (*from == *to) {
    problems.add(field, "the first and the last value are equal", "different values");
    return std::nullopt;
  }
  return Spacing{*from, *to, static_cast<std::size_t>(*count), logarithmic};
}

std::vector<double> spaced_values(const Spacing& spacing) {
  std::vector<double> values(spacing.count);
  for (std::size_t i = 0; i < spacing.count; ++i) values[i] = spaced(spacing, i);
  return values;
}

// Example: 2.44211e-05 for the value 2.44211060013514e-05.
std::vector<std::string> spaced_labels(const std::string& name, const std::vector<double>& values) {
  std::vector<std::string> labels;
  labels.reserve(values.size());
  for (const double value : values) labels.push_back(fmt::format("{}={:.6g}", name, value));
  if (std::adjacent_find(labels.begin(), labels.end()) == labels.end()) return labels;
  for (std::size_t i = 0; i < values.size(); ++i) labels[i] = fmt::format("{}={}", name, values[i]);
  return labels;
}

}  // namespace zerocount::sections
