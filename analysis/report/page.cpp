#include "analysis/report/page.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/document/markup.hpp"
#include "analysis/report/embedded_files.hpp"
#include "analysis/report/figures/axis_ticks.hpp"
#include "analysis/report/html.hpp"
#include "core/hash/sha256.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

ordered_json colours() {
  return ordered_json::parse(embedded_file("colours.json"));
}

std::string css_variables(const ordered_json& values) {
  std::string text;
  for (const auto& [name, value] : values.items())
    text += fmt::format("{}:{};", name, value.get<std::string>());
  return text;
}

/// The colours as CSS: light, dark if the reader's system is dark, and always light in print.
std::string css_colours() {
  const ordered_json all = colours();
  return fmt::format(
      ":root{{color-scheme:light dark;{}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}\n",
      css_variables(all["light"]), css_variables(all["dark"]));
}

bool has_figures(const ReportPage& page) {
  return std::ranges::any_of(page.sections, [](const PageSection& one) { return !one.figures.empty(); });
}

std::string without_scripts_html(const ReportPage& page) {
  if (!has_figures(page)) return "";
  return "<noscript><p class=\"warning\">The figures are drawn by JavaScript, which is turned off "
         "here.</p></noscript>";
}

/// The scripts of the page, in the order in which they run; none without figures.
std::vector<std::string> script_sources(const ReportPage& page) {
  if (!has_figures(page)) return {};
  std::vector<std::string_view> names(drawing_libraries.begin(), drawing_libraries.end());
  names.emplace_back("page.js");
  std::vector<std::string> sources(names.size());
  std::transform(names.begin(), names.end(), sources.begin(),
                 [](std::string_view name) { return script_source(embedded_file(name)); });
  return sources;
}

std::string script_elements(const std::vector<std::string>& sources) {
  std::string text;
  for (const std::string& source : sources) text += fmt::format("<script>{}</script>\n", source);
  return text;
}

/// The sources that a Content-Security-Policy (level 2) allows: the hashes of these scripts.
std::string script_hashes(const std::vector<std::string>& sources) {
  if (sources.empty()) return "'none'";
  std::string text;
  for (const std::string& source : sources)
    text += fmt::format("{}'sha256-{}'", text.empty() ? "" : " ", hash::base64(hash::sha256(source)));
  return text;
}

/// The mark of an unfinished page, in its head.
constexpr std::string_view unfinished_mark = "<meta name=\"zerocount\" content=\"unfinished\">\n";

std::string state_elements(PageState state) {
  if (state == PageState::finished) return "";
  const std::string reload =
      state == PageState::live ? fmt::format("<meta http-equiv=\"refresh\" content=\"{}\">\n", live_interval)
                               : std::string();
  return std::string(unfinished_mark) + reload;
}

ordered_json figures_json(const ReportPage& page) {
  ordered_json figures = ordered_json::array();
  for (const PageSection& section : page.sections) {
    for (const Figure& figure : section.figures) {
      figures.push_back(
          {{"name", figure.name}, {"specification", with_tick_labels(figure)}, {"data", data_json(figure)}});
    }
  }
  return {{"theme", figure_theme()}, {"figures", figures}};
}

std::string figure_html(const Figure& figure) {
  return fmt::format(
      "<figure id=\"figure-{0}\"><h3>{1}</h3><div class=\"plot\" role=\"img\" "
      "aria-label=\"{1}\"></div><figcaption>{2}</figcaption><details class=\"data\"><summary>Data of this "
      "figure</summary><div class=\"scroll\"></div></details></figure>\n",
      document::markup(figure.name), document::markup(figure.title), document::prose_markup(figure.caption));
}

std::string section_html(const PageSection& section) {
  std::string text = fmt::format("<section id=\"{}\">", document::markup(section.name));
  if (!section.title.empty()) text += fmt::format("<h2>{}</h2>\n", document::markup(section.title));
  text += section.html + "\n";
  if (!section.figures.empty()) text += "<div class=\"figures\">\n";
  for (const Figure& figure : section.figures) text += figure_html(figure);
  if (!section.figures.empty()) text += "</div>\n";
  return text + section.html_after + "</section>\n";
}

/// The links to the sections, of a page with several.
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

/// Replaces each {{name}} of the template in one pass; inserted texts are not expanded again.
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

}  // namespace

bool is_unfinished_page(const std::filesystem::path& path) {
  std::string head(1000, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(unfinished_mark) != std::string::npos;
}

ordered_json figure_theme() {
  return ordered_json::parse(embedded_file("theme.json"));
}

ordered_json light_colours() {
  return colours()["light"];
}

std::string html_page(const ReportPage& page) {
  std::string sections;
  for (const PageSection& section : page.sections) sections += section_html(section);
  const std::vector<std::string> sources = script_sources(page);
  return filled(embedded_file("page.html"), {{"kind", document::markup(page.kind)},
                                             {"without-scripts", without_scripts_html(page)},
                                             {"title", document::markup(page.title)},
                                             {"subtitle", document::markup(page.subtitle)},
                                             {"footer", document::markup(page.footer)},
                                             {"colours", css_colours()},
                                             {"style", std::string(embedded_file("page.css"))},
                                             {"contents", contents_html(page)},
                                             {"sections", sections},
                                             {"figures", script_json(figures_json(page))},
                                             {"scripts", script_elements(sources)},
                                             {"script-hashes", script_hashes(sources)},
                                             {"state", state_elements(page.state)}});
}

}  // namespace zerocount::report
