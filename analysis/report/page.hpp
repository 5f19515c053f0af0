#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/basis/document/answer.hpp"
#include "analysis/report/figures/figure.hpp"

namespace zerocount::report {

/// A section of the HTML page.
struct PageSection {
  std::string name;  ///< Name of the HTML anchor that links lead to.
  /// Title as plain text; empty for the first screen, which follows the title of the page.
  std::string title;
  std::string html;  ///< HTML of the section, placed before its figures.
  std::vector<Figure> figures;
  std::string html_after{};  ///< HTML of the section, placed after its figures.
};

/// State of a page: final, or to be replaced by a later page.
enum class PageState {
  finished,
  live,  ///< The page shows work in progress. The browser reloads it every live_interval.
  /// The work ended before its answer. A later page replaces this one (is_unfinished_page()).
  unfinished
};

/// Time between two versions of a page that shows long work in progress, s.
inline constexpr int live_interval = 2;

/// The contents of a report, before conversion to HTML.
struct ReportPage {
  std::string title;     ///< Title as plain text.
  std::string subtitle;  ///< Subtitle as plain text.
  std::string footer;    ///< Footer as plain text.
  std::vector<PageSection> sections;
  std::string kind{"report"};  ///< Command that wrote the page.
  PageState state{PageState::finished};
  /// Text that identifies the source of the page (such as a results file), for is_page_of(); empty: none.
  std::string source{};
};

/// The report as one self-contained HTML document, without network requests.
/// @throws Failure (machine_failed) if the program was built without the libraries for drawing.
std::string html_page(const ReportPage& page);

/// Whether the file is a page that is live or unfinished, so that a later page may replace it.
bool is_unfinished_page(const std::filesystem::path& path);

/// Whether the file is a page whose ReportPage::source is this source.
bool is_page_of(const std::filesystem::path& path, const std::string& source);

/// HTML element that shows only the line `head` until the reader opens it. It is not printed.
std::string html_folded(const std::string& head, const std::string& html);

/// An answer of a command, with its figures, as a section of a page.
PageSection answer_section(std::string name, std::string title, const document::Answer& answer);

/// An answer of a command as a section that shows the headline and the figures; the reader can unfold the
/// rest.
PageSection figures_first(std::string name, std::string title, const document::Answer& answer);

/// An answer of a command as a page of its own, with its figures.
ReportPage answer_page(const document::Answer& answer);

/// The names of all figures of a page.
std::vector<std::string> figure_names(const ReportPage& page);

/// The figure with this name.
/// @throws Failure (bad_input) if the page has no such figure; the message lists the existing ones.
const Figure& find_figure(const ReportPage& page, const std::string& name);

}  // namespace zerocount::report
