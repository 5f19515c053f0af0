#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "analysis/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/reading/study_file.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/commands.hpp"

namespace zerocount::commands {
namespace {

namespace fs = std::filesystem;

constexpr const char* summary_help =
    "Prints one row per design point: the proportions of trials that were stable and that ended\n"
    "at zero counts of error (with 95 % bounds), settling times, jerks, the prediction of the\n"
    "paper's criteria (6) and (7), and the observation on the real rig if the manifest has one.\n"
    "For an open-loop study, one row per design point and torque level. Below the table stand\n"
    "tolerance statements about all axes that the manifest describes. The formats json and csv\n"
    "have more statistics than the table. The file stores 95 % bounds; others are computed.\n"
    "During a run, or after an interrupted one, the summary covers the finished trials and\n"
    "reports that.\n"
    "\n"
    "Example: zerocount summary gains.h5 --format json\n";

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// The summary of the file, or of the unfinished run that writes it.
summary::StudySummary summary_of(const fs::path& path, double confidence, bool with_means) {
  const fs::path shards = layout::shards_directory(path);
  if (!is_there(path) && is_there(shards)) {
    try {
      return summary::summarise_unfinished(shards, confidence, with_means);
    } catch (const Failure&) {
      if (!is_there(path)) throw;  // otherwise the run has ended in the meantime and removed its shards
    }
  }
  summary::StudySummary summary = summary::summarise(reading::StudyFile(path), confidence, with_means);
  if (is_there(shards)) {
    fmt::print(stderr,
               "note: an unfinished run ({1}) will replace {0}; this is the summary of the present file\n",
               path.string(), shards.string());
  }
  return summary;
}

ExitCode summarise_file(const command_line::Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"table", "json", "csv"});
  const double confidence =
      command_line::probability_option(arguments, "confidence").value_or(statistics::summary_confidence);
  const bool with_means = format != "table";  // the table shows no bounds of means
  const summary::StudySummary summary = summary_of(arguments.operands()[0], confidence, with_means);
  if (format == "table") fmt::print("{}", summary::summary_table(summary));
  if (format == "json") fmt::print("{}", summary::summary_json_text(summary));
  if (format == "csv" && summary.unfinished)
    fmt::print(stderr, "{}\n", summary::unfinished_sentence(summary));
  if (format == "csv") fmt::print("{}", summary::summary_csv(summary));
  return ExitCode::success;
}

}  // namespace

Command summary_command() {
  return {{"summary",
           "FILE",
           {{"format", "FORMAT", "table (default), json or csv"},
            {"confidence", "LEVEL", "of all bounds, between 0 and 1 (default 0.95)"}}},
          "print the statistics of a results file",
          summary_help,
          summarise_file};
}

}  // namespace zerocount::commands
