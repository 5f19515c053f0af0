#include <fmt/format.h>

#include "analysis/study_statistics.hpp"
#include "analysis/summary.hpp"
#include "results/reading/study_file.hpp"
#include "runners/commands.hpp"

namespace zerocount {
namespace {

constexpr const char* help =
    "Prints a row per design point: how many trials were stable and ended at zero counts of\n"
    "error (with 95 % bounds), how long they took to settle, how often they jerked, what the\n"
    "criteria (6) and (7) of the paper predict, and what was seen on the real rig where the\n"
    "manifest says so; of an open-loop study, a row per design point and torque level. json\n"
    "and csv hold more than the table.\n"
    "\n"
    "Example: zerocount summary gains.h5 --format json\n";

ExitCode summarise_file(const Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"table", "json", "csv"});
  const StudySummary summary = summarise(StudyFile(arguments.operands()[0]));
  if (format == "table") fmt::print("{}", summary_table(summary));
  if (format == "json") fmt::print("{}", summary_json_text(summary));
  if (format == "csv") fmt::print("{}", summary_csv(summary));
  return ExitCode::success;
}

}  // namespace

Command summary_command() {
  return {{"summary", "FILE", 1, 1, {{"format", "FORMAT", "table (default), json or csv"}}},
          "print the statistics of a results file",
          help,
          summarise_file};
}

}  // namespace zerocount
