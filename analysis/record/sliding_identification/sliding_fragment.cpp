#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "core/numerics/interval.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::sliding_identification {
namespace {

std::string normal_text(const ParameterEstimate& estimate, double mean) {
  return fmt::format("{{normal: {{mean: {}, sd: {}}}}}", fit::with_digits(mean, estimate),
                     fit::manifest_number(estimate.standard_error, 0.1));
}

/// Lines for the manifest's section `disturbance:` with the estimated offset torque and torque ripples.
std::string disturbance_lines(const SlidingIdentification& identification) {
  const auto parameter = [&](const std::string& name) -> const ParameterEstimate& {
    return *std::ranges::find(identification.parameters, name, &ParameterEstimate::name);
  };
  std::string text;
  const ParameterEstimate& offset = parameter("offset");
  if (is_estimated(offset))
    text += fmt::format("  torque: {}   # {}\n", normal_text(offset, -offset.value), offset.unit);
  std::string ripples;
  for (const PositionWave& wave : identification.waves) {
    if (wave.periods == 0.0 || !is_estimated(parameter(name_of(wave) + ".amplitude"))) continue;
    const ParameterEstimate& amplitude = parameter(name_of(wave) + ".amplitude");
    const ParameterEstimate& phase = parameter(name_of(wave) + ".phase");
    const double pitch = 2.0 * std::numbers::pi / wave.wave_number;
    ripples += fmt::format("    - {{amplitude: {}, {}: {:.12g}, phase: {}}}   # {}, by the angle as read\n",
                           fit::distribution_text(amplitude),
                           identification.axis == parameters::AxisKind::linear ? "pitch" : "periods",
                           identification.axis == parameters::AxisKind::linear ? pitch : wave.periods,
                           normal_text(phase, phase.value), amplitude.unit);
  }
  return text + (ripples.empty() ? "" : "  ripple:\n" + ripples);
}

}  // namespace

std::string sliding_fragment(const SlidingIdentification& identification) {
  const auto parameter = [&](std::string_view name) -> const ParameterEstimate& {
    return *std::ranges::find(identification.parameters, name, &ParameterEstimate::name);
  };
  fit::Fragment fragment;
  fragment.source = "Identified from the sliding motion in";
  for (const SlidingRecord& record : identification.records) fragment.records.push_back(record.name);
  const ParameterEstimate& offset = parameter("offset");
  fragment.remarks = "\n";
  if (is_estimated(offset)) {
    fragment.remarks += fmt::format("# A constant {} of {} {} acts against the drive: disturbance.torque.\n",
                                    parameters::text_on(identification.axis, "$torque"),
                                    fit::with_digits(offset.value, offset), offset.unit);
  }
  const auto is_open = [&](const PositionWave& wave) {
    return !is_estimated(parameter(name_of(wave) + (wave.periods == 0.0 ? "" : ".amplitude")));
  };
  if (std::ranges::any_of(identification.waves, is_open))
    fragment.remarks +=
        fmt::format("# A {} that depends on the position acts, too, and is not known well enough.\n",
                    parameters::text_on(identification.axis, "$torque"));
  fragment.plant = fit::manifest_lines(identification.parameters, "plant");
  if (!is_estimated(parameter("breakaway_level")) && is_estimated(parameter("coulomb_level"))) {
    fragment.friction = fit::manifest_line(parameter("coulomb_level"), "breakaway") +
                        "  coulomb_ratio: 1   # sliding shows no level above the Coulomb level\n";
  } else {
    fragment.friction = fit::manifest_lines(identification.parameters, "friction");
  }
  for (const PositionWave& wave : identification.waves) {
    if (wave.periods != 0.0 || is_open(wave)) continue;
    const ParameterEstimate& slope = parameter(name_of(wave));
    fragment.remarks += fmt::format("# A {} of {} {} times the position acts, too; a manifest has none.\n",
                                    parameters::text_on(identification.axis, "$torque"),
                                    fit::with_digits(slope.value, slope), slope.unit);
  }
  const std::string disturbance = disturbance_lines(identification);
  return fit::fragment_text(fragment, identification.axis) +
         (disturbance.empty() ? "" : "disturbance:\n" + disturbance);
}

}  // namespace zerocount::sliding_identification
