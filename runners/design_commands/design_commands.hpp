#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/question.hpp"
#include "core/failure/failure.hpp"
#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/rare/rare_run.hpp"
#include "runners/trials/effort.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

/// The commands that design an axis: plan, tune, limits, worst and rare, their answers for the report, and
/// what they share.
namespace zerocount::design_commands {

/// A study, and the point of it that is asked for.
struct ExaminedPoint {
  study::Study study;  ///< under `--condition` and at `--age` alone
  std::int64_t point{0};
  study::Study whole;  ///< with all conditions and ages

  /// The number in the whole study of a trial of `study`.
  std::int64_t trial_in_whole(std::int64_t trial) const;
};

/// `--point`, or the only point of the study.
/// @throws Failure (bad_input) if it has several points and none is named
std::int64_t named_point(const command_line::Arguments& arguments, const study::Study& study);

/// The point of `MANIFEST|FILE` with `--set`, `--point`, `--condition` and `--age`.
/// @throws Failure (bad_input) without targets, or as named_point() and trials::restricted_to()
ExaminedPoint point_to_examine(const command_line::Arguments& arguments);

/// `--set`, of commands with a manifest.
command_line::OptionSpec set_option();

/// `--condition` and `--age` of point_to_examine().
command_line::OptionSpec condition_option();
command_line::OptionSpec age_option();

/// `--point` of named_point().
command_line::OptionSpec named_point_option();

/// @throws Failure (interrupted) where `work` throws Interrupted
template <class Work>
auto unless_interrupted(const Work& work) {
  try {
    return work();
  } catch (const trial::Interrupted&) {
    throw Failure(ExitCode::interrupted, "interrupted: nothing was written");
  }
}

/// A proportion, as a percentage for people.
inline document::Item proportion(std::string key, std::string heading, std::string meaning) {
  document::Item item = document::everywhere(std::move(key), std::move(heading), std::move(meaning), "1");
  item.notation = document::Notation::percent;
  return item;
}

/// JSON has no such member where there is no content.
inline document::Item optional(document::Item item) {
  item.optional = true;
  return item;
}

/// The goal and the condition of a claim; people are shown what has a heading.
document::Description<tuning::ClaimNames> named_claim_columns(std::string goal_heading = "",
                                                              std::string condition_heading = "",
                                                              std::string goal_key = "goal");

commands::Command plan_command();
commands::Command tune_command();
commands::Command limits_command();
commands::Command worst_command();
commands::Command rare_command();

/// The answer of `limits` on a point of a study with targets.
/// @param tell gets what is being simulated
/// @throws trial::Interrupted, trials::Spent
document::Answer limits_of(const study::Study& study, std::int64_t point, const trials::Effort& effort,
                           const tuning::TellStage& tell = {});

/// Trials that limits_of() runs, about, where something is missed.
std::int64_t trials_of_limits(const study::Study& study, std::int64_t point);

/// "moves meet the goal 'small' under condition loaded in the worst world": what the rate of a claim
/// (tuning::Aim::claims) is the proportion of.
std::string rated_words(const study::Study& study, std::size_t claim);

/// The rates without each cause of failures as the item "limits", below `title`; the causes that are shown,
/// what was tried, and the reasons of those that are not simulated.
document::Description<std::vector<tuning::Limit>> limits_description(const std::string& title);

/// The answer of `worst` on a point of a study with targets, whose machine is written to no manifest.
/// @throws as tuning::worst_machines
document::Answer worst_of(const study::Study& study, std::int64_t point, const trials::Effort& effort);

using tuning::NamedValues;

/// "controller.ki = 5, controller.kp = 0"
std::string values_text(const NamedValues& values);

/// "machine 3", or "trial 3" of a study without machines.
std::string machine_name(const tuning::WorstMachine& worst, bool on_machines);

/// "machine 3, 75 % of its moves meet the goal; friction.k1 = 175".
std::string worst_machine_text(const tuning::WorstMachine& worst, const study::Study& study);

/// The machine of a study that does worst; for data only, because worst_machine_text() says it.
document::Description<tuning::WorstMachine> worst_description();

/// Trials that `rare` takes at most, unless it is asked for another number.
inline constexpr std::int64_t usual_rare_trials = 1'000'000;

/// The answer of `rare` on missed goals, whose weighted trials are written to no file.
/// @throws Failure: bad_input if the study draws nothing for each trial; interrupted
document::Answer rare_of(const study::Study& study, const rare::Population& of, const trials::Effort& effort);

/// `plan --success …`, `plan --machines-share …` and `plan --halfwidth …`: the trials and machines that show
/// a claim, or bring the bounds of a rate within a half-width; the latter also beside the former.
/// @throws Failure (bad_input) for options that do not go together
document::Answer claim_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> claim_plan_types();

/// `plan MANIFEST` and `plan PILOT` without another question: the trials and machines that decide the goal of
/// the manifest. Of a manifest the smallest studies that can meet it, of a results file the study that
/// decides it with a probability of 90 %.
/// @throws Failure (bad_input) if there is no goal
document::Answer goal_plan(const command_line::Arguments& arguments);

std::vector<document::AnswerType> goal_plan_types();

/// `plan --margin MEASURE=M … MANIFEST`: simulates a pilot of the study; the trials with which two equal
/// studies are shown to be equivalent.
document::Answer equivalence_plan(const command_line::Arguments& arguments);

document::AnswerType equivalence_plan_type();

}  // namespace zerocount::design_commands
