#pragma once

#include <string>
#include <vector>

#include "analysis/report/figure.hpp"

namespace zerocount {

/// A part of the page under a heading of its own.
struct PageSection {
  std::string name;   ///< its place in the page
  std::string title;  ///< plain text
  std::string html;   ///< before the figures
  std::vector<Figure> figures;
};

/// A report before it is a page.
struct ReportPage {
  std::string title;     ///< plain text
  std::string subtitle;  ///< plain text
  std::string footer;    ///< plain text
  std::vector<PageSection> sections;
};

/// The page: one HTML document with everything in it, which asks for nothing from anywhere.
/// @throws Failure (machine_failed) where the program was built without the libraries that draw.
std::string html_page(const ReportPage& page);

/// The theme of all figures as a Vega-Lite config. Its colours are names such as "var(--ink)", which the page
/// gives a value for light and for dark.
nlohmann::ordered_json figure_theme();

/// The colours of the theme in the light, {"--ink": "#…"}.
nlohmann::ordered_json light_colours();

}  // namespace zerocount
