#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "core/trial/trial.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/output_file.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/rare/rare_run.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/study_commands/trace_writer.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* trace_help =
    "Runs one trial again and writes it sample by sample. A trial of a results file is rebuilt\n"
    "from the manifest in the file, and run by the engine that ran it too. If its inputs, outcome\n"
    "or jerks then differ from the recorded ones, the differences are listed and the exit code is 4.\n"
    "The samples are those of the reference engine. Where a loop amplifies the rounding that\n"
    "parts the two engines, it is said from when on they differ from the recorded trial.\n"
    "\n"
    "Columns: k, t (s), target, count, coarse_count, error (counts), code, torque (N m),\n"
    "theta (rad), omega (rad/s), xp, xh (rad), depth (reversal points), mode (stick or\n"
    "slide). Values are those at the sampling instant; code and torque are commanded there.\n"
    "Only if the study uses them: reference (counts), phase (fine or coarse), load_theta (rad) and\n"
    "load_omega (rad/s) of the second mass, load_count or motor_count (of the encoder of the mass that\n"
    "does not close the loop, counts of it), drive_torque (N m, of the motor; if it differs from the\n"
    "code's torque by more than a delay of the closed loop). A trial that is stopped early ends\n"
    "there. On a linear axis read N for N m and m for rad. Of an estimate by 'zerocount rare' it\n"
    "replays a trial that was drawn.\n"
    "\n"
    "Example: zerocount trace gains.h5 --point 2 --trial 17 -o trial.csv\n";

std::int64_t trial_option(const command_line::Arguments& arguments, const study::Study& study) {
  const std::int64_t value = arguments.whole_number("trial", 0, std::int64_t{1} << 53).value_or(0);
  if (value >= study.trials) {
    arguments.refuse(fmt::format("option '--trial': {} is too large; '{}' has trials 0 to {}", value,
                                 study.name, study.trials - 1));
  }
  return value;
}

void require_loaded_plugin(const command_line::Arguments& arguments, const study::Study& study) {
  if (!study.plugin || study.plugin->functions != nullptr) return;
  arguments.refuse(
      fmt::format("the controller of {} is the plugin {}, which is not loaded from a results file; give "
                  "its path with --plugin",
                  arguments.operands()[0], study.plugin->description.name));
}

/// Simulates the trial, writes its samples to `sink`, and returns the rest of its result: inputs, jerks and
/// measures.
/// @param json whether to write JSON; otherwise CSV
shards::TrialResult write_trace(const TraceSubject& subject, const TraceWriter::Sink& sink, bool json) {
  TraceWriter writer(sink, json);
  writer.begin(subject);
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& record) { writer.write(record); };
  shards::TrialResult result;
  observers.jerk = [&](const trial::Jerk& jerk) { result.jerks.push_back(jerk); };
  result.row = subject.point * subject.study.trials + subject.index;
  result.inputs = subject.trial.inputs;
  result.outcome = trial::run_trial(subject.trial.parameters, observers);
  writer.end(result.outcome);
  return result;
}

/// Simulates the trial and writes its trace (all samples) to standard output, or to a file that appears when
/// it is complete.
/// @param json whether to write JSON; otherwise CSV
shards::TrialResult write_trace_to(const std::filesystem::path& place, const TraceSubject& subject,
                                   bool json) {
  if (yaml::is_standard_stream(place)) {
    return write_trace(subject, standard_output::write, json);
  }
  storage::OutputFile file(place);
  shards::TrialResult result = write_trace(
      subject, [&file](std::string_view text) { file.write(text); }, json);
  file.finish();
  file.publish();
  return result;
}

/// Prints to stderr from which sample on the reference engine differs from the recorded trial; nothing if it
/// does not differ.
void tell_parting(const std::string& input, const std::optional<verification::Parting>& parting) {
  if (!parting) return;
  status::tell(
      "warning: {}: the engine of the run reproduces the recorded trial; {}, these samples, of the reference "
      "engine, "
      "differ from it: the loop amplifies the rounding that parts the two\n",
      input, verification::text_of(*parting));
}

/// Simulates a trial of a file by 'zerocount rare' again, and writes its trace.
ExitCode trace_rare(const command_line::Arguments& arguments, const std::filesystem::path& place, bool json) {
  const std::string& input = arguments.operands()[0];
  for (const char* option : {"set", "point"}) {
    if (arguments.has(option))
      arguments.refuse(
          fmt::format("option '--{}': an estimate of 'zerocount rare' belongs to one point of one manifest; "
                      "expected --trial alone",
                      option));
  }
  const rare::RareRecord record = rare::read_rare_file(input);
  const rare::Question question = rare::recorded_question(record, input, commands::plugin_option(arguments));
  require_loaded_plugin(arguments, question.study);
  const auto drawn = std::ssize(record.state.drawn);
  if (drawn == 0)
    arguments.refuse(
        fmt::format("{}: it holds no drawn trials: its search ended before any was drawn", input));
  const std::int64_t index = arguments.whole_number("trial", 0, drawn - 1).value_or(0);
  const rare::Trial& trial = record.state.drawn[static_cast<std::size_t>(index)];
  const study::StudyTrial drawn_trial = rare::trial_at(question, trial);
  const shards::TrialResult replayed =
      write_trace_to(place, {question.study, question.of.point, index, drawn_trial}, json);
  rare::Trial again = trial;
  rare::run_trials(question, {&again, 1}, {});
  const double failed = again.failed;
  if (failed == trial.failed) {
    rare::set_result(again, question, replayed.outcome.moves);
    if (again.failed != failed) tell_parting(input, verification::parting_of_engines(drawn_trial.parameters));
    return ExitCode::success;
  }
  throw Failure(
      ExitCode::bad_data,
      fmt::format("{}: trial {}: the event happens to {} of its moves in the replay, and to {} in the "
                  "recorded trial",
                  input, index, text::percent(failed), text::percent(trial.failed)));
}

ExitCode trace(const command_line::Arguments& arguments) {
  const std::string input = arguments.operands()[0];
  const std::filesystem::path place = command_line::text_place(arguments, "output").value_or("-");
  const bool json = arguments.choice("format") == "json";
  std::optional<reading::ResultsFile> file;
  try {
    if (commands::is_results_file(input)) file.emplace(input, reading::Require::any_part);
  } catch (const layout::RareFile&) {
    return trace_rare(arguments, place, json);
  }
  if (file && arguments.has("set"))
    arguments.refuse("option '--set' needs a manifest instead of a results file");

  if (!file && arguments.has("plugin"))
    arguments.refuse("option '--plugin' needs a results file; a manifest names its plugin");

  const study::Study study =
      file ? layout::recorded_study(file->header(), input, commands::plugin_option(arguments))
           : commands::load_study(input, arguments);
  require_loaded_plugin(arguments, study);
  const std::int64_t point = command_line::point_option(arguments, study.points.labels).value_or(0);
  const std::int64_t index = trial_option(arguments, study);
  const layout::RowRange row{point * study.trials + index, 1};
  if (file && (row.first < file->rows().first || row.end() > file->rows().end())) {
    arguments.refuse(fmt::format("{} is a part of the study without this trial", input));
  }
  const study::StudyTrial trial = study::study_trial(study, point, index);
  const shards::TrialResult replayed = write_trace_to(place, {study, point, index, trial}, json);
  const auto failed = [](const trial::MoveOutcome& move) { return move.controller_failed; };
  if (std::any_of(replayed.outcome.moves.begin(), replayed.outcome.moves.end(), failed))
    status::tell("the controller returned a non-finite torque at the last sample, which ends the trial\n");
  if (!file) return ExitCode::success;

  const auto [different, parting] = verification::compare_with_record(*file, study, replayed);
  tell_parting(input, parting);
  if (different.empty()) return ExitCode::success;
  std::string message =
      fmt::format("{}: point {}, trial {}: the replay differs from the recorded trial", input, point, index);
  for (const std::string& line : different) message += "\n  " + line;
  throw Failure(ExitCode::bad_data, message);
}

}  // namespace

commands::Command trace_command() {
  return {{"trace",
           "MANIFEST|FILE",
           {{"point", "P", "design point, by label or number from 0 (default 0)"},
            {"trial", "I", "trial of the point, from 0 (default 0)"},
            command_line::format_option({"csv", "json"}),
            command_line::written_file({"output,o", "FILE", "write there instead of to standard output"}),
            command_line::needing({"output"}, command_line::force_option()),
            command_line::read_file({"plugin", "LIBRARY", "the controller plugin of a results file"}),
            {"set", "KEY=VALUE", "override a manifest key; may be repeated", true}}},
          "run one trial again, sample by sample",
          trace_help,
          trace};
}

}  // namespace zerocount::study_commands
