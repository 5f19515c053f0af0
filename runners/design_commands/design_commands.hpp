#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/trials/goal/question.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/rare/rare_run.hpp"
#include "runners/trials/effort.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

/// Commands for the design of an axis: plan, tune, limits, worst and rare. The file also has their answers
/// for the report, and common functions.
namespace zerocount::design_commands {

/// A study, and the design point that a command examines.
struct ExaminedPoint {
  /// Study restricted to the condition and the age of the options `--condition` and `--age`.
  study::Study study;
  std::int64_t point{0};  ///< Index of the design point that is examined.
  study::Study whole;     ///< Study with all settings (conditions at ages), not restricted by options.

  /// Converts the number of a trial of `study` to the number that this trial has in `whole`.
  std::int64_t trial_in_whole(std::int64_t trial) const;
};

/// Index of the design point that the option `--point` names, or of the only point of the study.
/// @throws Failure (bad_input) if the study has several points and none is named
std::int64_t named_point(const command_line::Arguments& arguments, const study::Study& study);

/// Study and design point that the operand `MANIFEST|FILE` and the options `--set`, `--point`, `--condition`
/// and `--age` name.
/// @throws Failure (bad_input) without targets, or as named_point() and trials::restricted_to()
ExaminedPoint point_to_examine(const command_line::Arguments& arguments);

/// Option `--set KEY=VALUE`, which overrides values, of commands with a manifest.
command_line::OptionSpec set_option();

/// Option `--condition`, which restricts the examined study to one condition (point_to_examine()).
command_line::OptionSpec condition_option();
/// Option `--age`, which restricts the examined study to one age (point_to_examine()).
command_line::OptionSpec age_option();

/// Option `--point`, which names the examined design point (named_point()).
command_line::OptionSpec named_point_option();

/// Runs `work` and returns its result.
/// @throws Failure (interrupted) if `work` throws trial::Interrupted
template <class Work>
auto unless_interrupted(const Work& work) {
  try {
    return work();
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was written");
  }
}

/// Description of an answer's item for a proportion, which people are shown as a percentage, and data as a
/// number from 0 to 1.
inline document::Item proportion(std::string key, std::string heading, std::string meaning) {
  document::Item item = document::everywhere(std::move(key), std::move(heading), std::move(meaning), "1");
  item.notation = document::Notation::percent;
  return item;
}

/// The item, changed so that JSON has no member for it if it has no content.
inline document::Item optional(document::Item item) {
  item.optional = true;
  return item;
}

/// Columns for the names of the goal and the setting (condition at an age) of a claim. Columns without a
/// heading are in data only.
document::Description<tuning::ClaimNames> named_claim_columns(std::string goal_heading = "",
                                                              std::string condition_heading = "",
                                                              std::string goal_key = "goal");

commands::Command plan_command();
commands::Command tune_command();
commands::Command limits_command();
commands::Command worst_command();
commands::Command rare_command();

/// Answer of the command `limits`, the success rates with causes of failures switched off, for a design point
/// of a study with targets.
/// @param point index of the design point
/// @param tell gets the name of the running stage
/// @throws trial::Interrupted if a stop is requested or the time is over
/// @throws trials::Spent if the trials of `effort` are not enough
document::Answer causes_answer(const study::Study& study, std::int64_t point, const trials::Effort& effort,
                               const tuning::TellStage& tell = {});

/// Approximate number of trials that causes_answer() simulates if a goal is missed.
std::int64_t trials_of_causes(const study::Study& study, std::int64_t point);

/// Text for the rate of a claim (a goal in a setting), after its percentage: "moves meet the goal 'small'
/// under condition loaded in the worst world".
/// @param claim index in tuning::Aim::claims
std::string rated_words(const study::Study& study, std::size_t claim);

/// Description of the success rates with each cause of failures switched off. It has the item "limits" under
/// `title`, the shown causes, what was tried, and why some causes were not simulated.
document::Description<std::vector<tuning::Limit>> limits_description(const std::string& title);

/// Answer of the command `worst`, which seeks the worst machine, for a design point of a study with targets.
/// No manifest of the machine is written.
/// @throws as tuning::worst_machines
document::Answer worst_of(const study::Study& study, std::int64_t point, const trials::Effort& effort);

using tuning::NamedValues;

/// Text of names and values, such as "controller.ki = 5, controller.kp = 0".
std::string values_text(const NamedValues& values);

/// Name of the worst machine such as "machine 3", or "trial 3" for a study without machines.
/// @param on_machines whether the study has machines
std::string machine_name(const tuning::WorstMachine& worst, bool on_machines);

/// Text about the worst machine, such as "machine 3, 75 % of its moves meet the goal; friction.k1 = 175".
std::string worst_machine_text(const tuning::WorstMachine& worst, const study::Study& study);

/// Description of the worst machine of a study. It is for data only, because people read
/// worst_machine_text().
document::Description<tuning::WorstMachine> worst_description();

/// Maximum number of trials that the command `rare` simulates, unless another number is asked for.
inline constexpr std::int64_t usual_rare_trials = 1'000'000;

/// Answer of the command `rare`, which estimates the probability that a move misses its goal. The weighted
/// trials are not written to a file.
/// @throws Failure: bad_input if the study draws nothing for each trial; interrupted
document::Answer rare_of(const study::Study& study, const rare::Population& of, const trials::Effort& effort);

/// Answer of `plan --success …`, `plan --machines-share …` and `plan --halfwidth …`: the numbers of trials
/// and machines that demonstrate a claim, or that bring the bounds of a rate within a half-width.
/// `--halfwidth` may be combined with the other two.
/// @throws Failure (bad_input) for options that do not go together
document::Answer claim_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> claim_plan_types();

/// Answer of `plan MANIFEST` and `plan PILOT` without another question: the numbers of trials and machines
/// that decide the goal. For a manifest: the smallest studies that can meet the goal. For a results file: the
/// study that decides the goal with a probability of 90 %.
/// @throws Failure (bad_input) if there is no goal
document::Answer goal_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> goal_plan_types();

/// Answer of `plan --margin MEASURE=M … MANIFEST`: the number of trials with which two equal studies are
/// shown to be equivalent. It simulates a pilot of the study.
document::Answer equivalence_plan(const command_line::Arguments& arguments);

document::AnswerType equivalence_plan_type();

}  // namespace zerocount::design_commands
