#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary/chosen_summary.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "runners/commands/command.hpp"
#include "runners/result_commands/report_parts.hpp"

namespace zerocount::result_commands {
namespace {

namespace fs = std::filesystem;

/// A results file in the folder, as a row of the index page.
struct IndexedFile {
  fs::path file;
  std::string study{};
  /// Date on which the file was made, as in layout::Header::created; empty if unknown.
  std::string created{};
  std::string goal{};
  std::string verdict{};
  bool has_report{false};
  std::string page{};  ///< File name of the page with the file's report; empty without a page.
};

/// Paths of the results files in the folder, and of those that unfinished runs will write.
std::vector<fs::path> results_in_folder(const fs::path& folder) {
  constexpr std::string_view shards = ".h5.shards";
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
    if (name.ends_with(shards)) files.push_back(fs::path(entry.path()).replace_extension());
  }
  if (error)
    throw Failure(ExitCode::bad_input, fmt::format("{}: {}; expected a folder that can be read",
                                                   folder.string(), error.message()));
  std::ranges::sort(files);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

/// Fills the row with the file's study, date and verdict.
/// @throws Failure if the file cannot be read
void describe(IndexedFile& row) {
  const layout::FileHeader header = shards::inspect_header(row.file, layout::Checksum::not_yet);
  row.created = header.provenance.created;
  row.has_report = header.retention == study::Retention::trials;
  const auto [summary, chosen, measures] = summary::summarise_chosen(row.file);
  row.study = summary.name;
  if (!summary.question.goal()) {
    row.verdict = summary::claim_of_chosen_point(summary, chosen);
    return;
  }
  row.goal = goal::claim_sentence(summary.question);
  row.verdict = summary::judgement_headline(summary, summary::judge_point(summary, chosen));
}

IndexedFile indexed(const fs::path& file) {
  IndexedFile row{.file = file};
  std::error_code error;
  if (!fs::exists(file, error)) {
    row.verdict = "unfinished: its run has not ended";
    return row;
  }
  try {
    describe(row);
  } catch (const Failure& failure) {
    return {.file = file, .verdict = failure.what()};
  }
  return row;
}

std::string table_of(const std::vector<IndexedFile>& rows) {
  document::TableBlock table;
  for (const char* const head : {"study", "from (UTC)", "verdict", "goal", "report"})
    table.columns.push_back({head, "", false});
  for (const IndexedFile& row : rows) {
    table.add_row({row.study.empty() ? row.file.filename().string() : row.study,
                   row.created.empty() ? "–" : row.created.substr(0, 16), row.verdict, row.goal,
                   row.page.empty() ? "–" : row.page});
    table.columns.back().links.push_back(row.page);
  }
  return document::html(table);
}

}  // namespace

report::ReportPage folder_index(const fs::path& folder, const fs::path& index,
                                const std::function<void(const fs::path&, const fs::path&)>& write_page) {
  std::vector<IndexedFile> rows;
  for (const fs::path& file : results_in_folder(folder)) {
    rows.push_back(indexed(file));
    IndexedFile& row = rows.back();
    if (!row.has_report) continue;
    const fs::path page = index.parent_path() / fs::path(file.filename()).replace_extension(".html");
    if (!report::is_page_of(page, commands::report_source(file))) write_page(file, page);
    row.page = page.filename().string();
  }
  if (rows.empty())
    throw Failure(ExitCode::bad_input, fmt::format("{}: it has no results file; expected a folder with files "
                                                   "*.h5, or one such file",
                                                   folder.string()));
  std::ranges::stable_sort(rows, std::ranges::greater(), &IndexedFile::created);
  const std::string provenance = layout::current_provenance().zerocount_version;
  return {.title = "Studies",
          .subtitle = fmt::format("{} results files, the newest first", rows.size()),
          .footer = fmt::format("zerocount {}", provenance),
          .sections = {{"studies", "", table_of(rows), {}}},
          .kind = "index"};
}

}  // namespace zerocount::result_commands
