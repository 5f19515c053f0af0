#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/goal/goal_verdict.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page.hpp"
#include "analysis/report/report.hpp"
#include "core/failure/failure.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/results_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::commands {

/// One command of the command line.
struct Command {
  command_line::CommandSpec spec;
  std::string summary;  ///< one line
  std::string help;     ///< complete description with examples
  ExitCode (*run)(const command_line::Arguments&){nullptr};
  /// Types of answers that it gives; null where it answers no question. A type takes long to describe.
  std::vector<document::AnswerType> (*answers)(){nullptr};
};

/// Prints to stderr that the lock is a file with an owner, if it is.
void print_fallback_lock(const storage::OutputLock& lock, const std::filesystem::path& output);

/// Prints the warnings about the manifest and its loops to stderr.
void print_warnings(const study::Study& study);

/// success for a goal that is met, regression for one that is missed, inconclusive.
ExitCode exit_code_of(goal::Status status);

/// A figure as SVG, as PNG with 300 pixels per inch at a width of 140 mm, or as a Vega-Lite specification
/// that needs nothing else. Runs node, and rsvg-convert for PNG.
/// @param extension ".svg", ".png" or ".json"
/// @throws Failure (machine_failed) where they are missing or fail.
std::string picture(const report::Figure& figure, std::string_view extension);

/// The kind of a file with figures: an HTML page of all of them, or a picture of one.
enum class DrawingKind { page, svg, png };

/// The kind by the ending of a file's name; standard output gets a page. Refuses other endings.
DrawingKind drawing_kind(const command_line::Arguments& arguments, std::string_view option,
                         const std::filesystem::path& place);

/// The page, or the picture of its first figure.
/// @throws Failure as picture().
std::string drawing(const report::ReportPage& page, DrawingKind kind);

/// Whether `path` is a results file, by its signature or by its name (the signature may be damaged).
bool is_results_file(const std::filesystem::path& path);

/// @throws Failure (bad_input) if the trials of the file's study cannot be run: its controller is a plugin
void require_simulable(const reading::ResultsFile& file);

/// The study of a finished results file, by its description: none of its trials is read, nor its checksum.
/// @throws Failure as layout::recorded_study and shards::inspect_header
study::Study described_study(const std::filesystem::path& path);

/// The study of `MANIFEST|FILE`: that of a manifest, with the overrides of `--set`, or the one whose trials a
/// complete results file holds. The files that a manifest names are found from its folder, or from the
/// current one if it is a stream.
/// @throws Failure: bad_input with every error of the manifest, or if a file that it names is an output of
/// the command, even with --force; of a results file with --set or with a plugin, which the file does not
/// contain; otherwise as reading::ResultsFile
study::Study load_study(const std::filesystem::path& operand, const command_line::Arguments& arguments);

/// `--point` of `MANIFEST|FILE`: a point by label or number, or `best`, which is summary::best_point() of a
/// results file and the only point of a manifest; nothing without the option.
/// @throws Failure: bad_input for `best` of a manifest with several points; as summary::summarise_file
std::optional<std::int64_t> study_point(const command_line::Arguments& arguments, const study::Study& study);

/// The user's controller for the trials of a results file, of the option --plugin; null if none is given.
std::shared_ptr<const plugin::ControllerPlugin> plugin_option(const command_line::Arguments& arguments);

/// The source of the report of a results file: its contents, by their checksum, and the build of the program.
std::string report_source(const std::filesystem::path& file);

/// The report of a results file, with its report_source(), and with a warning for each trial that is
/// simulated again and differs from its record. Prints the warnings.
/// @throws Failure as report::study_report
report::StudyReport verified_report(const reading::AllTrialsFile& file, report::ReportOptions options = {});

}  // namespace zerocount::commands
