#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "analysis/record/experiment_design/experiment_design.hpp"
#include "analysis/record/fit/report.hpp"
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

/// Text of the levels and durations of the holds that follow the pulses: "0.0892 N m held for 1.75 s".
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

/// Sentences on the parameters that the designed record does not determine, or not on all machines, and on a
/// lack of fit.
std::string limits_text(const ExperimentDesign& design) {
  std::string text;
  for (const ExpectedParameter& parameter : design.parameters) {
    if (!parameter.found.reason.empty()) {
      text += fmt::format("{} cannot be identified from this record, because {}.\n", parameter.key,
                          parameter.found.reason);
    } else if (parameter.told < design.machines) {
      text += fmt::format("{} can be identified on only {} of {} machines.\n", parameter.key, parameter.told,
                          design.machines);
    }
  }
  if (!design.identification.checks.passed)
    text += fmt::format(
        "LACK OF FIT: {}.\nThe manifest has effects that identify does not model; the intervals allow for "
        "them.\n",
        fit::reason_of_misfit(design.identification.checks));
  return text;
}

/// The command line of `identify` for the file that the axis will record, with the options that follow from
/// the manifest.
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

std::string headline_of(const ExperimentDesign& design) {
  const auto told = std::ranges::count_if(
      design.parameters, [](const ExpectedParameter& one) { return is_estimated(one.found); });
  return fmt::format("{:g} s of {} identify {} of {} parameters of {}", seconds(design, design.frame.samples),
                     parameters::text_on(design.frame.axis, "$torque"), told, design.parameters.size(),
                     design.study);
}

std::string protocol_text(const ExperimentDesign& design) {
  return fmt::format("{} to command, {} samples of {:g} s, from 0 to 0 {}:\n{}",
                     parameters::text_on(design.frame.axis, "$torque"), design.frame.samples,
                     design.frame.sample_time, torque_unit(design), parts_text(design));
}

std::string safety_text(const ExperimentDesign& design) {
  return fmt::format(
      "On {} machines of {} none breaks away (the weakest at {:.3g} {}), and none travels beyond {:.3g} {}.\n"
      "The best of {} protocols{}.",
      design.machines, design.study, design.least_breakaway, torque_unit(design), design.travel,
      parameters::unit_on(design.frame.axis, "rad"), design.search.protocols,
      design.search.converged ? "" : "; a larger --budget may find a better one");
}

document::Description<ExpectedParameter> expected_description() {
  using document::in_data;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  return document::Description<ExpectedParameter>()
      .value({"key", "parameter", "dotted path in a manifest"}, &ExpectedParameter::key)
      .value({"guess", "guess", "value of the median machine, in the unit"}, &ExpectedParameter::guess)
      .value({"unit", "unit", "unit of the parameter"}, &ExpectedParameter::unit)
      .value(
          with_words(in_data("status", "whether the record determines it"),
                     {"estimated", "not_identifiable"}),
          [](const ExpectedParameter& p) { return is_estimated(p.found) ? "estimated" : "not_identifiable"; })
      .value(in_data("low", "lower end of the 95 % interval to expect"),
             [](const ExpectedParameter& p) { return p.found.low; })
      .value(in_data("high", "its upper end"), [](const ExpectedParameter& p) { return p.found.high; })
      .value(fit::for_people("interval", "expected 95 % interval"),
             [](const ExpectedParameter& p) { return fit::interval_text(p.found); })
      .value(fit::for_people("width", "±"),
             [](const ExpectedParameter& p) -> std::optional<std::string> {
               if (!is_estimated(p.found)) return {};
               return percent(p.found.half_width() / p.guess);
             })
      .value(in_data("told", "machines on which the record determines it"), &ExpectedParameter::told)
      .value(in_data("narrowest", "least half-width of the interval over the machines, relative", "1"),
             [=](const ExpectedParameter& p) { return p.told > 0 ? p.narrowest : unknown; })
      .value(in_data("widest", "largest half-width of the interval over the machines, relative", "1"),
             [=](const ExpectedParameter& p) { return p.told > 0 ? p.widest : unknown; })
      .value(fit::for_people("widths", "± over the machines"),
             [](const ExpectedParameter& p) -> std::optional<std::string> {
               if (p.told == 0) return {};
               return fmt::format("{} to {}", percent(p.narrowest), percent(p.widest));
             })
      .value(in_data("reason", "why the record does not determine it; empty: it does"),
             [](const ExpectedParameter& p) { return p.found.reason; });
}

}  // namespace

document::Description<ExperimentDesign> design_description() {
  using document::in_data;
  return document::Description<ExperimentDesign>()
      .headline(headline_of)
      .value(in_data("name", "name of the study"), &ExperimentDesign::study)
      .value(with_words(in_data("axis", "kind of axis"),
                        {parameters::axis_labels.begin(), parameters::axis_labels.end()}),
             [](const ExperimentDesign& d) {
               return parameters::axis_labels.at(static_cast<std::size_t>(d.frame.axis));
             })
      .value(in_data("sample_time", "time between samples", "s"),
             [](const ExperimentDesign& d) { return d.frame.sample_time; })
      .value(in_data("samples", "samples of the record"),
             [](const ExperimentDesign& d) { return d.frame.samples; })
      .value(in_data("max_torque", "largest torque or force, N m or N"),
             [](const ExperimentDesign& d) { return d.frame.max_torque; })
      .value(in_data("least_breakaway", "least breakaway of the machines, N m or N"),
             &ExperimentDesign::least_breakaway)
      .value(in_data("travel", "largest distance from the start on any machine, rad or m"),
             &ExperimentDesign::travel)
      .value(in_data("machines", "machines on which it is safe"), &ExperimentDesign::machines)
      .value(in_data("protocols", "protocols that were tried"),
             [](const ExperimentDesign& d) { return d.search.protocols; })
      .value(in_data("converged", "whether no change of the protocol was better"),
             [](const ExperimentDesign& d) { return d.search.converged; })
      .value(in_data("residuals_passed", "whether identify explains the simulated record"),
             [](const ExperimentDesign& d) { return d.identification.checks.passed; })
      .sentence(protocol_text)
      .sentence(safety_text)
      .table(in_data("segments", "parts of the record"),
             document::Description<ProtocolSegment>()
                 .value(in_data("to", "torque or force to which it leads linearly, N m or N"),
                        &ProtocolSegment::to)
                 .value(in_data("samples", "its samples"), &ProtocolSegment::samples),
             &ExperimentDesign::segments)
      .table({.key = "parameters", .meaning = "what to expect of each parameter"}, expected_description(),
             &ExperimentDesign::parameters)
      .sentence(limits_text)
      .value({.key = "identify",
              .heading = "Then, with the recorded counts beside it",
              .meaning = "the command that identifies the record",
              .verbatim = true},
             identify_command);
}

}  // namespace zerocount::experiment_design
