#include "analysis/sensitivity/trial_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/measures/trial_value.hpp"
#include "analysis/statistics/unknown.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::sensitivity {
namespace {

/// Whether every move ran to its end, and its motion is known. Qualities, and times that may be later than
/// any, need not that.
bool is_whole(std::span<const trial::MoveOutcome> moves) {
  return std::all_of(moves.begin(), moves.end(), [](const trial::MoveOutcome& move) {
    return !move.stopped && move.outcome != trial::Outcome::nonfinite;
  });
}

SensitivityOutput output_of(const layout::Measure& measure) {
  return {.name = measure.output->name,
          .unit = measure.field.column.unit,
          .meaning = std::string(measure.output->meaning),
          .yes_or_no = layout::is_quality(measure),
          .of_every_trial = layout::is_quality(measure) || measure.values.nan_is_late,
          .never = measure.band ? "ended outside the band" : "never arrived",
          .value = [&measure](std::span<const trial::MoveOutcome> moves,
                              const std::function<double()>& duration) {
            return measures::has_targets(measure, moves) ? measures::value_of_trial(measure, moves, duration)
                                                         : statistics::unknown;
          }};
}

/// Whether all moves meet the goals, and the time that takes. @param name of one of several goals, in
/// brackets; empty of all
std::vector<SensitivityOutput> outputs_of(const goal::Question& question, const std::string& name) {
  const bool several = has_several(question);
  const std::string which = several ? "all goals" : name.empty() ? "the goal" : "this goal";
  const std::string where = several ? "the band of its goal" : "the goal's band";
  return {
      {.name = "goal" + name,
       .unit = "1",
       .meaning = several || !question.counted().on.empty()
                      ? fmt::format("all moves that {} {} about met {}", which, several ? "are" : "is",
                                    several ? "them" : "it")
                      : "all moves met the goal",
       .yes_or_no = true,
       .of_every_trial = true,
       .value = [question](std::span<const trial::MoveOutcome> moves,
                           const std::function<double()>&) { return meets(question, moves) ? 1.0 : 0.0; }},
      {.name = "goal_settling_time" + name,
       .unit = "s",
       .meaning = fmt::format("time until the error is within {} for good, the longest of the trial's moves; "
                              "a move that ends outside counts with its duration",
                              where),
       .of_every_trial = true,
       .never = "ended outside the goal's band",
       .value = [question](std::span<const trial::MoveOutcome> moves,
                           const std::function<double()>& duration) {
         const double time = settling_time(question, moves);
         return std::isfinite(time) ? time : duration();
       }}};
}

/// The outputs by which a study with a goal is judged.
std::vector<SensitivityOutput> goal_outputs(const goal::Question& question) {
  std::vector<SensitivityOutput> outputs = outputs_of(question, "");
  for (const goal::JudgedPart& part : question.parts) {
    if (!has_several(question)) break;
    std::vector<SensitivityOutput> own =
        outputs_of(only(question, part.number), fmt::format("[{}]", part.claim->name));
    std::ranges::move(own, std::back_inserter(outputs));
  }
  return outputs;
}

}  // namespace

double move_duration(const trial::TrialParameters& trial) {
  const double rate = trial.controller.sample_rate;
  return std::round(trial.command.hold * rate) / rate;
}

std::vector<SensitivityOutput> sensitivity_outputs(const layout::MeasureTable& measures,
                                                   const goal::Question& question) {
  std::vector<SensitivityOutput> outputs;
  if (question.claim()) outputs = goal_outputs(question);
  for (const layout::Measure* measure :
       layout::measures_of(measures, layout::ReportOrder::outputs,
                           [](const layout::Measure& m) { return m.output.has_value(); }))
    outputs.push_back(output_of(*measure));
  return outputs;
}

SensitivityOutput find_sensitivity_output(std::string_view name, const layout::MeasureTable& measures,
                                          const goal::Question& question) {
  std::vector<std::string> names;
  for (SensitivityOutput& output : sensitivity_outputs(measures, question)) {
    if (output.name == name) return std::move(output);
    names.push_back(std::move(output.name));
  }
  throw Failure(ExitCode::bad_input, fmt::format("there is no output '{}' of a trial; expected one of {}",
                                                 name, fmt::join(names, ", ")));
}

TrialOutputs trial_outputs(const reading::AllTrialsFile& file, const study::Study& study, std::int64_t point,
                           std::int64_t trials, const SensitivityOutput& output) {
  const layout::RowRange rows{point * file.header().trials, trials};
  TrialOutputs outputs;
  measures::visit_trials(file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
    double duration = statistics::unknown;
    // Only if a move never arrived are the parameters of its trial needed.
    const auto of_move = [&] {
      if (std::isnan(duration))
        duration = move_duration(study::study_trial(study, point, row - rows.first).parameters);
      return duration;
    };
    const bool has_value = output.of_every_trial || is_whole(moves);
    outputs.values.push_back(has_value ? output.value(moves, of_move) : statistics::unknown);
    outputs.late += !std::isnan(duration);
  });
  return outputs;
}

}  // namespace zerocount::sensitivity
