#pragma once

#include <filesystem>
#include <functional>

#include "analysis/report/page.hpp"

namespace zerocount::result_commands {

/// The page of a folder of results, such as a nightly job publishes: for each file its study, date, goal and
/// verdict, and a link to its report; the newest first. A file that cannot be read says why, and a run that
/// has not ended says so.
/// @param write_page writes the report of a file to a page beside the index, where there is none that is
/// newer than the file
/// @throws Failure (bad_input) without a results file in the folder, and what `write_page` throws
report::ReportPage folder_index(const std::filesystem::path& folder, const std::filesystem::path& index,
                                const std::function<void(const std::filesystem::path& file,
                                                         const std::filesystem::path& page)>& write_page);

}  // namespace zerocount::result_commands
