#include "analysis/report/page.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/blocks.hpp"
#include "core/hash/sha256.hpp"
#include "results/layout/header.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

std::string css_variables(const char* mode) {
  std::string text;
  const ordered_json colours = colours_of(mode);
  for (const auto& [name, value] : colours.items())
    text += fmt::format("{}:{};", name, value.get<std::string>());
  return text;
}

/// The colours as CSS: light, dark if the reader's system is dark, and always light in print.
std::string css_colours() {
  return fmt::format(
      ":root{{color-scheme:light dark;{}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n",
      css_variables("light"), css_variables("dark"));
}

constexpr std::string_view without_scripts =
    "<noscript><p class=\"warning\">The figures are drawn by JavaScript, which is turned off here; the data "
    "of "
    "each stand below it.</p></noscript>";

/// The scripts of a page with figures, in the order in which they run, and their hashes for the page's
/// Content-Security-Policy (level 2), which allows no other scripts.
struct Scripts {
  std::string elements{};
  std::string hashes{"'none'"};
};

Scripts scripts_of_figures() {
  Scripts scripts{"", ""};
  const auto add = [&](std::string_view name) {
    const std::string source = script_source(embedded_file(name));
    scripts.elements += fmt::format("<script>{}</script>\n", source);
    scripts.hashes +=
        fmt::format("{}'sha256-{}'", scripts.hashes.empty() ? "" : " ", hash::base64(hash::sha256(source)));
  };
  for (const std::string_view name : drawing_scripts) add(name);
  add("page.js");
  return scripts;
}

/// HTML in the head of a page that marks the page as unfinished.
constexpr std::string_view unfinished_mark = "<meta name=\"zerocount\" content=\"unfinished\">\n";

/// HTML element in the head of a page that names the source (such as a results file) it was made from; empty
/// without a source.
std::string source_element(const std::string& source) {
  if (source.empty()) return "";
  return fmt::format("<meta name=\"zerocount-source\" content=\"{}\">\n", document::markup(source));
}

std::string state_elements(PageState state) {
  if (state == PageState::finished) return "";
  const std::string reload =
      state == PageState::live ? fmt::format("<meta http-equiv=\"refresh\" content=\"{}\">\n", live_interval)
                               : std::string();
  return std::string(unfinished_mark) + reload;
}

std::string cell_text(const ordered_json& value) {
  if (value.is_null()) return "–";
  if (value.is_string()) return document::markup(value.get<std::string>());
  return value.is_number_float() ? fmt::format("{:.5g}", value.get<double>()) : value.dump();
}

/// HTML table of the data behind a figure, which can be read without scripts too. It can have thousands of
/// cells, so it omits end tags, which HTML allows, and does not repeat the column heads in the cells as
/// document::html() does.
std::string data_table(const FigureData& data) {
  std::string html = "<table><thead><tr>";
  const auto style = [&](std::size_t i) { return data.columns[i].unit.empty() ? " class=text" : ""; };
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < data.columns.size(); ++i) {
    const FigureColumn& column = data.columns[i];
    if (column.title.empty()) continue;
    shown.push_back(i);
    const std::string unit =
        column.unit.empty() || column.unit == "1"
            ? ""
            : fmt::format("<span class=\"unit\">{}</span>", document::markup(column.unit));
    html += fmt::format("<th{}>{}{}</th>", style(i), document::markup(column.title), unit);
  }
  html += "</tr></thead><tbody>\n";
  for (const ordered_json& row : data.rows) {
    html += "<tr>";
    for (const std::size_t i : shown) html += fmt::format("<td{}>{}", style(i), cell_text(row[i]));
    html += "\n";
  }
  return html + "</tbody></table>";
}

std::string figure_html(const Figure& figure) {
  return fmt::format(
      "<figure id=\"figure-{0}\"><h3>{1}</h3><div class=\"plot\" role=\"img\" "
      "aria-label=\"{1}\"></div><figcaption>{2}</figcaption><details class=\"data\"><summary>Data of this "
      "figure</summary><div class=\"scroll\">{3}</div></details></figure>\n",
      document::markup(figure.name), document::markup(figure.title), document::prose_markup(figure.caption),
      data_table(figure.data.front()));
}

/// Collects the figures that a page shows, up to a limit of number and size. A reader looks at some dozens,
/// and a browser draws about twenty a second.
class FiguresInPage {
 public:
  /// Takes the figure into the page if there is room for it.
  /// @param element HTML element in which it is drawn
  /// @returns whether there was room
  bool take(const Figure& figure, const std::string& element) {
    constexpr std::size_t max_figures = 48;
    constexpr std::size_t max_bytes = std::size_t{5} << 19;
    ordered_json json = figure_json(figure);
    const std::size_t bytes = element.size() + json.dump().size();
    if (json_.size() >= max_figures || (!json_.empty() && bytes_ + bytes > max_bytes)) return false;
    bytes_ += bytes;
    json_.push_back(std::move(json));
    return true;
  }

  /// The data of the taken figures, as a JSON array for the drawing script.
  ordered_json& json() { return json_; }

 private:
  ordered_json json_ = ordered_json::array();
  std::size_t bytes_{0};
};

/// Sentence part that says how to see the figures that a page leaves out.
/// @param kind command that wrote the page
std::string where_others_are(const std::string& kind) {
  if (kind == "report")
    return "'zerocount plot FILE' lists all names, and with --figure NAME it draws one of them";
  if (kind == "history") return "--study, --point and --measure choose others";
  return "a page about fewer points, conditions or records has them";
}

std::string left_out_html(const PageSection& section, std::size_t left_out, const std::string& kind) {
  if (left_out == 0) return "";
  return fmt::format(
      "<p class=\"left-out\">{} of {} figures are left out, so that a browser can show the page: {}.</p>\n",
      left_out, section.figures.size(), document::markup(where_others_are(kind)));
}

std::string section_html(const PageSection& section, const std::string& kind, FiguresInPage& figures) {
  std::string text = fmt::format("<section id=\"{}\">", document::markup(section.name));
  if (!section.title.empty()) text += fmt::format("<h2>{}</h2>\n", document::markup(section.title));
  text += section.html + "\n";
  if (!section.figures.empty()) text += "<div class=\"figures\">\n";
  std::size_t left_out = 0;
  for (const Figure& figure : section.figures) {
    const std::string element = figure_html(figure);
    if (figures.take(figure, element)) {
      text += element;
    } else {
      ++left_out;
    }
  }
  if (!section.figures.empty()) text += "</div>\n";
  text += left_out_html(section, left_out, kind);
  return text + section.html_after + "</section>\n";
}

/// HTML list of links to the sections of a page; empty for a page with one section.
std::string contents_html(const ReportPage& page) {
  if (page.sections.size() < 2) return "";
  std::string text;
  for (const PageSection& section : page.sections) {
    if (section.title.empty()) continue;
    text += fmt::format("<a href=\"#{}\">{}</a>\n", document::markup(section.name),
                        document::markup(section.title));
  }
  return text;
}

/// The template with each {{name}} replaced by its value. Inserted texts are not searched for further names.
std::string filled(std::string_view pattern, const std::map<std::string_view, std::string>& values) {
  std::string text;
  while (true) {
    const std::size_t begin = pattern.find("{{");
    if (begin == std::string_view::npos) return text += pattern;
    const std::size_t end = pattern.find("}}", begin);
    text += pattern.substr(0, begin);
    text += values.at(pattern.substr(begin + 2, end - begin - 2));
    pattern.remove_prefix(end + 2);
  }
}

/// The first bytes of a page, which include the HTML head with its descriptive elements.
std::string head_of(const std::filesystem::path& path) {
  std::string head(1000, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head;
}

}  // namespace

bool is_unfinished_page(const std::filesystem::path& path) {
  return head_of(path).find(unfinished_mark) != std::string::npos;
}

bool is_page_of(const std::filesystem::path& path, const std::string& source) {
  return !source.empty() && head_of(path).find(source_element(source)) != std::string::npos;
}

std::string html_page(const ReportPage& page) {
  std::string sections;
  FiguresInPage in_page;
  for (const PageSection& section : page.sections) sections += section_html(section, page.kind, in_page);
  ordered_json& figures = in_page.json();
  const Scripts scripts = figures.empty() ? Scripts{} : scripts_of_figures();
  return filled(embedded_file("page.html"),
                {{"kind", document::markup(page.kind)},
                 {"without-scripts", figures.empty() ? "" : std::string(without_scripts)},
                 {"title", document::markup(page.title)},
                 {"subtitle", document::markup(page.subtitle)},
                 {"footer", document::markup(page.footer)},
                 {"colours", css_colours()},
                 {"style", std::string(embedded_file("page.css"))},
                 {"contents", contents_html(page)},
                 {"sections", sections},
                 {"figures", script_json({{"theme", figure_theme()}, {"figures", std::move(figures)}})},
                 {"scripts", scripts.elements},
                 {"script-hashes", scripts.hashes},
                 {"state", state_elements(page.state) + source_element(page.source)}});
}

std::string html_folded(const std::string& head, const std::string& html) {
  return fmt::format("<details><summary>{}</summary>{}</details>\n", document::markup(head), html);
}

PageSection answer_section(std::string name, std::string title, const document::Answer& answer) {
  return {std::move(name), std::move(title), document::html(answer), document::figures(answer)};
}

PageSection figures_first(std::string name, std::string title, const document::Answer& answer) {
  PageSection section{std::move(name), std::move(title), "", document::figures(answer)};
  std::string rest;
  for (const document::Block& block : document::blocks(answer))
    (std::holds_alternative<document::HeadlineBlock>(block) ? section.html : rest) += document::html(block);
  section.html_after = html_folded("Numbers", rest);
  return section;
}

ReportPage answer_page(const document::Answer& answer) {
  return {answer.type.meaning,
          "",
          fmt::format("zerocount {}", layout::current_provenance().zerocount_version),
          {answer_section("answer", "Answer", answer)},
          answer.type.name};
}

std::vector<std::string> figure_names(const ReportPage& page) {
  std::vector<std::string> names;
  for (const PageSection& section : page.sections) {
    for (const Figure& figure : section.figures) names.push_back(figure.name);
  }
  return names;
}

const Figure& find_figure(const ReportPage& page, const std::string& name) {
  for (const PageSection& section : page.sections) {
    const auto found = std::ranges::find(section.figures, name, &Figure::name);
    if (found != section.figures.end()) return *found;
  }
  const std::vector<std::string> known = figure_names(page);
  throw Failure(ExitCode::bad_input,
                fmt::format("unknown figure '{}'; this study has: {}", name,
                            known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
}

}  // namespace zerocount::report
