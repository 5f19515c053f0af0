#include <string>
#include <vector>

#include "analysis/trials/jerks/jerk_statistics.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/result_commands/result_commands.hpp"

namespace zerocount::result_commands {
namespace {

constexpr const char* jerks_help =
    "Prints for each design point (or for the given ones) the rate of jerks over the time since\n"
    "arrival, with bounds; the intervals between jerks; a test whether jerks slow down (Laplace);\n"
    "the proportion in the direction of the holding torque; and the magnitudes. Some trials are\n"
    "simulated again to compare their jerks with the closed form of creep at constant torque.\n"
    "\n"
    "Example: zerocount jerks fig8.h5 --format json\n";

constexpr std::int64_t default_creep_trials = 20;

ExitCode print_jerks(const command_line::Arguments& arguments) {
  const double confidence =
      command_line::probability_option(arguments, "confidence").value_or(statistics::summary_confidence);
  const std::int64_t creep_trials =
      arguments.whole_number("creep-trials", 0, 1'000'000).value_or(default_creep_trials);
  const reading::AllTrialsFile file(arguments.operands()[0]);
  const std::vector<std::int64_t> points = command_line::point_options(arguments, file.point_labels());
  const jerks::JerkReport report = jerks::jerk_report(file, points, confidence, creep_trials);
  const ExitCode code = jerks::any_arrival(report) ? ExitCode::success : ExitCode::inconclusive;
  return answers::print(arguments, jerks::jerk_answer().of(report, code));
}

}  // namespace

commands::Command jerks_command() {
  return {{"jerks",
           "FILE",
           {{"point", "P", "design point, by label or number; may be repeated (default: all)", true},
            {"confidence", "LEVEL", "confidence of all bounds, between 0 and 1 (default 0.95)"},
            {"creep-trials", "N", "trials per point to compare with creep (default 20)"},
            answers::format_option()}},
          "print the rate, intervals and trend of jerks",
          jerks_help,
          print_jerks,
          [] { return std::vector{jerks::jerk_answer().complete_type()}; }};
}

}  // namespace zerocount::result_commands
