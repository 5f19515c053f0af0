#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "analysis/machine/monitor/equal_logs.hpp"
#include "analysis/machine/monitor/machine_monitor.hpp"
#include "analysis/machine/monitor/monitor_baseline.hpp"
#include "analysis/machine/monitor/move_log.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/result_commands/change_causes.hpp"
#include "runners/result_commands/changed_parameters.hpp"
#include "runners/result_commands/machine_logs.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/progress.hpp"
#include "runners/trials/effort.hpp"

namespace zerocount::result_commands {
namespace {

namespace fs = std::filesystem;

constexpr const char* monitor_help =
    "Has this machine changed? MOVES.csv has a row for each move of a machine in use, in their order,\n"
    "and columns named like measures of moves (arrival_time, band_settling_time[1], overshoot,\n"
    "outcome, ...), with units as [ms] where they are not those of the program. An empty cell, or\n"
    "NaN, is what never happened. BASELINE is a log of earlier moves of the machine, or a results\n"
    "file: then an alarm can mean that the model is wrong, and names the parameters that explain it,\n"
    "or says that none of them does. For that it simulates the machines with each parameter changed,\n"
    "in as many trials as that takes, or --budget at most. A measure that only one of both has, also\n"
    "one whose column has another name, is not judged: the answer names it, and a column like it.\n"
    "\n"
    "The test may be asked after every move: a false alarm within any number of moves has at most\n"
    "the probability --alarm, where the moves are exchangeable with those of the baseline. Moves\n"
    "that depend on the ones before are not: --block N tests the medians of N consecutive moves, and\n"
    "--group COLUMN those of rows that follow each other with one value of a column, such as a day.\n"
    "With columns move (number in a cycle) and target, moves are compared with their like.\n"
    "Exit code 1: changed. 0: unchanged, which is said where a change of --change would have been\n"
    "seen with 90 %. 3: undecided.\n"
    "\n"
    "--follow reads a growing log and prints a line of JSON whenever it has new moves, until the\n"
    "alarm. It keeps no state: started again, it reads the log from its beginning and says the same.\n"
    "\n"
    "Example: zerocount monitor first-week.csv moves.csv\n"
    "         zerocount monitor my-axis.h5 moves.csv --point 2 --format json\n"
    "         zerocount monitor first-week.csv moves.csv --follow\n";

constexpr auto polling_interval = std::chrono::milliseconds(200);

std::optional<std::int64_t> machine_of(const command_line::Arguments& arguments, std::int64_t machines) {
  if (machines == 0 && arguments.has("machine"))
    arguments.refuse("option '--machine': the study has no machines");
  return machines == 0 ? std::nullopt : arguments.whole_number("machine", 0, machines - 1);
}

/// Moves with which the log of a machine is compared: earlier measured moves, or those of a simulated study
/// with its file.
struct LoadedBaseline {
  monitor::Baseline moves;
  std::optional<reading::AllTrialsFile> file{};
  monitor::ModelMoves of_file{};
  std::vector<std::string> unchanged{};  ///< Names of parameters of the study that cannot have changed.
};

LoadedBaseline load_baseline(const command_line::Arguments& arguments) {
  const fs::path path = arguments.operands()[0];
  if (!commands::is_results_file(path)) {
    for (const char* const option : {"point", "condition", "age", "machine", "unchanged", "budget"})
      if (arguments.has(option))
        arguments.refuse(fmt::format("option '--{}': {} is a log of moves; it belongs to results files",
                                     option, path.string()));
    return {monitor::baseline_of(read_log(path, arguments.value("group").value_or("")))};
  }
  if (arguments.has("group"))
    arguments.refuse(
        fmt::format("option '--group': {} is a simulated study, whose moves have no such groups; "
                    "expected a log of moves as BASELINE",
                    path.string()));
  reading::AllTrialsFile file = with_setting(arguments, reading::AllTrialsFile(path));
  std::vector<std::string> unchanged = unchanged_names(file.study(), arguments.values("unchanged"));
  if (file.study().open_loop)
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: its moves are torque levels; expected a study with targets", path.string()));
  const monitor::ModelMoves moves{point_of(arguments, file.point_labels()),
                                  machine_of(arguments, file.study().machines)};
  monitor::Baseline baseline = monitor::baseline_of(file, moves);
  return {std::move(baseline), std::move(file), moves, std::move(unchanged)};
}

/// Explanation of an alarm: which parameter of the simulated study changed. Nothing without an alarm, if the
/// baseline consists of measured moves, or for a controller plugin.
std::optional<monitor::ChangeExplanation> explanation_of(const command_line::Arguments& arguments,
                                                         const LoadedBaseline& baseline,
                                                         const monitor::MachineMonitor& machine,
                                                         const monitor::MonitorState& state,
                                                         const monitor::MoveLog& log,
                                                         const std::stop_token& stop) {
  if (!baseline.file || state.alarm == nullptr || baseline.file->header().plugin) return std::nullopt;
  const command_line::Budget budget = command_line::budget_option(arguments);
  const trials::Effort effort = trials::Effort(stop).limited_to(budget.trials, budget.seconds);
  std::optional<monitor::ChangeExplanation> explanation;
  commands::with_progress("zerocount monitor", "simulating what may have changed", [&] {
    explanation = explain_alarm(*baseline.file, baseline.of_file, machine, log, baseline.unchanged, effort);
  });
  return explanation;
}

std::optional<double> change_from(const command_line::Arguments& arguments) {
  const std::optional<double> change = command_line::number_option(arguments, "change", 0.0);
  if (change && !(*change > 0.0))
    arguments.refuse(
        fmt::format("option '--change': {} is not the size of a change; expected a number above 0", *change));
  return change;
}

monitor::MonitorSettings settings_from(const command_line::Arguments& arguments) {
  monitor::MonitorSettings settings;
  settings.alarm = command_line::probability_option(arguments, "alarm").value_or(settings.alarm);
  settings.change = change_from(arguments);
  settings.block = arguments.whole_number("block", 1, 1'000'000).value_or(settings.block);
  settings.seed =
      static_cast<std::uint64_t>(arguments.whole_number("seed", 0, std::int64_t{1} << 53).value_or(1));
  settings.measures = arguments.values("measure");
  settings.group = arguments.value("group").value_or("");
  return settings;
}

/// Prints the state of the monitor after all moves of the log; on one line if the log is followed.
/// @returns exit code of the state
ExitCode print_state(const command_line::Arguments& arguments, monitor::MachineMonitor& machine,
                     const monitor::MoveLog& log, const LoadedBaseline& baseline,
                     const std::stop_token& stop) {
  machine.update(log);
  const monitor::MonitorState state = machine.state();
  const auto explanation = explanation_of(arguments, baseline, machine, state, log, stop);
  const monitor::MonitorResult reading{machine,
                                       baseline.moves,
                                       state,
                                       log.name,
                                       explanation ? &*explanation : nullptr,
                                       baseline.file ? 0 : monitor::equal_moves(baseline.moves, log)};
  const ExitCode code = monitor::exit_code_of(state.status);
  if (!arguments.has("follow")) return answers::print(arguments, monitor::monitor_answer(), reading, code);
  const document::Answer answer = monitor::monitor_answer().of(reading, code, document::Audience::json);
  standard_output::write(answers::rendered(answer, answers::json_line));
  standard_output::flush();
  return code;
}

/// Follows a growing log until an alarm, an interruption, or a time without new moves.
ExitCode follow(const command_line::Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  const fs::path path = arguments.operands()[1];
  if (yaml::is_stream(path))
    arguments.refuse("option '--follow': a stream cannot be read again; expected a file");
  const std::optional<std::int64_t> idle = arguments.whole_number("idle", 0, 86400 * 365);
  const monitor::MonitorSettings settings = settings_from(arguments);
  require_log(path);
  const LoadedBaseline baseline = load_baseline(arguments);
  const status::InterruptionWatch interruption(status::InterruptionWatch::Unstopped::end);
  GrowingLog growing(path, settings.group);
  std::optional<monitor::MachineMonitor> machine;
  std::optional<ExitCode> code;  // of the last line
  Clock::time_point last = Clock::now();
  while (true) {
    const bool has_moves = growing.read();
    if (!machine && growing.log().has_header()) machine.emplace(baseline.moves, growing.log(), settings);
    if (machine && has_moves) {
      code = print_state(arguments, *machine, growing.log(), baseline, interruption.token());
      if (code == ExitCode::regression) return *code;
      last = Clock::now();
    } else if (idle && Clock::now() - last >= std::chrono::seconds(*idle)) {
      break;
    }
    if (interruption.token().stop_requested()) return ExitCode::interrupted;
    std::this_thread::sleep_for(polling_interval);
  }
  if (code) return *code;
  growing.log().require_header();
  return print_state(arguments, machine.value(), growing.log(), baseline, interruption.token());
}

ExitCode monitor_machine(const command_line::Arguments& arguments) {
  if (arguments.has("follow")) return follow(arguments);
  const LoadedBaseline baseline = load_baseline(arguments);
  const status::InterruptionWatch interruption(status::InterruptionWatch::Unstopped::end);
  const monitor::MonitorSettings settings = settings_from(arguments);
  const monitor::MoveLog log = read_log(arguments.operands()[1], settings.group);
  monitor::MachineMonitor machine(baseline.moves, log, settings);
  return print_state(arguments, machine, log, baseline, interruption.token());
}

}  // namespace

commands::Command monitor_command() {
  using command_line::excluding;
  using command_line::needing;
  return {
      {"monitor",
       "BASELINE MOVES.csv",
       {excluding({"follow"}, answers::format_option()),
        {"alarm", "A", "largest probability of a false alarm, ever (default 0.001)"},
        {"change", "C",
         "change to be seen: so many times the median, or so much of a proportion (default 0.2, of proportions 0.1)"},
        {"measure", "NAME", "a measure to watch; may be repeated (default: all that both have)", true},
        excluding({"group"},
                  {"block", "N", "take N consecutive moves as one value, their median (default 1)"}),
        {"group", "COLUMN",
         "take the moves of each group, by a column such as day, as one value: the groups are exchangeable"},
        {"unchanged", "PATHS",
         "parameters or sections that cannot have changed, such as encoder,controller.kp; may be repeated (beside a results file)",
         true},
        {"point", "P", "design point of a results file"},
        {"condition", "NAME", "condition of a results file with conditions"},
        {"age", "A", "age of a results file with ages"},
        {"machine", "R", "only this machine of a results file, from 0"},
        {"seed", "N", "seed of ties and of simulated changes (default 1)"},
        {"budget", "B",
         "budget of the simulations after an alarm: a number of trials, or a time such as 60s (default: as many trials as all parameters take, some 20000)"},
        {"follow", "", "read the log while it grows, and print lines of JSON until the alarm"},
        needing({"follow"}, {"idle", "S", "end after S seconds without new moves (default: never)"})},
       2,
       2},
      "say whether a machine in use has changed",
      monitor_help,
      monitor_machine,
      [] { return std::vector{monitor::monitor_answer().complete_type()}; }};
}

}  // namespace zerocount::result_commands
