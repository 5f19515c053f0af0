#include "analysis/sliding_identification/sliding_description.hpp"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "analysis/identification/estimate_description.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::sliding_identification {
namespace {

using identification::is_estimated;
using identification::ParameterEstimate;

const ParameterEstimate& parameter_of(const SlidingIdentification& identification, const std::string& name) {
  return *std::find_if(identification.parameters.begin(), identification.parameters.end(),
                       [&](const ParameterEstimate& one) { return one.name == name; });
}

parameters::AxisKind axis_of(const SlidingIdentification& identification) {
  return identification.records.front().axis;
}

std::size_t used_samples(const SlidingRecord& record) {
  std::size_t used = 0;
  for (const Window& window : record.windows) used += samples_of(window);
  return used;
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

document::Description<SlidingRecord> record_description() {
  using document::in_data;
  using Of = const SlidingRecord&;
  const auto for_people = [](const char* key, const char* heading) {
    return document::Item{
        .key = key, .heading = heading, .shown = document::Shown::to_people, .numeric = true};
  };
  return document::Description<SlidingRecord>()
      .value({"name", "record", "file, and part of it"}, [](Of r) { return text::printable(r.name); })
      .value({"samples", "samples", "samples of the record"}, [](Of r) { return r.time.size(); })
      .value({"duration", "duration", "its duration", "s"}, [](Of r) { return r.time.back(); })
      .value(in_data("resolution", "step of the readings, rad or m"), &SlidingRecord::resolution)
      .value(for_people("resolution_text", "read in steps of"),
             [](Of r) { return fmt::format("{:.3g} {}", r.resolution, parameters::unit_on(r.axis, "rad")); })
      .value(in_data("presliding_travel",
                     "travel after a standstill or a reversal in which the friction is below its level of "
                     "sliding, which was left out, rad or m"),
             &SlidingRecord::presliding_travel)
      .value(for_people("presliding_text", "left out after each reversal"),
             [](Of r) {
               return fmt::format("{:.3g} {}", r.presliding_travel, parameters::unit_on(r.axis, "rad"));
             })
      .value({"strokes", "strokes", "strokes of the record"}, [](Of r) { return r.strokes.size(); })
      .value({"windows", "windows", "windows of the fit"}, [](Of r) { return r.windows.size(); })
      .value({"used", "samples used", "samples in the windows"}, used_samples)
      .value(in_data("min_velocity", "least speed, rad/s or m/s"), &SlidingRecord::min_velocity)
      .value(in_data("max_velocity", "largest speed, rad/s or m/s"), &SlidingRecord::max_velocity)
      .value(for_people("velocities", "speeds"), [](Of r) {
        return fmt::format("{:.3g} to {:.3g} {}/s", r.min_velocity, r.max_velocity,
                           parameters::unit_on(r.axis, "rad"));
      });
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

document::AnswerDescription<SlidingIdentification> sliding_answer() {
  using document::in_data;
  using Of = const SlidingIdentification&;
  document::AnswerDescription<SlidingIdentification> answer{
      {.name = "identify-sliding",
       .meaning = "inertia and friction of an axis from its sliding motion",
       .csv_table = "parameters"},
      {}};
  answer.items
      .headline([](Of i) {
        return fmt::format("{} of {} parameters of the sliding axis are estimated",
                           std::ranges::count_if(i.parameters, is_estimated), i.parameters.size());
      })
      .value(in_data("kind", "always sliding"), [](Of) { return "sliding"; })
      .value(identification::axis_item(),
             [](Of i) { return parameters::axis_labels.at(static_cast<std::size_t>(axis_of(i))); })
      .table({.key = "parameters", .meaning = "the parameters"}, identification::estimate_description(),
             &SlidingIdentification::parameters)
      .sentence([](Of i) { return identification::missing_parameters_text(i.parameters); })
      .object(in_data("correlation", "correlation of the errors of the fitted parameters"),
              document::Description<SlidingIdentification>()
                  .value(in_data("parameters", "names, in the order of the matrix"),
                         &SlidingIdentification::correlated)
                  .value(in_data("matrix", "correlations", "1"), &SlidingIdentification::correlation),
              std::identity())
      .table({"records", "Records", "what was used of each record"}, record_description(),
             &SlidingIdentification::records)
      .value(in_data("misfit", "root mean square of the residuals, in steps of the readings"),
             &SlidingIdentification::misfit)
      .value(in_data("unexplained_torque", "its root mean square over the windows, N m or N"),
             &SlidingIdentification::unexplained_torque)
      .value(in_data("torque", "root mean square of the torque in the strokes, N m or N"),
             &SlidingIdentification::torque)
      .sentence([](Of i) {
        return fmt::format(
            "Residual rms {:.3g} steps of the readings, and {:.3g} of {:.3g} {}. The intervals allow for "
            "residuals that depend on each other within a window or a stroke.",
            i.misfit, i.unexplained_torque, i.torque, parameters::unit_on(axis_of(i), "N m"));
      })
      .value(identification::fragment_item(), sliding_fragment);
  return answer;
}

}  // namespace zerocount::sliding_identification
