#include <cmath>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text/text.hpp"
#include "experiments/keys/values.hpp"

namespace zerocount::keys {
namespace {

bool is_whole(const parameters::Parameter& parameter) {
  return parameter.kind == parameters::ParameterKind::whole_number;
}

double with_two_digits(double number) {
  return text::round_to_digits(number, 2);
}

/// The number around which the example in a message is built: the parameter's default; 0 if there is none.
double example_value(const parameters::Parameter& parameter, const parameters::StudyUnits& units) {
  if (!parameters::has_default(parameter) || !parameters::default_holds(parameter, units)) return 0.0;
  const double value = parameters::default_value(parameter);
  return parameter.none && value == *parameter.none ? 0.0 : value;
}

std::string example_distribution(const parameters::Parameter& parameter,
                                 const parameters::StudyUnits& units) {
  const double value = example_value(parameter, units);
  const double low = is_whole(parameter) ? std::round(0.8 * value) : with_two_digits(0.8 * value);
  const double high = is_whole(parameter) ? std::round(1.2 * value) : with_two_digits(1.2 * value);
  const std::string_view form = is_whole(parameter) ? "integers" : "uniform";
  const bool fits = low < high && numerics::contains(parameter.range, numerics::closed(low, high));
  if (!fits) return fmt::format("{{{}: [low, high]}}", form);
  if (is_whole(parameter))
    return fmt::format("{{{}: [{}, {}]}}", form, static_cast<std::int64_t>(low),
                       static_cast<std::int64_t>(high));
  return fmt::format("{{{}: [{}, {}]}}", form, low, high);
}

}  // namespace

std::string unit_text(const parameters::Parameter& parameter, const parameters::StudyUnits& units) {
  const std::string unit = parameters::unit_of(parameter, units);
  return unit == "1" || unit.empty() ? "" : fmt::format(", in {}", unit);
}

std::string number_alternatives(const parameters::Parameter& parameter, const parameters::StudyUnits& units) {
  return fmt::format("{}{}, or a distribution, such as {}", unit_text(parameter, units),
                     parameter.none ? ", or none" : "", example_distribution(parameter, units));
}

std::string allowed_values(const parameters::Parameter& parameter, const parameters::StudyUnits& units) {
  if (parameters::has_labels(parameter)) return fmt::format("one of {}", fmt::join(parameter.labels, ", "));
  const std::string words = numerics::range_text(parameter.range);
  const std::string noun = is_whole(parameter) ? "whole numbers" : "numbers";
  const std::string values =
      words.rfind("any", 0) == 0 ? "finite " + noun + " only" : noun + " " + words + " only";
  return values + unit_text(parameter, units);
}

std::string cure_of_normal(const distributions::Distribution& distribution,
                           const parameters::Parameter& parameter) {
  const auto* const normal = std::get_if<distributions::Normal>(&distribution);
  if (normal == nullptr || is_whole(parameter)) return {};
  const numerics::Interval& range = parameter.range;
  const auto [mean, sd] = *normal;
  if (!numerics::contains(range, mean)) return ": truncated_normal or lognormal with such values";
  double low = mean - 3.0 * sd;
  if (!numerics::contains(range, low)) low = range.low_included ? range.low : 0.99 * range.low + 0.01 * mean;
  const double high = std::min(mean + 3.0 * sd, range.high);
  std::string cure =
      fmt::format(": {{truncated_normal: {{mean: {}, sd: {}, low: {}, high: {}}}}}", mean, sd, low, high);
  if (range.low == 0.0 && std::isinf(range.high) && mean > 0.0)
    cure += fmt::format(" or {{lognormal: {{median: {}, cv: {}}}}}", mean, with_two_digits(sd / mean));
  return cure;
}

}  // namespace zerocount::keys
