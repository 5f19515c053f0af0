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

parameters::AxisKind axis_of(const SlidingIdentification& identification) {
  return identification.records.front().axis;
}

std::size_t used_samples(const SlidingRecord& record) {
  std::size_t used = 0;
  for (const Window& window : record.windows) used += samples_of(window);
  return used;
}

std::string record_line(const SlidingRecord& record) {
  const std::string length = parameters::unit_on(record.axis, "rad");
  return fmt::format(
      "  {}: {} samples, {:.4g} s, read in steps of {:.3g} {}\n"
      "    {} samples in {} windows of {} strokes were used, at {:.3g} to {:.3g} {}/s{}\n",
      text::printable(record.name), record.time.size(), record.time.back(), record.resolution, length,
      used_samples(record), record.windows.size(), record.strokes.size(), record.min_velocity,
      record.max_velocity, length,
      record.presliding_travel > 0.0
          ? fmt::format(
                ";\n    the first {:.3g} {} after a standstill or a reversal were left out, where the "
                "friction is below its level of sliding",
                record.presliding_travel, length)
          : "");
}

std::string fragment_line(const SlidingIdentification& identification, const std::string& parameter,
                          const std::string& name) {
  return identification::manifest_line(parameter_of(identification, parameter), name);
}

/// If sliding shows no level above the Coulomb level, the breakaway torque is taken to be the Coulomb level.
std::string friction_lines(const SlidingIdentification& identification) {
  if (!is_estimated(parameter_of(identification, "breakaway_level")) &&
      is_estimated(parameter_of(identification, "coulomb_level"))) {
    return fragment_line(identification, "coulomb_level", "breakaway") +
           "  coulomb_ratio: 1   # sliding shows no level above the Coulomb level\n";
  }
  return fragment_line(identification, "breakaway_level", "breakaway") +
         fragment_line(identification, "coulomb_ratio", "coulomb_ratio") +
         fragment_line(identification, "stribeck_velocity", "stribeck_velocity");
}

}  // namespace

std::string sliding_fragment(const SlidingIdentification& identification) {
  std::string text = "# Identified from the sliding motion in";
  for (const SlidingRecord& record : identification.records) {
    text += fmt::format("{} {}", &record == &identification.records.front() ? "" : ",", record.name);
  }
  text += ".\n# The central 95 % of each distribution are the confidence interval.\n";
  const ParameterEstimate& offset = parameter_of(identification, "offset");
  if (is_estimated(offset)) {
    text += fmt::format("# A constant {} of {} {} acts against the drive; a manifest has none.\n",
                        parameters::text_on(axis_of(identification), "$torque"),
                        identification::with_digits(offset.value, offset), offset.unit);
  }
  if (axis_of(identification) == parameters::AxisKind::linear) text += "axis: linear\n";
  const auto group = [&](const std::string& name, const std::string& lines) {
    const bool any = lines.find("\n  ") != std::string::npos || !lines.starts_with("  #");
    text += (any ? "" : "# ") + name + ":\n" + lines;
  };
  group("plant", fragment_line(identification, "inertia", "inertia") +
                     fragment_line(identification, "sliding_damping", "sliding_damping"));
  group("friction", friction_lines(identification));
  return text;
}

std::string sliding_text(const SlidingIdentification& identification) {
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
  for (const SlidingRecord& record : identification.records) text += record_line(record);
  text += fmt::format(
      "The model leaves {:.3g} steps of the readings, and {:.3g} of {:.3g} {} (root mean squares).\n"
      "The intervals allow for residuals that depend on each other within a window or a stroke.\n",
      identification.misfit, identification.unexplained_torque, identification.torque,
      parameters::unit_on(axis_of(identification), "N m"));
  return text + "\nTo paste into a manifest:\n\n" + sliding_fragment(identification);
}

std::string sliding_json(const SlidingIdentification& identification) {
  Json json;
  json["kind"] = "sliding";
  json["axis"] = parameters::axis_labels[static_cast<std::size_t>(axis_of(identification))];
  json["parameters"] = Json::array();
  for (const ParameterEstimate& parameter : identification.parameters) {
    json["parameters"].push_back(identification::estimate_json(parameter));
  }
  json["correlation"] = {{"parameters", identification.correlated}, {"matrix", identification.correlation}};
  json["records"] = Json::array();
  for (const SlidingRecord& record : identification.records) {
    json["records"].push_back({{"name", text::printable(record.name)},
                               {"samples", record.time.size()},
                               {"duration", record.time.back()},
                               {"resolution", record.resolution},
                               {"presliding_travel", record.presliding_travel},
                               {"strokes", record.strokes.size()},
                               {"windows", record.windows.size()},
                               {"used", used_samples(record)},
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
