#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "analysis/experiment_design/experiment_design.hpp"
#include "analysis/text/text.hpp"
#include "core/loop/encoder.hpp"

namespace zerocount::experiment_design {
namespace {

std::string torque_unit(const ExperimentDesign& design) {
  return parameters::unit_on(design.frame.axis, "N m");
}

std::string percent(double relative) {
  return fmt::format("{:.2g} %", 100.0 * relative);
}

double seconds(const ExperimentDesign& design, std::int64_t samples) {
  return static_cast<double>(samples) * design.frame.sample_time;
}

/// "0.0892 N m held for 1.75 s": the holds behind the pulses.
std::string holds_text(const ExperimentDesign& design) {
  std::string text;
  const auto edges = static_cast<std::size_t>(2 * pulses_in(design.shape, design.frame));
  for (std::size_t i = 1 + 2 * edges; i + 1 < design.segments.size(); ++i) {
    const ProtocolSegment& segment = design.segments[i];
    if (segment.to != design.segments[i - 1].to) continue;
    text += fmt::format("  {:.3g} {} held for {:.3g} s\n", segment.to, torque_unit(design),
                        seconds(design, segment.samples));
  }
  return text;
}

std::string parts_text(const ExperimentDesign& design) {
  const ProtocolShape& shape = design.shape;
  const std::string unit = torque_unit(design);
  const std::string pulses = fmt::format(
      "  {} pulses of {:.3g} {}, {:.3g} s for the ringing after each edge\n", pulses_in(shape, design.frame),
      shape.pulse * design.frame.max_torque, unit, seconds(design, design.frame.ring_down_samples));
  const std::string ramps =
      fmt::format("  a ramp to {:.3g} {} and {:g} reversals, each to {:g} times the one before\n",
                  shape.amplitude * design.frame.max_torque, unit, shape.reversals, shape.nesting);
  const std::string holds = holds_text(design);
  return pulses + (shape.holds_first > 0.5 ? holds + ramps : ramps + holds);
}

std::vector<std::string> row_of(const ExpectedParameter& parameter) {
  const identification::ParameterEstimate& found = parameter.found;
  const bool told = found.status == identification::EstimateStatus::estimated;
  return {parameter.key,
          fmt::format("{:.4g}", parameter.guess),
          parameter.unit,
          told ? fmt::format("{} to {}", with_digits(found.low, found), with_digits(found.high, found)) : "–",
          told ? percent(0.5 * (found.high - found.low) / parameter.guess) : "–",
          parameter.told > 0
              ? fmt::format("{} to {}", percent(parameter.narrowest), percent(parameter.widest))
              : "–"};
}

/// Sentences on the parameters that the record does not determine, or not on all machines, and on a lack of
/// fit.
std::string limits_text(const ExperimentDesign& design) {
  std::string text;
  for (const ExpectedParameter& parameter : design.parameters) {
    if (!parameter.found.reason.empty()) {
      text += fmt::format("{} cannot be told from this record, because {}.\n", parameter.key,
                          parameter.found.reason);
    } else if (parameter.told < design.machines) {
      text += fmt::format("{} can be told on {} of {} machines only.\n", parameter.key, parameter.told,
                          design.machines);
    }
  }
  if (!design.identification.checks.passed)
    text += fmt::format(
        "LACK OF FIT: {}.\nThe manifest has effects that identify does not model; the intervals allow for "
        "them.\n",
        record_fit::reason_of_misfit(design.identification.checks));
  return text;
}

/// The command that identifies what the axis records, with the options that the manifest tells.
std::string identify_command(const ExperimentDesign& design) {
  const trial::TrialParameters& machine = design.median.parameters;
  const double count = loop::fine_resolution(machine.encoder);
  std::string command = "zerocount identify recorded.csv";
  command += design.frame.axis == parameters::AxisKind::linear
                 ? fmt::format(" --resolution {:.10g}", count)
                 : fmt::format(" --counts-per-revolution {:.10g}", 2.0 * std::numbers::pi / count);
  if (machine.controller.delay > 0.0) command += fmt::format(" --delay {:g}", machine.controller.delay);
  if (machine.amplifier.bandwidth > 0.0)
    command += fmt::format(" --amplifier-bandwidth {:g}", machine.amplifier.bandwidth);
  return command;
}

}  // namespace

std::string design_text(const ExperimentDesign& design) {
  const std::string unit = torque_unit(design);
  const std::string torque = parameters::text_on(design.frame.axis, "$torque");
  std::string text = fmt::format("{} to command, {:g} s in {} samples of {:g} s, from 0 to 0 {}:\n{}", torque,
                                 seconds(design, design.frame.samples), design.frame.samples,
                                 design.frame.sample_time, unit, parts_text(design));
  text += fmt::format(
      "On {} machines of {} none breaks away (the weakest at {:.3g} {}), and none travels beyond {:.3g} {}.\n"
      "The best of {} protocols{}.\n\n",
      design.machines, design.study, design.least_breakaway, unit, design.travel,
      parameters::unit_on(design.frame.axis, "rad"), design.search.protocols,
      design.search.converged ? "" : "; a larger --budget may find a better one");
  std::vector<std::vector<std::string>> cells{
      {"parameter", "guess", "unit", "expected 95 % interval", "±", "± over the machines"}};
  for (const ExpectedParameter& parameter : design.parameters) cells.push_back(row_of(parameter));
  text += text::aligned_table(cells, {false, true, false, true, true, true}) + "\n";
  text += limits_text(design);
  return text + fmt::format("\nThen, with the recorded counts beside the {}:\n  {}\n",
                            parameters::text_on(design.frame.axis, "$torque"), identify_command(design));
}

}  // namespace zerocount::experiment_design
