#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/identification/estimate_json.hpp"
#include "analysis/sliding_identification/sliding_identification.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::sliding_identification {
namespace {

using identification::EstimateStatus;
using identification::ParameterEstimate;
using Json = nlohmann::ordered_json;

const ParameterEstimate& parameter_of(const SlidingIdentification& identification, const std::string& name) {
  return *std::find_if(identification.parameters.begin(), identification.parameters.end(),
                       [&](const ParameterEstimate& one) { return one.name == name; });
}

bool is_estimated(const ParameterEstimate& parameter) {
  return parameter.status == EstimateStatus::estimated;
}

std::string record_line(const SlidingSummary& record, bool linear) {
  const char* length = linear ? "m" : "rad";
  return fmt::format(
      "  {}: {} samples, {:.4g} s, read in steps of {:.3g} {}\n"
      "    {} samples in {} windows of {} strokes were used, at {:.3g} to {:.3g} {}/s\n",
      text::printable(record.name), record.samples, record.duration, record.resolution, length, record.used,
      record.windows, record.strokes, record.min_velocity, record.max_velocity, length);
}

std::string ratio_text(const ParameterEstimate& ratio) {
  constexpr double spread_uncertainty = 1e-3;  // four digits are enough for a spread
  return fmt::format(
      "{{truncated_normal: {{mean: {}, sd: {}, low: 0, high: 1}}}}",
      identification::manifest_number(ratio.value, ratio.standard_error / std::abs(ratio.value)),
      identification::manifest_number(ratio.standard_error, spread_uncertainty));
}

std::string fragment_line(const ParameterEstimate& parameter, const std::string& name) {
  if (!is_estimated(parameter) || parameter.name != "coulomb_ratio")
    return identification::manifest_line(parameter, name);
  return fmt::format("  {}: {}   # {}, 95 %: {} to {}\n", name, ratio_text(parameter), parameter.unit,
                     identification::with_digits(parameter.low, parameter),
                     identification::with_digits(parameter.high, parameter));
}

/// If sliding shows no level above the Coulomb level, the breakaway torque is taken to be the Coulomb level.
std::string friction_lines(const SlidingIdentification& identification) {
  const ParameterEstimate& breakaway = parameter_of(identification, "breakaway_level");
  const ParameterEstimate& coulomb = parameter_of(identification, "coulomb_level");
  if (is_estimated(breakaway) || !is_estimated(coulomb)) {
    return fragment_line(breakaway, "breakaway") +
           fragment_line(parameter_of(identification, "coulomb_ratio"), "coulomb_ratio") +
           fragment_line(parameter_of(identification, "stribeck_velocity"), "stribeck_velocity");
  }
  return fragment_line(coulomb, "breakaway") +
         "  coulomb_ratio: 1   # sliding shows no level above the Coulomb level\n";
}

}  // namespace

std::string sliding_fragment(const SlidingIdentification& identification) {
  std::string text = "# Identified from the sliding motion in";
  for (const SlidingSummary& record : identification.records) {
    text += fmt::format("{} {}", &record == &identification.records.front() ? "" : ",", record.name);
  }
  text += ".\n# The central 95 % of each distribution are the confidence interval.\n";
  const ParameterEstimate& offset = parameter_of(identification, "offset");
  if (is_estimated(offset)) {
    text += fmt::format("# A constant {} of {} {} acts against the drive; a manifest has none.\n",
                        identification.linear ? "force" : "torque",
                        identification::with_digits(offset.value, offset), offset.unit);
  }
  if (identification.linear) text += "axis: linear\n";
  const auto group = [&](const std::string& name, const std::string& lines) {
    const bool any = lines.find("\n  ") != std::string::npos || !lines.starts_with("  #");
    text += (any ? "" : "# ") + name + ":\n" + lines;
  };
  group("plant", fragment_line(parameter_of(identification, "inertia"), "inertia") +
                     fragment_line(parameter_of(identification, "sliding_damping"), "sliding_damping"));
  group("friction", friction_lines(identification));
  return text;
}

std::string sliding_text(const SlidingIdentification& identification) {
  const char* torque_unit = identification.linear ? "N" : "N m";
  std::vector<std::vector<std::string>> cells{identification::estimate_heads()};
  for (const ParameterEstimate& parameter : identification.parameters)
    cells.push_back(identification::estimate_row(parameter));
  std::string text = "Sliding axis: inertia and friction from its motion\n\n" +
                     text::aligned_table(cells, {false, true, false, true, true, false}) + "\n";
  for (const ParameterEstimate& parameter : identification.parameters) {
    if (is_estimated(parameter)) continue;
    text += fmt::format("{} is not identifiable from this, because {}.\n", parameter.name, parameter.reason);
  }
  text += "Records:\n";
  for (const SlidingSummary& record : identification.records)
    text += record_line(record, identification.linear);
  text += fmt::format(
      "The model leaves {:.3g} steps of the readings, and {:.3g} of {:.3g} {} (root mean squares).\n"
      "The intervals allow for residuals that depend on each other within a window or a stroke.\n",
      identification.misfit, identification.unexplained_torque, identification.torque, torque_unit);
  return text + "\nTo paste into a manifest:\n\n" + sliding_fragment(identification);
}

std::string sliding_json(const SlidingIdentification& identification) {
  Json json;
  json["kind"] = "sliding";
  json["axis"] = identification.linear ? "linear" : "rotary";
  json["parameters"] = Json::array();
  for (const ParameterEstimate& parameter : identification.parameters) {
    json["parameters"].push_back(identification::estimate_json(parameter));
  }
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < identification.correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < identification.correlation.cols(); ++j) {
      row.push_back(identification.correlation(i, j));
    }
    rows.push_back(row);
  }
  json["correlation"] = {{"parameters", identification.correlated}, {"matrix", rows}};
  json["records"] = Json::array();
  for (const SlidingSummary& record : identification.records) {
    json["records"].push_back({{"name", text::printable(record.name)},
                               {"samples", record.samples},
                               {"duration", record.duration},
                               {"resolution", record.resolution},
                               {"strokes", record.strokes},
                               {"windows", record.windows},
                               {"used", record.used},
                               {"min_velocity", record.min_velocity},
                               {"max_velocity", record.max_velocity}});
  }
  json["misfit"] = identification.misfit;
  json["unexplained_torque"] = identification.unexplained_torque;
  json["torque"] = identification.torque;
  json["manifest"] = sliding_fragment(identification);
  return json.dump(2) + "\n";
}

}  // namespace zerocount::sliding_identification
