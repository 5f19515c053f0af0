#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "analysis/summary/best_point.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/pieces.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/commands.hpp"
#include "runners/commands/plugin_option.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/confirmation.hpp"

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
    "--confirm N runs the point with the highest success rate again, with N new trials from a\n"
    "fresh seed, and prints their rate with plain Clopper-Pearson bounds, beside the bound of the\n"
    "file's trials that allows for the choice among all points. The file stays as it is.\n"
    "During a run, or after an interrupted one, the summary covers the finished trials and\n"
    "reports that.\n"
    "\n"
    "Example: zerocount summary gains.h5 --format json\n"
    "         zerocount summary gains.h5 --confirm 1000\n";

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// The summary of the file, or of the unfinished run that writes it.
summary::StudySummary summary_of(const fs::path& path, double confidence, bool with_means) {
  if (!is_there(path) && shards::has_begun(path)) {
    try {
      return summary::summarise_unfinished(path, confidence, with_means);
    } catch (const Failure&) {
      if (!is_there(path)) throw;  // otherwise the run has ended in the meantime and removed its shards
    }
  }
  summary::StudySummary summary = summary::summarise_file(path, confidence, with_means);
  if (const fs::path shards = layout::shards_directory(path); is_there(shards)) {
    status::tell("note: an unfinished run ({1}) will replace {0}; this is the summary of the present file\n",
                 path.string(), shards.string());
  }
  return summary;
}

/// A run of the best point with new trials.
struct ConfirmedBest {
  study_run::Confirmation confirmation;
  statistics::ConfidenceInterval bounds;  ///< Clopper–Pearson, of the new trials
};

/// The run that the option --confirm asks for; nothing without it.
std::optional<ConfirmedBest> confirmed_best(const command_line::Arguments& arguments,
                                            const summary::StudySummary& summary) {
  constexpr std::int64_t max_trials = 10'000'000;
  const std::optional<std::int64_t> trials = arguments.whole_number("confirm", 2, max_trials);
  if (!trials) {
    if (arguments.has("plugin")) arguments.refuse("option '--plugin' needs --confirm");
    return std::nullopt;
  }
  if (summary.unfinished) arguments.refuse("option '--confirm' needs a run that has ended");
  const reading::ResultsFile file(arguments.operands()[0]);
  status::tell("running {} new trials of the best point\n", *trials);
  const study_run::Confirmation confirmation = study_run::confirm_point(
      file, summary::best_point(summary.points, summary.goal), *trials, plugin_option(arguments));
  return ConfirmedBest{confirmation, statistics::clopper_pearson(confirmation.successes, confirmation.trials,
                                                                 summary.confidence)};
}

/// The claim of the best point by the trials of the file. Those of a saltelli design are not independent.
std::string chosen_text(const summary::StudySummary& summary, std::int64_t best) {
  const std::size_t points = summary.points.size();
  const measures::PointSummary& point = summary.points[static_cast<std::size_t>(best)];
  const std::string label = text::printable(summary.labels[static_cast<std::size_t>(best)]);
  const std::string of = points == 1 ? label : fmt::format("best of {} points: {}", points, label);
  if (summary.features.dependent_trials) {
    return fmt::format("{}: {} of {} trials succeeded; dependent trials give no bounds\n", of,
                       point.outcomes.zero_count, point.trials);
  }
  const bool stopped = std::any_of(
      summary.sections.begin(), summary.sections.end(),
      [](const measures::SummarySection& section) { return section.key == summary::stopping_key; });
  return fmt::format("{}: {}{}\n", of,
                     statistics::claim_sentence(summary::claim_of_chosen(point, points, stopped)),
                     points == 1 ? "" : "; the bound allows for the choice among all points (Bonferroni)");
}

std::string confirmation_text(const summary::StudySummary& summary, const ConfirmedBest& best) {
  const study_run::Confirmation& confirmed = best.confirmation;
  return fmt::format(
      "\n{}run anew with seed {}, everything drawn anew: {} of {} trials{} succeeded, {}, {} bounds [{}] %\n"
      "(Clopper and Pearson; the point was chosen before these trials, so that they need no correction)\n",
      chosen_text(summary, confirmed.point), confirmed.seed, confirmed.successes, confirmed.trials,
      confirmed.on_rigs ? ", each on a rig of its own," : "",
      text::percentage(confirmed.successes, confirmed.trials), text::percent(summary.confidence),
      text::percent_bounds(best.bounds.low, best.bounds.high));
}

nlohmann::ordered_json confirmation_json(const ConfirmedBest& best) {
  const study_run::Confirmation& confirmed = best.confirmation;
  return {{"point", confirmed.point},
          {"seed", confirmed.seed},
          {"trials", confirmed.trials},
          {"zero_count", confirmed.successes},
          {"success_rate", statistics::rate(confirmed.successes, confirmed.trials)},
          {"success_rate_low", best.bounds.low},
          {"success_rate_high", best.bounds.high},
          {"one_trial_per_rig", confirmed.on_rigs}};
}

ExitCode summarise_file(const command_line::Arguments& arguments) {
  const std::string format = arguments.choice("format");
  const double confidence =
      command_line::probability_option(arguments, "confidence").value_or(statistics::summary_confidence);
  const bool with_means = format != "table";  // the table shows no bounds of means
  const summary::StudySummary summary = summary_of(arguments.operands()[0], confidence, with_means);
  if (format == "csv" && arguments.has("confirm"))
    arguments.refuse("option '--confirm' goes with the formats table and json");
  const std::optional<ConfirmedBest> best = confirmed_best(arguments, summary);
  if (format == "table") {
    standard_output::print("{}{}", summary::summary_table(summary),
                           best ? confirmation_text(summary, *best) : "");
  }
  if (format == "json") {
    nlohmann::ordered_json json = summary::summary_json(summary);
    if (best) json["confirmation"] = confirmation_json(*best);
    standard_output::write(text::json_text(json));
  }
  if (format == "csv" && summary.unfinished) status::tell("{}\n", summary::unfinished_sentence(summary));
  if (format == "csv") standard_output::write(summary::summary_csv(summary));
  return ExitCode::success;
}

}  // namespace

Command summary_command() {
  return {{"summary",
           "FILE",
           {command_line::format_option({"table", "json", "csv"}),
            {"confirm", "N", "run the best point again with N new trials, and print what they show"},
            {"plugin", "LIBRARY", "for --confirm: the controller of a study that has one of its own"},
            {"confidence", "LEVEL", "of all bounds, between 0 and 1 (default 0.95)"}}},
          "print the statistics of a results file",
          summary_help,
          summarise_file};
}

}  // namespace zerocount::commands
