#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "analysis/report/page.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::result_commands {

/// Page of a folder of results, such as a nightly job publishes. It lists for each file its study, date, goal
/// and verdict, and a link to its report; the newest first. For a file that cannot be read it shows the
/// reason, and a run that has not ended is marked as such.
/// @param write_page writes the report of a file to a page next to the index; not called if the existing page
/// has the source commands::report_source() of the file
/// @throws Failure (bad_input) if the folder has no results file; and all exceptions of `write_page`
report::ReportPage folder_index(const std::filesystem::path& folder, const std::filesystem::path& index,
                                const std::function<void(const std::filesystem::path& file,
                                                         const std::filesystem::path& page)>& write_page);

/// Options `--with`, which adds the answers of other commands (parts) to a report, and `--budget` for these
/// answers.
std::vector<command_line::OptionSpec> part_options();

/// Names of the parts (answers of other commands) that the option --with asks for, in the order in which they
/// are answered; empty without the option.
/// @throws Failure (bad_input) for another name
std::vector<std::string_view> parts_option(const command_line::Arguments& arguments);

/// Study and design point that the parts of a report are about.
struct PartsSubject {
  const reading::AllTrialsFile& file;
  std::optional<std::int64_t> point;  ///< Index of the design point; nothing: the best point.
};

/// Answers of the named commands on the file's study, each as a section of the report under its question. A
/// part that cannot be answered shows the reason.
///
///     tell the maximum duration of each part, from its number of trials and the measured speed
///     for each part: answer it within half of the remaining budget, the last part within all of it
///
/// @param names names from parts_option()
/// @param stop a stop request leaves out the current part and the later ones
std::vector<report::PageSection> part_sections(const PartsSubject& subject,
                                               const std::vector<std::string_view>& names,
                                               const command_line::Budget& budget,
                                               const std::stop_token& stop);

}  // namespace zerocount::result_commands
