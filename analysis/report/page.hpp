#pragma once

#include <filesystem>
#include <string>
#include <vector>

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
};

/// The report as one self-contained HTML document, without network requests.
/// @throws Failure (machine_failed) if the program was built without the libraries for drawing.
std::string html_page(const ReportPage& page);

/// Whether the file is a page that is live or unfinished.
bool is_unfinished_page(const std::filesystem::path& path);

/// The theme of all figures as a Vega-Lite config. Its colours are CSS variables such as "var(--ink)", which
/// the page defines for light and dark mode.
nlohmann::ordered_json figure_theme();

/// The colours of light mode, {"--ink": "#…"}.
nlohmann::ordered_json light_colours();

}  // namespace zerocount::report
