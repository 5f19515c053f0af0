#include "analysis/trials/sensitivity/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/sums/moments.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/measures/trial_value.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/move_measures.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/study/group_inputs.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "results/layout/header.hpp"

namespace zerocount::sensitivity {
namespace {

/// Whether every move of a trial ran to its end and stayed finite. Outputs that are yes or no do not need
/// this, nor do times for which "later than any" is a possible value.
bool is_whole(std::span<const trial::MoveOutcome> moves) {
  return std::all_of(moves.begin(), moves.end(), [](const trial::MoveOutcome& move) {
    return !move.stopped && move.outcome != trial::Outcome::nonfinite;
  });
}

/// Duration of a move of a trial in a closed loop, s: the hold time of the command, rounded to whole samples.
double move_duration(const trial::TrialParameters& trial) {
  const double rate = trial.controller.sample_rate;
  return std::round(trial.command.hold * rate) / rate;
}

SensitivityOutput output_of(const layout::Measure& measure) {
  return {.name = measure.output->name,
          .unit = measure.field.column.unit,
          .meaning = std::string(measure.output->meaning),
          .yes_or_no = layout::is_quality(measure),
          .of_every_trial = layout::is_quality(measure) || measure.values.missing == layout::Missing::late,
          .never = measure.band ? "ended outside the band" : "never arrived",
          .value = [&measure](std::span<const trial::MoveOutcome> moves,
                              const std::function<double()>& duration) {
            return measures::has_targets(measure, moves) ? measures::value_of_trial(measure, moves, duration)
                                                         : statistics::unknown;
          }};
}

/// The two outputs of a goal: whether all judged moves meet it, and the time that this takes.
/// @param name name of the goal in brackets, such as [large], if there are several; empty for all goals
std::vector<SensitivityOutput> outputs_of(const goal::Question& question, const std::string& name) {
  const bool several = has_several(question);
  const std::string which = several ? "all goals" : name.empty() ? "the goal" : "this goal";
  const std::string where = several ? "the band of its goal" : "the goal's band";
  return {
      {.name = "goal" + name,
       .unit = "1",
       .meaning = several || !question.criterion().on.empty()
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

/// The sensitivity outputs that belong to a study's goals: those of all goals together, then those of each
/// named goal.
std::vector<SensitivityOutput> goal_outputs(const goal::Question& question) {
  std::vector<SensitivityOutput> outputs = outputs_of(question, "");
  for (const goal::JudgedCriterion& part : question.parts) {
    if (!has_several(question)) break;
    std::vector<SensitivityOutput> own =
        outputs_of(only(question, part.number), fmt::format("[{}]", part.goal->name));
    std::ranges::move(own, std::back_inserter(outputs));
  }
  return outputs;
}

std::vector<SensitivityOutput> outputs_asked(const SensitivityQuestion& question,
                                             const layout::MeasureTable& measures,
                                             const goal::Question& of_study) {
  std::vector<SensitivityOutput> outputs;
  for (const std::string& name : question.outputs)
    outputs.push_back(find_sensitivity_output(name, measures, of_study));
  if (outputs.empty()) {
    outputs = sensitivity_outputs(measures, of_study);
    outputs.resize(2);
  }
  return outputs;
}

// Beyond the highest, resampling would have to go on for minutes to find the bounds.
void check_confidence(double confidence) {
  constexpr double highest = 0.999;
  if (confidence > 0.0 && confidence <= highest) return;
  throw Failure(ExitCode::bad_input,
                fmt::format("a confidence of {}; expected one above 0 and at most {}", confidence, highest));
}

/// Number of trials of a design point that are read, from the first on. A saltelli design is always read as a
/// whole, because its indices need all rows.
std::int64_t trials_read(const study::Study& study, const SensitivityQuestion& question) {
  if (study.design == study::Design::saltelli) return study.trials;
  return std::min(study.trials, std::max(question.max_trials, study.machines));
}

PointInputs point_inputs(const reading::AllTrialsFile& file, std::int64_t point, bool in_setting,
                         std::int64_t trials) {
  const study::Study& study = file.study();
  PointInputs inputs{.design = study.design,
                     .factors = study.factors,
                     .inputs = {},
                     .correlated = study::has_dependent_parameters(study),
                     .machines = study.machines,
                     .subject = study.worlds > 0 ? Subject::trials_in_worlds : Subject::trials};
  const std::vector<study::WorldValues> of_worlds = study::world_values(study, point);
  const auto is_of_world = [&](const std::string& name) {
    return std::ranges::any_of(of_worlds, [&](const study::WorldValues& one) { return one.name == name; });
  };
  const layout::RowRange rows{point * file.header().trials, trials};
  for (std::size_t column = 0; column < file.input_columns().size(); ++column) {
    if (in_setting && !study::differs_in_setting(study, column)) continue;
    const std::string& name = file.input_columns()[column].name;
    if (!is_of_world(name)) inputs.inputs.push_back({name, file.input(column, rows)});
  }
  return inputs;
}

/// Inputs for a sensitivity analysis between worlds (a world is one draw of what all machines share and
/// nobody knows): one value per world in place of one per trial.
PointInputs inputs_of_worlds(const study::Study& study, std::int64_t point) {
  PointInputs inputs{.design = study::Design::latin_hypercube,
                     .factors = {},
                     .inputs = {},
                     .correlated = study::has_dependent_parameters(study),
                     .subject = Subject::worlds};
  for (study::WorldValues& one : study::world_values(study, point))
    inputs.inputs.push_back({std::move(one.name), std::move(one.values)});
  return inputs;
}

/// Mean output of each world (one draw of what all machines share), and the proportion of the trials'
/// variance that lies between worlds.
struct WorldMeans {
  TrialOutputs means;  ///< [world] Mean output over the trials of the world; NaN if none has a value.
  double between{statistics::unknown};
};

/// Mean output of each world, and the proportion σ²_b/(σ²_b + σ²_w) of the trials' variance that lies between
/// worlds, as for a random effect: σ²_b = (MS_b − MS_w)/n, at least 0, is the variance between the worlds,
/// σ²_w that within them (Searle, Casella and McCulloch, Variance Components, 1992, section 3.6).
WorldMeans means_of_worlds(const study::Study& study, const TrialOutputs& trials) {
  std::vector<statistics::Moments> worlds(static_cast<std::size_t>(study.worlds));
  for (std::size_t i = 0; i < trials.values.size(); ++i) {
    if (std::isfinite(trials.values[i]))
      worlds[static_cast<std::size_t>(
                 study::group_of(study, study::Grouping::world, static_cast<std::int64_t>(i)))]
          .add(trials.values[i]);
  }
  WorldMeans result;
  statistics::Moments of_means;
  double within = 0.0;
  double trials_used = 0.0;
  double degrees = 0.0;
  for (const statistics::Moments& world : worlds) {
    const auto size = static_cast<double>(world.n);
    result.means.values.push_back(world.n > 0 ? world.mean : statistics::unknown);
    if (world.n < 2) continue;
    of_means.add(world.mean);
    within += world.sd() * world.sd() * (size - 1.0);
    degrees += size - 1.0;
    trials_used += size;
  }
  if (of_means.n < 2 || degrees == 0.0) return result;
  const double of_trial = within / degrees;
  const double each = trials_used / static_cast<double>(of_means.n);
  const double of_world = std::max(0.0, of_means.sd() * of_means.sd() - of_trial / each);
  if (of_world + of_trial > 0.0) result.between = of_world / (of_world + of_trial);
  return result;
}

/// Sensitivity of each world's mean output to the parameters that differ between worlds (draws of what all
/// machines share and nobody knows).
OutputSensitivity between_worlds(const study::Study& study, const PointInputs& worlds,
                                 const SensitivityOutput& output, const TrialOutputs& trials,
                                 double confidence, const random::RandomStream& bootstrap) {
  const WorldMeans means = means_of_worlds(study, trials);
  OutputSensitivity result = output_sensitivity(worlds, output, means.means, confidence, bootstrap);
  result.of_worlds = true;
  result.output += "_between_worlds";
  result.meaning = fmt::format("mean over the trials of each world; {}", result.meaning);
  result.notes.insert(
      result.notes.begin(),
      fmt::format("{} of the variance of the trials is between worlds",
                  std::isnan(means.between) ? "an unknown part" : text::percent_near(means.between)));
  return result;
}

/// The user's question, with the outputs and the random stream that are the same for every design point of a
/// study.
struct PointQuestion {
  const SensitivityQuestion& question;
  std::vector<SensitivityOutput> outputs;
  /// Random stream that selects the resampled trials, the same for all outputs and points, because their
  /// trials are the same.
  random::RandomStream bootstrap;
  std::function<void()> done;  ///< Called after each output of each point, to report progress.
};

/// Sensitivity of all requested outputs at one design point, in one setting (a condition at an age) if there
/// are any.
/// @param file results of the trials in this setting
PointSensitivity sensitivity_at(const reading::AllTrialsFile& file, const measures::PointInSetting& place,
                                const PointQuestion& asked) {
  const study::Study& study = file.study();
  const std::int64_t point = place.point;
  const std::int64_t trials = trials_read(study, asked.question);
  const PointInputs inputs = point_inputs(file, point, place.setting.has_value(), trials);
  const PointInputs worlds = inputs_of_worlds(study, point);
  const double confidence = asked.question.confidence;
  PointSensitivity at_point{place, {}};
  const auto add = [&](OutputSensitivity result) {
    result.unit = parameters::unit_on(study.units.axis, result.unit);
    result.meaning = parameters::text_on(study.units.axis, result.meaning);
    at_point.outputs.push_back(std::move(result));
  };
  for (const SensitivityOutput& output : asked.outputs) {
    const TrialOutputs values = trial_outputs(file, study, point, trials, output);
    OutputSensitivity result = output_sensitivity(inputs, output, values, confidence, asked.bootstrap);
    if (trials < study.trials && study.machines == 0)
      result.notes.push_back(fmt::format("the first {} of {} trials are used", trials, study.trials));
    add(std::move(result));
    if (study.worlds > 0) add(between_worlds(study, worlds, output, values, confidence, asked.bootstrap));
    asked.done();
  }
  return at_point;
}

}  // namespace

std::vector<SensitivityOutput> sensitivity_outputs(const layout::MeasureTable& measures,
                                                   const goal::Question& question) {
  std::vector<SensitivityOutput> outputs;
  if (question.goal()) outputs = goal_outputs(question);
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
  if (const std::string_view meanings = trial::meanings_of_settling_time(name); !meanings.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("the output '{}' may mean two measures; expected {}", name, meanings));
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

StudySensitivity study_sensitivity(const reading::AllTrialsFile& file, const SensitivityQuestion& question) {
  check_confidence(question.confidence);
  const layout::FileHeader& header = file.header();
  const study::Study& study = file.study();
  StudySensitivity sensitivity{.name = header.name,
                               .from_saltelli = study.design == study::Design::saltelli,
                               .confidence = question.confidence,
                               .points = {}};
  PointQuestion asked{.question = question,
                      .outputs = outputs_asked(question, file.table(), goal::question_of(study)),
                      .bootstrap = {designs::random_key(header.seed, "sensitivity/bootstrap"), 0},
                      .done = {}};
  const std::int64_t points =
      question.points.empty() ? study::point_count(study) : std::ssize(question.points);
  const std::int64_t all = study.settings.total() * points * std::ssize(asked.outputs);
  asked.done = [&, done = std::int64_t{0}]() mutable {
    if (question.progress) question.progress(++done, all);
  };
  sensitivity.points = measures::at_points<PointSensitivity>(
      file, question.points, [&](const reading::AllTrialsFile& one, const measures::PointInSetting& place) {
        return sensitivity_at(one, place, asked);
      });
  return sensitivity;
}

bool any_estimated(const StudySensitivity& sensitivity) {
  return std::any_of(sensitivity.points.begin(), sensitivity.points.end(), [](const auto& point) {
    return std::any_of(point.outputs.begin(), point.outputs.end(),
                       [](const OutputSensitivity& output) { return output.estimated; });
  });
}

}  // namespace zerocount::sensitivity
