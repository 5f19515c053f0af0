#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/record/fit/presliding/identification.hpp"
#include "core/text/text.hpp"

namespace zerocount::fit {
namespace {

constexpr double two_sided_95 = 1.959963984540054;  // Φ⁻¹(0.975)

/// Whether the correlation is that between the creep parameters λ and n.
bool is_of_creep(const Identification::Correlation& pair) {
  const auto is_one = [](const std::string& name) { return name == "lambda" || name == "n"; };
  return is_one(pair.one) && is_one(pair.other);
}

/// The middle of a parameter's 95 % interval on the scale of its distribution. For n it is the mean of the
/// ends, or the value if the interval was cut at 1. For other parameters it is the geometric mean of the
/// ends.
double middle_of(const ParameterEstimate& parameter) {
  if (parameter.name != "n") return std::sqrt(parameter.low * parameter.high);
  const bool cut = parameter.low <= 1.0;  // so the middle of the rest is not the estimate
  return cut ? parameter.value : 0.5 * (parameter.low + parameter.high);
}

/// Creep described by the extension that it reaches under a torque, as the manifest's friction.measured.creep
/// does.
struct MeasuredCreep {
  /// Torque T at which the errors of ln(extension) and of the exponent n do not correlate, N m.
  double torque{0.0};
  ParameterEstimate extension, rate, exponent;
};

/// The creep as an extension under a torque, so that its parameters can be drawn independently. With x = ln
/// λ, ln(extension) = n·ln T − x. The error of ln(extension) does not correlate with that of n at ln T =
/// cov(n, x)/var(n), where its variance is var(x) − cov(n, x)²/var(n). Null if λ or n is not estimated, or if
/// their errors do not correlate strongly: λ and n are then drawn independently as well.
std::optional<MeasuredCreep> measured_creep(const Identification& found) {
  const auto estimate = [&](std::string_view name) {
    const auto place = std::ranges::find(found.parameters, name, &ParameterEstimate::name);
    const bool known = place != found.parameters.end() && place->status == EstimateStatus::estimated;
    return known ? std::optional(*place) : std::nullopt;
  };
  const auto index_of = [&](std::string_view name) {
    return std::ranges::find(found.errors.names, name) - found.errors.names.begin();
  };
  const auto alpha = estimate("alpha"), lambda = estimate("lambda"), n = estimate("n");
  if (!alpha || !lambda || !n || std::ranges::none_of(found.correlations, is_of_creep)) return std::nullopt;
  const Eigen::Index i = index_of("n"), j = index_of("lambda");
  const Eigen::MatrixXd& covariance = found.errors.covariance;
  const double slope = covariance(i, j) / covariance(i, i);
  MeasuredCreep creep{text::round_to_digits(std::exp(slope), 6), {}, *alpha, *n};
  creep.extension = *lambda;
  creep.extension.unit = parameters::unit_on(found.axis, "rad");
  creep.extension.value = std::pow(creep.torque, n->value) / lambda->value;
  const double middle = std::pow(creep.torque, middle_of(*n)) / middle_of(*lambda);
  const double sd = std::sqrt(std::max(0.0, covariance(j, j) - slope * covariance(i, j)));
  creep.extension.low = middle * std::exp(-two_sided_95 * sd);
  creep.extension.high = middle * std::exp(two_sided_95 * sd);
  return creep;
}

/// The manifest lines of friction.measured for the creep, indented for the map `friction`.
std::string creep_lines(const MeasuredCreep& creep, parameters::AxisKind axis) {
  const std::string indent = "    ";
  return fmt::format("  measured:\n{}creep:\n{}  torque: {}   # {}\n{}{}{}{}{}{}", indent, indent,
                     manifest_number(creep.torque, 1e-3), parameters::unit_on(axis, "N m"), indent,
                     manifest_line(creep.extension, "extension"), indent, manifest_line(creep.rate, "rate"),
                     indent, manifest_line(creep.exponent, "exponent"));
}

/// Whether the text of a map has a line that is not a comment. Comments alone do not form a map.
bool has_values(const std::string& lines) {
  for (std::size_t start = 0; start < lines.size(); start = lines.find('\n', start) + 1) {
    if (!lines.substr(start).starts_with("  #")) return true;
  }
  return false;
}

}  // namespace

std::string manifest_number(double value, double relative_uncertainty) {
  constexpr int min_digits = 3;
  constexpr int max_digits = 17;
  const double wanted = relative_uncertainty > 0.0 ? 3.0 - std::log10(relative_uncertainty) : max_digits;
  const int digits = static_cast<int>(std::clamp(std::ceil(wanted), double{min_digits}, double{max_digits}));
  std::string text = fmt::format("{}", text::round_to_digits(value, digits));
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  if (text.find('.') == std::string::npos) text.insert(exponent, ".0");
  return text;
}

std::string with_digits(double value, const ParameterEstimate& parameter) {
  const double width = parameter.high - parameter.low;
  if (!(width > 0.0) || value == 0.0) return fmt::format("{:g}", value);
  constexpr int min_digits = 3;
  constexpr int max_digits = 15;
  const int digits = static_cast<int>(std::ceil(std::log10(std::abs(value) / width))) + 2;
  return fmt::format("{:.{}g}", value, std::clamp(digits, min_digits, max_digits));
}

std::string distribution_text(const ParameterEstimate& parameter) {
  constexpr double small_digits = 1e-3;  // four digits are enough for a spread
  if (parameter.name == "n") {
    const double mean = middle_of(parameter);
    const double sd = (parameter.high - mean) / two_sided_95;
    if (!(sd > 0.0)) return manifest_number(mean, 0.0);
    constexpr double far = 8.0;
    return fmt::format("{{truncated_normal: {{mean: {}, sd: {}, low: 1, high: {}}}}}",
                       manifest_number(mean, sd / mean), manifest_number(sd, small_digits),
                       manifest_number(std::max(mean, 1.0) + far * sd, sd / mean));
  }
  if (parameter.name == "coulomb_ratio") {
    return fmt::format("{{truncated_normal: {{mean: {}, sd: {}, low: 0, high: 1}}}}",
                       manifest_number(parameter.value, parameter.standard_error / std::abs(parameter.value)),
                       manifest_number(parameter.standard_error, small_digits));
  }
  const double median = middle_of(parameter);
  const double spread = 0.5 * std::log(parameter.high / parameter.low) / two_sided_95;
  const double cv = std::sqrt(std::expm1(spread * spread));
  if (!(cv > 0.0)) return manifest_number(median, 0.0);
  return fmt::format("{{lognormal: {{median: {}, cv: {}}}}}", manifest_number(median, cv),
                     manifest_number(cv, small_digits));
}

std::string manifest_line(const ParameterEstimate& parameter, const std::string& name) {
  switch (parameter.status) {
    case EstimateStatus::known:
    case EstimateStatus::kept:
      return fmt::format("  {}: {}   # {}, given\n", name, manifest_number(parameter.value, 0.0),
                         parameter.unit);
    case EstimateStatus::estimated:
      return fmt::format("  {}: {}   # {}, 95 %: {} to {}\n", name, distribution_text(parameter),
                         parameter.unit, with_digits(parameter.low, parameter),
                         with_digits(parameter.high, parameter));
    case EstimateStatus::not_identifiable:
      break;
  }
  return fmt::format("  # {}: not identifiable, because {}\n", name, parameter.reason);
}

std::string manifest_lines(std::span<const ParameterEstimate> parameters, const std::string& group) {
  std::string lines;
  for (const ParameterEstimate& parameter : parameters) {
    if (parameter.key.starts_with(group + "."))
      lines += manifest_line(parameter, parameter.key.substr(group.size() + 1));
  }
  return lines;
}

std::string lack_of_fit_comment(bool explained) {
  if (explained) return "";
  return "# Lack of fit: encoder and noise do not explain the residuals; do not rely on these values.\n";
}

std::string fragment_text(const Fragment& fragment, parameters::AxisKind axis) {
  std::vector<std::string> names;
  for (const std::string& name : fragment.records) names.push_back(text::printable(name));
  std::string text =
      fmt::format("# {} {}.\n# The central 95 % of each distribution are the confidence interval.{}",
                  fragment.source, fmt::join(names, ", "), fragment.remarks);
  if (axis == parameters::AxisKind::linear) text += "axis: linear\n";
  for (const auto& [map, lines] :
       {std::pair("plant", fragment.plant), std::pair("friction", fragment.friction)})
    text += fmt::format("{}{}:\n{}", has_values(lines) ? "" : "# ", map, lines);
  return text;
}

std::string manifest_fragment(const Identification& identification) {
  std::string remarks =
      " Its median is the middle of the\n# interval, not exactly the estimate. Trials draw the parameters "
      "independently";
  const std::optional<MeasuredCreep> creep = measured_creep(identification);
  std::string pairs;
  for (const Identification::Correlation& pair : identification.correlations)
    if (!creep || !is_of_creep(pair))
      pairs += fmt::format("\n# {} and {}: {:.2f}", pair.one, pair.other, pair.value);
  if (!pairs.empty()) remarks += ", although errors correlate:" + pairs;
  if (creep)
    remarks +=
        "\n# Creep is given by its extension under a torque at which this extension and n do not correlate.";
  remarks += "\n" + lack_of_fit_comment(identification.checks.passed);
  std::vector<ParameterEstimate> parameters = identification.parameters;
  if (creep)
    std::erase_if(parameters, [](const ParameterEstimate& one) {
      return one.name == "alpha" || one.name == "lambda" || one.name == "n";
    });
  Fragment fragment{
      {}, std::move(remarks), manifest_lines(parameters, "plant"), manifest_lines(parameters, "friction")};
  if (creep) fragment.friction += creep_lines(*creep, identification.axis);
  for (const RecordSummary& record : identification.records) fragment.records.push_back(record.name);
  return fragment_text(fragment, identification.axis);
}

}  // namespace zerocount::fit
