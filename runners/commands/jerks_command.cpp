#include <string>
#include <vector>

#include <fmt/format.h>

#include "analysis/jerks/jerk_report.hpp"
#include "results/layout/header.hpp"
#include "results/reading/study_file.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/commands.hpp"

namespace zerocount {
namespace {

constexpr const char* jerks_help =
    "Prints of each design point (or of those named) how often jerks come, against the time since\n"
    "arrival, with bounds; how long the intervals between them are; whether they slow down\n"
    "(Laplace's test); whether they go in the direction of the holding torque; how large they are.\n"
    "Some trials are run again to see whether creep at constant torque foretells their jerks.\n"
    "\n"
    "Example: zerocount jerks fig8.h5 --format json\n";

constexpr std::int64_t default_creep_trials = 20;

ExitCode print_jerks(const Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"table", "json"});
  const double confidence = probability_option(arguments, "confidence").value_or(summary_confidence);
  const std::int64_t creep_trials =
      arguments.whole_number("creep-trials", 0, 1'000'000).value_or(default_creep_trials);
  const StudyFile file(arguments.operands()[0]);
  const Study study = recorded_study(file.header(), file.path());
  const std::vector<std::int64_t> points = point_options(arguments, study.point_labels);
  const JerkReport report = jerk_report(file, study, points, confidence, creep_trials);
  fmt::print("{}", format == "json" ? jerk_json_text(report) : jerk_text(report));
  if (any_arrival(report)) return ExitCode::success;
  fmt::print(stderr, "no move arrived: there was nothing that could jerk\n");
  return ExitCode::inconclusive;
}

}  // namespace

Command jerks_command() {
  return {{"jerks",
           "FILE",
           1,
           1,
           {{"point", "P", "design point, by label or number; may be repeated (default: all)", true},
            {"confidence", "LEVEL", "of all bounds, between 0 and 1 (default 0.95)"},
            {"creep-trials", "N", "trials of each point to run again beside creep (default 20)"},
            {"format", "FORMAT", "table (default) or json"}}},
          "print how often jerks come, and whether they slow down",
          jerks_help,
          print_jerks};
}

}  // namespace zerocount
