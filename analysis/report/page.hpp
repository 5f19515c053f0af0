#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/document/answer.hpp"
#include "analysis/report/figures/figure.hpp"

namespace zerocount::report {

/// A section of the page.
struct PageSection {
  std::string name;   ///< anchor in the page
  std::string title;  ///< plain text; empty for the first screen, which follows the title of the page
  std::string html;   ///< before the figures
  std::vector<Figure> figures;
  std::string html_after{};  ///< after the figures
};

/// Whether a page is the last one of its place.
enum class PageState {
  finished,
  live,       ///< the browser loads it again every live_interval
  unfinished  ///< the work ended before its answer; a later page takes its place (is_unfinished_page)
};

/// Between two pages of long work that is shown while it is done, s.
inline constexpr int live_interval = 2;

/// The contents of a report, before conversion to HTML.
struct ReportPage {
  std::string title;     ///< plain text
  std::string subtitle;  ///< plain text
  std::string footer;    ///< plain text
  std::vector<PageSection> sections;
  std::string kind{"report"};  ///< the command that wrote it
  PageState state{PageState::finished};
  std::string source{};  ///< Identifies what the page was made from, for is_page_of(); empty: nothing.
};

/// The report as one self-contained HTML document, without network requests.
/// @throws Failure (machine_failed) if the program was built without the libraries for drawing.
std::string html_page(const ReportPage& page);

/// Whether the file is a page that is live or unfinished.
bool is_unfinished_page(const std::filesystem::path& path);

/// Whether the file is a page that was made from this source.
bool is_page_of(const std::filesystem::path& path, const std::string& source);

/// HTML below the line `head`, which shows and hides it. It is not printed.
std::string html_folded(const std::string& head, const std::string& html);

/// An answer with its figures as a section.
PageSection answer_section(std::string name, std::string title, const document::Answer& answer);

/// An answer as a section: its headline and its figures, all else folded.
PageSection figures_first(std::string name, std::string title, const document::Answer& answer);

/// An answer as a page of its own, with its figures.
ReportPage answer_page(const document::Answer& answer);

/// The names of all figures of a page.
std::vector<std::string> figure_names(const ReportPage& page);

/// @throws Failure (bad_input) if the page has no such figure; the message lists the existing ones.
const Figure& find_figure(const ReportPage& page, const std::string& name);

}  // namespace zerocount::report
