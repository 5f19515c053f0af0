#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/trials/goal/question.hpp"
#include "core/failure/failure.hpp"
#include "experiments/study/setting_study.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/timeline_option.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/rare/rare_run.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/trials/study_runner.hpp"

namespace zerocount::design_commands {
namespace {

constexpr const char* rare_help =
    "Estimates the probability that a move misses the goal, down to about 1e-8, where plain trials\n"
    "see no failure. It drives trials towards failure along scores of a move (settling time,\n"
    "largest torque, error at the end, unrest), learns a distribution of the failures it found,\n"
    "draws trials from it, and weights them, so that each has the right expectation. Every value of a\n"
    "choice, of integers and of samples is tried, be it ever so improbable. The lower bound holds in\n"
    "any case. The upper bound assumes that every kind of failure was reached by a plain trial or by a\n"
    "score. If nothing leads to a failure, plain trials go on to the end of the budget.\n"
    "\n"
    "Without a goal the event is a move that does not end at zero counts.\n"
    "--event asks for another event: MEASURE > x, such as 'arrival_time > 0.5' or\n"
    "'band_settling_time[1] > 0.05', with a column of moves.csv of 'zerocount export'. Each trial is\n"
    "on a machine of its own. Of several points --point chooses one, of several worlds --world, of\n"
    "several conditions --condition. Of several goals a move misses one of those that are about it.\n"
    "\n"
    "It ends when high is at most --ratio (2) times low, or after --budget (1000000 trials). A budget\n"
    "in time, such as 5min, makes an undecided answer depend on the machine. FILE holds the weighted\n"
    "trials; 'zerocount trace FILE --trial I' replays one. The same command goes on from an unfinished\n"
    "FILE; a search for failures that did not end begins anew. The exit code is 0 if the bounds are\n"
    "narrow enough, 3 if not.\n"
    "\n"
    "Example: zerocount rare my-axis.yaml -o rare.h5\n"
    "         zerocount rare my-axis.yaml -o late.h5 --event 'arrival_time > 0.5'\n";

std::optional<std::int64_t> world_to_ask(const command_line::Arguments& arguments,
                                         const study::Study& study) {
  if (study.worlds == 0) {
    if (arguments.has("world")) arguments.refuse("option '--world': the study has no worlds");
    return std::nullopt;
  }
  const std::optional<std::int64_t> world = arguments.whole_number("world", 0, study.worlds - 1);
  if (!world)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: it has {} worlds, and a probability over all of them would be an average "
                              "over what nobody knows; expected one with --world, such as the worst one of "
                              "'zerocount summary'",
                              arguments.operands()[0], study.worlds));
  return world;
}

/// Index of the setting (condition at an age) for which the probability is estimated; nothing without
/// settings. If the study has several, the options must name one, because a probability over all settings
/// would be an average.
std::optional<std::int64_t> setting_to_ask(const command_line::Arguments& arguments,
                                           const study::Study& study) {
  const std::int64_t setting = study::setting_named(study, arguments.value("condition"),
                                                    command_line::number_option(arguments, "age", 0.0));
  return study.settings.empty() ? std::nullopt : std::optional(setting);
}

measures::MoveEvent event_to_ask(const command_line::Arguments& arguments, const study::Study& study) {
  if (const std::optional<std::string> text = arguments.value("event"))
    return measures::parse_event(study, *text);
  goal::require_targets(study, arguments.operands()[0]);
  return measures::missed_criteria(study);
}

rare::RareSettings settings_of(const command_line::Arguments& arguments) {
  rare::RareSettings settings;
  settings.output = command_line::output_place(arguments);
  settings.confidence =
      command_line::probability_option(arguments, "confidence").value_or(settings.confidence);
  settings.ratio = command_line::number_option(arguments, "ratio", 1.0).value_or(settings.ratio);
  const command_line::Budget budget = command_line::budget_option(arguments);
  settings.max_trials = budget.trials;
  settings.seconds = budget.seconds;
  if (!budget.trials && !budget.seconds) settings.max_trials = usual_rare_trials;
  settings.quiet = arguments.has("quiet");
  settings.force = arguments.has("force");
  return settings;
}

/// Question about the probability of the event, with a check that the study draws something for each trial.
/// @param name name of the study, for messages
/// @throws Failure (bad_input) if there is nothing that could make a trial fail
rare::Question question_with_draws(const study::Study& study, const rare::Population& of,
                                   measures::MoveEvent event, const std::string& name) {
  rare::Question question = rare::question_of(study, of, std::move(event));
  if (question.coordinates.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: it draws nothing for each trial; expected distributions, such as "
                              "friction.k1: {{lognormal: {{median: 110, cv: 0.1}}}}",
                              name));
  return question;
}

ExitCode rare(const command_line::Arguments& arguments) {
  const rare::RareSettings settings = settings_of(arguments);
  const std::optional<std::filesystem::path> timeline = commands::timeline_place(arguments);
  const study::Study study = commands::load_study(arguments.operands()[0], arguments);
  const auto threads = static_cast<int>(arguments.whole_number("threads", 1, 4096).value_or(0));
  const rare::Population of{named_point(arguments, study), world_to_ask(arguments, study),
                            setting_to_ask(arguments, study)};
  const rare::Question question =
      question_with_draws(study, of, event_to_ask(arguments, study), arguments.operands()[0]);
  const parallel::ThreadLimit limit(trials::threads_to_use(threads));
  commands::print_warnings(study);
  plugins::require_no_hidden_state(study);
  const status::InterruptionWatch interruption;
  const storage::OutputLock lock(settings.output);
  commands::print_fallback_lock(lock, settings.output);
  storage::require_replaceable(settings.output);
  return commands::recorded(timeline, "rare", [&] {
    const rare::RareAnswer answer = rare::run_rare(question, settings, interruption.token());
    const bool is_estimated = answer.estimate.status == rare::EstimateStatus::estimated;
    return answers::print(arguments, rare::rare_answer(), answer,
                          is_estimated ? ExitCode::success : ExitCode::inconclusive);
  });
}

}  // namespace

document::Answer rare_of(const study::Study& study, const rare::Population& of,
                         const trials::Effort& effort) {
  const rare::Question question =
      question_with_draws(study, of, measures::missed_criteria(study), study.name);
  rare::RareSettings settings;
  settings.max_trials = std::min(usual_rare_trials, effort.trials_left());
  // Some of the time remains for the description of the failures.
  if (std::isfinite(effort.seconds_left())) settings.seconds = 0.8 * effort.seconds_left();
  settings.quiet = true;
  const rare::RareAnswer answer = rare::run_rare(question, settings, effort.stop());
  effort.spend(std::min(answer.state.trials, effort.trials_left()));
  return rare::rare_answer().of(answer);
}

commands::Command rare_command() {
  return {{"rare",
           "MANIFEST -o FILE",
           {command_line::renewed_file({"output,o", "FILE", "the file of the weighted trials (required)"}),
            answers::format_option(),
            {"event", "EVENT", "in place of a missed goal: MEASURE > x, with > >= < or <="},
            named_point_option(),
            {"world", "W", "the world, of a study with worlds"},
            {"condition", "NAME", "the condition, of a study with conditions"},
            {"age", "A", "the age, of a study with ages"},
            {"confidence", "C", "confidence of both bounds together (default 0.95)"},
            {"ratio", "R", "how narrow: high at most R times low (default 2)"},
            {"budget", "B", "a number of trials (default 1000000), or a time such as 60s, 5min or 2h"},
            {"threads", "N", "threads to use; default: all cores"},
            commands::timeline_option(),
            set_option(),
            {"quiet,q", "", "print no progress"},
            command_line::force_option()}},
          "the probability of a failure that plain trials do not see",
          rare_help,
          rare,
          [] { return std::vector{rare::rare_answer().complete_type()}; }};
}

}  // namespace zerocount::design_commands
