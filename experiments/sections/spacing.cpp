#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/numerics/elementary_functions.hpp"
#include "core/text/text.hpp"
#include "experiments/sections/sections.hpp"

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

shapes::Shape spacing_shape(bool logarithmic) {
  const std::string_view name = logarithmic ? "logspace" : "linspace";
  const shapes::Shape end = shapes::real(logarithmic ? numerics::above(0.0) : numerics::all_numbers());
  const std::string expected = fmt::format("{}: [first value, last value, number of values]", name);
  return shapes::of(shapes::Shape::Form::tuple, {name, "", expected}, expected,
                    {end, end, shapes::whole(2, static_cast<std::int64_t>(max_points))});
}

std::optional<Spacing> read_spacing(const yaml::Field& field, bool logarithmic, yaml::Problems& problems) {
  if (!shapes::read(field, spacing_shape(logarithmic), problems)) return std::nullopt;
  const std::vector<yaml::Field> values = shapes::items_of(field);
  const Spacing spacing{shapes::number_of(values[0]), shapes::number_of(values[1]),
                        shapes::whole_of<std::size_t>(values[2]), logarithmic};
  if (spacing.from != spacing.to) return spacing;
  problems.add(field, "the first and the last value are equal", "different values");
  return std::nullopt;
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
