#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/machine/acceptance/acceptance.hpp"
#include "analysis/machine/monitor/equal_logs.hpp"
#include "analysis/trials/goal/question.hpp"
#include "core/failure/failure.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/commands/command.hpp"
#include "runners/result_commands/machine_logs.hpp"
#include "runners/result_commands/result_commands.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* accept_help =
    "Do the machines that were built meet the goal, and what was predicted of them? STUDY.h5 is a study\n"
    "with machines and one or several goals; each MOVES.csv is the log of one machine, with a row for each\n"
    "move and the columns that the goals ask for, such as band_settling_time[1] [ms], and for a goal on\n"
    "some of the moves the column move, their numbers from 0. One page shows each goal, the predicted\n"
    "proportion of moves that meet it with the interval for as many machines, the measured one with its\n"
    "bounds, whether the two agree, and what the prediction assumes.\n"
    "\n"
    "With worlds the machines must be like those of one of them: the answer says of how many they are.\n"
    "Of a study with a sequence, logs with the columns final_error and move also give the values of\n"
    "ISO 230-2, measured and predicted, which do not decide.\n"
    "\n"
    "A goal is judged as 'judge' does: for all machines of which these are a sample, by its proportion\n"
    "of machines where it has one. Few machines show little of all: 59 without a miss show 95 %. With\n"
    "--these it is judged for these machines alone, as in an acceptance test of what was delivered.\n"
    "\n"
    "Logs with the same values in the same order, however they are written, and a log that begins with\n"
    "all moves of another one, are those of one machine: an error. Different machines can have equal\n"
    "logs by chance if there are few moves of few different values: --allow-equal takes them as such.\n"
    "\n"
    "Exit code 0: accepted, every goal is shown to be met. 1: rejected, one is shown to be missed, or met\n"
    "significantly (5 %) less often than predicted. 3: too few machines or moves to decide.\n"
    "\n"
    "Example: zerocount accept my-axis.h5 machine-1.csv machine-2.csv machine-3.csv\n"
    "         zerocount accept my-axis.h5 machine-*.csv --format html > acceptance.html\n";

/// Refuses a file that is given twice, because its moves would count as those of two machines.
void require_different_files(const command_line::Arguments& arguments) {
  const std::vector<std::string>& operands = arguments.operands();
  std::set<std::filesystem::path> places;
  for (std::size_t i = 1; i < operands.size(); ++i) {
    std::error_code error;
    const std::filesystem::path place = std::filesystem::weakly_canonical(operands[i], error);
    if (!places.insert(error ? std::filesystem::path(operands[i]) : place).second)
      arguments.refuse(fmt::format("{} is given twice; expected the log of another machine", operands[i]));
  }
}

/// Text of the names of some logs, such as "a.csv, b.csv and 3 more".
/// @param indices indices of these logs
std::string names_of(const std::vector<monitor::MoveLog>& logs, const std::vector<std::size_t>& indices) {
  constexpr std::size_t max_shown = 5;
  const std::size_t shown = std::min(indices.size(), max_shown);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < shown; ++i) names.push_back(logs[indices[i]].name);
  const std::size_t more = indices.size() - shown;
  return fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Refuses logs with equal contents, because copies of one log would count as several machines.
void require_different_logs(const std::vector<monitor::MoveLog>& logs) {
  const std::optional<monitor::EqualLogs> equal = monitor::equal_logs(logs);
  if (!equal) return;
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: {} the same values in the same order, as copies of the log of one machine have; "
                  "expected the log of another machine each, or --allow-equal{}",
                  names_of(logs, equal->logs),
                  equal->whole ? fmt::format("all {} moves have", equal->moves)
                               : fmt::format("the first {} moves have", equal->moves),
                  equal->few_values ? " where so few different values are equal by chance" : ""));
}

ExitCode accept(const command_line::Arguments& arguments) {
  const std::vector<std::string>& operands = arguments.operands();
  require_different_files(arguments);
  const reading::AllTrialsFile file = with_setting(arguments, reading::AllTrialsFile(operands[0]));
  goal::require_claim(file.study(), operands[0]);
  const std::vector<std::string> labels = file.point_labels();
  const std::int64_t point = point_of(arguments, labels);
  std::vector<monitor::MoveLog> logs;
  for (std::size_t i = 1; i < operands.size(); ++i) logs.push_back(read_log(operands[i]));
  if (!arguments.has("allow-equal")) require_different_logs(logs);
  const acceptance::Judged judged =
      arguments.has("these") ? acceptance::Judged::these_machines : acceptance::Judged::all_machines;
  const acceptance::Acceptance accepted = acceptance::accept(file, point, logs, judged);
  return answers::print(arguments, acceptance::acceptance_answer(), accepted,
                        acceptance::exit_code_of(acceptance::status_of(accepted)));
}

}  // namespace

commands::Command accept_command() {
  constexpr std::size_t max_machines = 10'000;
  return {{"accept",
           "STUDY.h5 MOVES.csv...",
           {answers::format_option(),
            {"these", "", "judge the goals for these machines alone"},
            {"allow-equal", "", "take logs with the same values as those of different machines"},
            {"point", "P", "design point of the machines"},
            {"condition", "NAME", "condition under which they moved"},
            {"age", "A", "age at which they moved, of a study with ages"}},
           2,
           max_machines + 1},
          "accept machines by their moves, beside the prediction",
          accept_help,
          accept,
          [] { return std::vector{acceptance::acceptance_answer().complete_type()}; }};
}

}  // namespace zerocount::result_commands
