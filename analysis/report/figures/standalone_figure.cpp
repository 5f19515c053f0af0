#include "analysis/report/figures/standalone_figure.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "analysis/report/figures/axis_ticks.hpp"
#include "analysis/report/page.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr int width = 560;                // pixels
constexpr int room_of_axes = 80;          // beside the plots of a composed figure, unless it says its own
constexpr double width_of_letter = 6.4;   // of a legend
constexpr double width_of_symbol = 32.0;  // and its gaps
constexpr double width_of_legend = 500.0;
constexpr std::size_t shortest_label = 8;  // letters
constexpr int max_legend_columns = 8;
constexpr int max_label_pixels = 480;

/// Puts the colours in the place of var(--name) in all texts.
void colour(ordered_json& part, const ordered_json& colours) {
  if (part.is_string()) {
    std::string& text = part.get_ref<std::string&>();
    for (std::size_t start = 0; (start = text.find("var(", start)) != std::string::npos;) {
      const std::size_t end = text.find(')', start);
      if (end == std::string::npos) return;
      const auto value = colours.find(text.substr(start + 4, end - start - 4));
      if (value == colours.end()) {
        start = end;
      } else {
        text.replace(start, end - start + 1, value->get<std::string>());
      }
    }
  } else if (part.is_structured()) {
    for (ordered_json& inner : part) colour(inner, colours);
  }
}

/// Gives a width in pixels to all parts that take the width of the page.
void set_width(ordered_json& part, int pixels) {
  if (part.is_object()) {
    const auto own = part.find("width");
    if (own != part.end() && *own == "container") *own = pixels;
  }
  if (!part.is_structured()) return;
  for (ordered_json& inner : part) set_width(inner, pixels);
}

/// The datasets by their names: [row] an object.
ordered_json datasets_of(const Figure& figure) {
  ordered_json datasets = ordered_json::object();
  for (const FigureData& data : figure.data) {
    ordered_json& rows = datasets[data.name] = ordered_json::array();
    for (const ordered_json& row : data.rows) {
      ordered_json object;
      for (std::size_t i = 0; i < data.columns.size(); ++i) object[data.columns[i].field] = row[i];
      rows.push_back(std::move(object));
    }
  }
  return datasets;
}

/// Letters of the longest entry of a legend.
std::size_t longest_label(const FigureData& data) {
  std::size_t longest = shortest_label;
  for (std::size_t i = 0; i < data.columns.size(); ++i) {
    if (data.columns[i].field != "label" && data.columns[i].field != "series") continue;
    for (const ordered_json& row : data.rows) {
      if (row[i].is_string())
        longest = std::max(longest, text::display_width(row[i].get_ref<const std::string&>()));
    }
  }
  return longest;
}

/// The theme, with as many columns of the legend as its entries leave room for.
ordered_json theme_of(const Figure& figure) {
  ordered_json theme = figure_theme();
  const double entry =
      width_of_letter * static_cast<double>(longest_label(figure.data.front())) + width_of_symbol;
  theme["legend"]["columns"] = std::clamp(static_cast<int>(width_of_legend / entry), 1, max_legend_columns);
  theme["legend"]["labelLimit"] = max_label_pixels;
  theme["background"] = "white";
  return theme;
}

}  // namespace

ordered_json standalone_specification(const Figure& figure) {
  ordered_json specification = with_tick_labels(figure);
  const bool composed = specification.contains("vconcat");
  const int room = specification.value("usermeta", ordered_json::object()).value("margin", room_of_axes);
  set_width(specification, composed ? width - room : width);
  if (!composed) specification["autosize"] = {{"type", "fit-x"}, {"contains", "padding"}};
  specification["config"] = theme_of(figure);
  colour(specification, light_colours());
  specification["datasets"] = datasets_of(figure);
  return specification;
}

}  // namespace zerocount::report
