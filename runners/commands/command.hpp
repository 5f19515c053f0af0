#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page.hpp"
#include "analysis/report/report.hpp"
#include "analysis/trials/goal/goal_verdict.hpp"
#include "core/failure/failure.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/results_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// One command of the program, such as `zerocount run`.
struct Command {
  command_line::CommandSpec spec;
  std::string summary;  ///< One-line summary of the command for the list of commands.
  std::string help;     ///< Complete help text of the command, with examples.
  ExitCode (*run)(const command_line::Arguments&){nullptr};
  /// Types of the command's answers (for their schema); null if it gives no answers. A function, because
  /// describing a type takes long.
  std::vector<document::AnswerType> (*answers)(){nullptr};
};

/// Prints a warning to stderr if the file system has no real locks, so that the output is protected only by a
/// lock file with the name of its owner.
void print_fallback_lock(const storage::OutputLock& lock, const std::filesystem::path& output);

/// Prints the warnings about a study's manifest and its control loops to stderr.
void print_warnings(const study::Study& study);

/// Exit code of a verdict: success if the goal is met, regression if it is missed, otherwise inconclusive.
ExitCode exit_code_of(goal::Status status);

/// Renders a figure as SVG, as PNG with 300 pixels per inch at a width of 140 mm, or as a self-contained
/// Vega-Lite specification. Runs node, and rsvg-convert for PNG.
/// @param extension ".svg", ".png" or ".json"
/// @throws Failure (machine_failed) if one of these programs is missing or fails
std::string picture(const report::Figure& figure, std::string_view extension);

/// Kind of a file with figures: an HTML page of all figures, or a picture of one figure.
enum class DrawingKind { page, svg, png };

/// Kind of a drawing from the ending of the file name (.html, .svg, .png); a page for standard output.
/// Refuses other endings.
/// @param option option that names the file, for messages
DrawingKind drawing_kind(const command_line::Arguments& arguments, std::string_view option,
                         const std::filesystem::path& place);

/// Contents of a drawing file: the HTML of the page, or the picture of its first figure as SVG or PNG.
/// @throws Failure as picture().
std::string drawing(const report::ReportPage& page, DrawingKind kind);

/// Whether `path` is a results file, by the signature at its beginning or by its name (the signature may be
/// damaged).
bool is_results_file(const std::filesystem::path& path);

/// Checks that the trials of the file's study can be simulated.
/// @throws Failure (bad_input) if they cannot, because the controller is a plugin, which the file does not
/// contain
void require_simulable(const reading::ResultsFile& file);

/// Study that a finished results file describes. Only its description is read, neither trials nor the
/// checksum.
/// @throws Failure as layout::recorded_study and shards::inspect_header
study::Study described_study(const std::filesystem::path& path);

/// Study of `MANIFEST|FILE`: the study of a manifest with the overrides of `--set`, or the study of a
/// complete results file. Paths in a manifest are relative to its folder, or to the current folder if the
/// manifest is a stream.
/// @throws Failure: bad_input with every error of the manifest, or if a file named in the manifest is an
/// output of the command, even with --force; bad_input for a results file with --set or with a plugin, which
/// the file does not contain; otherwise as reading::ResultsFile
study::Study load_study(const std::filesystem::path& operand, const command_line::Arguments& arguments);

/// Index of the design point that the option `--point` names for the operand `MANIFEST|FILE`; nothing without
/// the option. The point is given by label, by number, or as `best`. For a results file, `best` is the best
/// point (summary::summarise_chosen()); for a manifest, its only point.
/// @throws Failure: bad_input for `best` of a manifest with several points; as summary::summarise_chosen()
std::optional<std::int64_t> study_point(const command_line::Arguments& arguments, const study::Study& study);

/// User's controller from the option --plugin, for the trials of a results file; null without the option.
std::shared_ptr<const plugin::ControllerPlugin> plugin_option(const command_line::Arguments& arguments);

/// Text at the end of a report that identifies its source: the checksum of the results file, and the build of
/// the program.
std::string report_source(const std::filesystem::path& file);

/// Report of a results file, with its report_source(), and with a warning for each trial that is simulated
/// again and differs from its record. Prints the warnings.
/// @throws Failure as report::study_report
report::StudyReport verified_report(const reading::AllTrialsFile& file, report::ReportOptions options = {});

}  // namespace zerocount::commands
