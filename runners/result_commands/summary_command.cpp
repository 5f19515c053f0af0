#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/summary_answer/point_selection.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/shards/pieces.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/file_run.hpp"

namespace zerocount::result_commands {
namespace {

namespace fs = std::filesystem;

constexpr const char* summary_help =
    "Prints one row per design point: the goal of the manifest if it has one, the proportions of\n"
    "trials that ended at zero counts of error and that were stable (with 95 % bounds), arrival\n"
    "and settling times, jerks, the prediction of the paper's criteria (6) and (7), and the\n"
    "observation on the real machine if the manifest has one. --legend explains the columns.\n"
    "For an open-loop study, one row per design point and torque level. A table that is too wide\n"
    "for the terminal is divided. The first lines are the verdict on the best point, or on that of\n"
    "--point: what is shown of all axes that the manifest describes, which points are as good,\n"
    "and whether it lies at an end of the sweep.\n"
    "--sort, --where and --top choose rows. They take the names of the columns of --format csv\n"
    "and of swept parameters, which may be shortened (ki). Conditions are <, <=, >, >=, = and !=;\n"
    "cases and labels can be equal or not: 'case != best'. A number may be written as an answer\n"
    "shows it, rounded: 'ki = 11767.7' means the point that is shown so.\n"
    "The formats json and csv have more statistics than the table. The file stores 95 % bounds;\n"
    "others are computed.\n"
    "--confirm N runs the best point again, with N new trials from a fresh seed, and prints what\n"
    "they show, beside the bound of the file's trials that allows for the choice among all points.\n"
    "The file stays as it is.\n"
    "During a run, or after an interrupted one, the summary covers the finished trials and\n"
    "reports that.\n"
    "\n"
    "Example: zerocount summary gains.h5 --format json\n"
    "         zerocount summary gains.h5 --where 'kp > 0' --where 'stable_rate >= 0.9' --top 5\n"
    "         zerocount summary gains.h5 --sort -success_rate\n"
    "         zerocount summary gains.h5 --confirm 1000\n";

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Summary of a results file, or of the finished trials of the unfinished run that writes it.
/// @param with_means whether to compute bounds of means, which takes time
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

/// Results of the new trials that the option --confirm asks for at a design point; nothing without the
/// option.
std::optional<summary_answer::Confirmation> confirmation_of(const command_line::Arguments& arguments,
                                                            const summary::StudySummary& summary,
                                                            std::int64_t point) {
  constexpr std::int64_t max_trials = 10'000'000;
  const std::optional<std::int64_t> trials = arguments.whole_number("confirm", 2, max_trials);
  if (!trials) {
    if (arguments.has("plugin")) arguments.refuse("option '--plugin' needs --confirm");
    return std::nullopt;
  }
  if (summary.unfinished) arguments.refuse("option '--confirm' needs a run that has ended");
  const reading::ResultsFile file(arguments.operands()[0]);
  status::tell("running {} new trials of the point {}\n", *trials,
               summary::point_names(summary)[static_cast<std::size_t>(point)]);
  return study_run::confirm_point(file, point, *trials, commands::plugin_option(arguments));
}

/// Whether the answer is written as data (JSON, CSV). Bounds of means take time to compute, so people are
/// shown only the bounds for the true motion, whereas data contain the bounds for the points that are asked
/// for.
bool shows_data(const command_line::Arguments& arguments) {
  return answers::audience_of(arguments.choice("format")) != document::Audience::people;
}

/// Selection of design points by the options --sort, --where and --top.
summary_answer::PointSelection selection_of(const command_line::Arguments& arguments) {
  return {arguments.value("sort"), arguments.values("where"),
          arguments.whole_number("top", 1, std::int64_t{1} << 40)};
}

/// Runs `select` and returns its result. Errors in the selection are reported as errors of the options.
template <class Select>
auto selected_by(const command_line::Arguments& arguments, const Select& select) {
  try {
    return select();
  } catch (const Failure& failure) {
    if (failure.code() != ExitCode::bad_input) throw;
    arguments.refuse(fmt::format("options '--sort' and '--where': {}", failure.what()));
  }
}

/// Summary of the design points that the options ask for, computed without the others. Nothing if this does
/// not save time or is not possible.
std::optional<summary_answer::SelectedSummary> summary_of_selected(const command_line::Arguments& arguments,
                                                                   double confidence) {
  const fs::path path = arguments.operands()[0];
  if (confidence != statistics::summary_confidence || !is_there(path) ||
      is_there(layout::shards_directory(path)))
    return std::nullopt;
  const std::optional<std::int64_t> point =
      command_line::point_option(arguments, commands::described_study(path).points.labels);
  const bool bootstrap = shows_data(arguments);
  const summary_answer::PointSelection selection = selection_of(arguments);
  return selected_by(arguments,
                     [&] { return summary_answer::summarise_selected(path, bootstrap, selection, point); });
}

/// Summary of all design points, with the selection that the options ask for.
summary_answer::SelectedSummary summary_of_all(const command_line::Arguments& arguments, double confidence) {
  const fs::path path = arguments.operands()[0];
  const bool table = !shows_data(arguments);
  const summary_answer::PointSelection selection = selection_of(arguments);
  const bool is_whole = !selection.sort && !selection.top && selection.where.empty();
  const bool with_bounds = (is_whole && !table) || summary_answer::needs_mean_bounds(selection);
  summary::StudySummary summary = summary_of(path, confidence, with_bounds);
  std::vector<std::int64_t> points =
      selected_by(arguments, [&] { return summary_answer::matching_points(summary, selection); });
  const std::int64_t matching = std::ssize(points);
  points = summary_answer::first_points(std::move(points), selection);
  constexpr std::ptrdiff_t one_by_one = 200;  // points; more are read quicker with all others
  if (with_bounds || (table && !summary.features.motion && !summary.features.following)) {
    // They have what is shown.
  } else if (summary.unfinished) {
    summary = summary::summarise_unfinished(path, confidence, true);
  } else if (std::ssize(points) <= one_by_one) {
    summary::add_mean_bounds(summary, path, points);
  } else {
    summary = summary::summarise_file(path, confidence, true);
  }
  return {std::move(summary), std::move(points), matching, {}};
}

ExitCode summarise_file(const command_line::Arguments& arguments) {
  const bool csv = arguments.choice("format") == "csv";
  const double confidence =
      command_line::probability_option(arguments, "confidence").value_or(statistics::summary_confidence);
  if (csv && arguments.has("confirm")) arguments.refuse("option '--confirm' does not go with the format csv");
  summary_answer::SelectedSummary selected =
      commands::with_progress("zerocount summary", "computing statistics", [&] {
        std::optional<summary_answer::SelectedSummary> some = summary_of_selected(arguments, confidence);
        return some ? *std::move(some) : summary_of_all(arguments, confidence);
      });
  const summary::StudySummary& summary = selected.summary;
  if (arguments.has("where")) {
    status::tell("{} of {} points {} the conditions\n", selected.matching, summary.points.size(),
                 selected.matching == 1 ? "meets" : "meet");
  }
  summary_answer::SummaryResults reading = summary_answer::read_summary(
      summary, {std::move(selected.points), command_line::point_option(arguments, summary.labels),
                arguments.has("legend")});
  reading.confirmation = confirmation_of(arguments, summary, reading.chosen.point);
  if (csv && summary.unfinished) status::tell("{}\n", summary_answer::unfinished_sentence(summary));
  return answers::print(arguments, summary_answer::summary_description(summary), reading);
}

}  // namespace

commands::Command summary_command() {
  return {{"summary",
           "FILE",
           {answers::format_option(),
            {"point", "P", "the design point that the headline speaks of (default: the best)"},
            {"sort", "NAME", "order rows by a value, with -NAME from the largest on, or by 'best'"},
            {"where", "CONDITION", "rows that meet it, such as 'ki < 2e4'; may be repeated", true},
            {"top", "N", "the first N rows; without --sort the best"},
            {"legend", "", "explain the columns of the table"},
            {"confirm", "N", "run the chosen point again with N new trials, and print what they show"},
            command_line::read_file(
                {"plugin", "LIBRARY", "for --confirm: the controller of a study that has one of its own"}),
            {"confidence", "LEVEL", "confidence of all bounds, between 0 and 1 (default 0.95)"}}},
          "print the statistics of a results file",
          summary_help,
          summarise_file,
          [] { return std::vector{summary_answer::summary_type()}; }};
}

}  // namespace zerocount::result_commands
