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

/// The page of a folder of results, such as a nightly job publishes: for each file its study, date, goal and
/// verdict, and a link to its report; the newest first. A file that cannot be read says why, and a run that
/// has not ended says so.
/// @param write_page writes the report of a file to a page beside the index; it is not called if the page
/// there has the source commands::report_source() of the file
/// @throws Failure (bad_input) without a results file in the folder, and what `write_page` throws
report::ReportPage folder_index(const std::filesystem::path& folder, const std::filesystem::path& index,
                                const std::function<void(const std::filesystem::path& file,
                                                         const std::filesystem::path& page)>& write_page);

/// `--with`, the parts of a report that are answers of other commands, and `--budget` of them.
std::vector<command_line::OptionSpec> part_options();

/// The names of --with in the order in which they are answered; none without the option.
/// @throws Failure (bad_input) for another name
std::vector<std::string_view> parts_option(const command_line::Arguments& arguments);

/// The study and point of the parts.
struct PartsSubject {
  const reading::AllTrialsFile& file;
  std::optional<std::int64_t> point;  ///< default: the best
};

/// The answers of these commands on the file's study, each as a section under its question. A part that
/// cannot be answered says why.
///
///     tell how long each takes at most, by the trials that it runs and the speed of the study here
///     for each part: answer it within half of what is left of the budget, the last one within all
///
/// @param stop leaves out the part that is in work, and the later ones
std::vector<report::PageSection> part_sections(const PartsSubject& subject,
                                               const std::vector<std::string_view>& names,
                                               const command_line::Budget& budget,
                                               const std::stop_token& stop);

}  // namespace zerocount::result_commands
