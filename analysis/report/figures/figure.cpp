#include "analysis/report/figures/figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "analysis/report/embedded_files.hpp"
#include "core/text/number_text.hpp"

namespace zerocount::report {
namespace {

/// Adds "too narrow" to the title of a bound; returns whether it was one.
bool qualify(std::string& title) {
  if (title.find("bound") == std::string::npos) return false;
  title += ", too narrow";
  return true;
}

/// Calls `change` for all titles in a specification.
template <class Change>
void change_titles(nlohmann::ordered_json& part, const Change& change) {
  if (!part.is_structured()) return;
  for (auto& [key, value] : part.items()) {
    if (key == "title" && value.is_string()) {
      change(value.template get_ref<std::string&>());
    } else {
      change_titles(value, change);
    }
  }
}

/// Converts a title to an axis: "$rotor_angle (µrad)" becomes "position (µm)" on a linear one.
void reword_title(std::string& title, parameters::AxisKind axis) {
  const std::size_t unit = title.ends_with(')') ? title.rfind('(') : std::string::npos;
  if (unit == std::string::npos) {
    title = parameters::text_on(axis, title);
  } else {
    title = parameters::text_on(axis, title.substr(0, unit)) + parameters::unit_on(axis, title.substr(unit));
  }
}

}  // namespace

Figure figure_of(std::string_view specification, std::string name, std::string title, std::string caption,
                 std::vector<FigureData> data) {
  return {std::move(name), std::move(title), std::move(caption),
          nlohmann::ordered_json::parse(embedded_file(fmt::format("{}.vl.json", specification))),
          std::move(data)};
}

void call_bounds_too_narrow(Figure& figure, const std::string& why) {
  bool found = false;
  for (FigureData& data : figure.data) {
    for (FigureColumn& column : data.columns) found = qualify(column.title) || found;
  }
  if (!found) return;
  change_titles(figure.specification, qualify);
  if (!figure.caption.ends_with(' ')) figure.caption += ' ';
  figure.caption += why;
}

void retitle(Figure& figure, const std::map<std::string_view, std::string_view>& words) {
  change_titles(figure.specification, [&](std::string& title) {
    if (const auto found = words.find(title); found != words.end()) title = found->second;
  });
}

void put_on_axis(Figure& figure, parameters::AxisKind axis) {
  const auto reword = [axis](std::string& title) { reword_title(title, axis); };
  figure.title = parameters::text_on(axis, figure.title);
  figure.caption = parameters::text_on(axis, figure.caption);
  change_titles(figure.specification, reword);
  for (FigureData& data : figure.data) {
    for (FigureColumn& column : data.columns) {
      reword(column.title);
      column.unit = parameters::unit_on(axis, column.unit);
    }
  }
}

nlohmann::ordered_json data_json(const Figure& figure) {
  nlohmann::ordered_json data = nlohmann::ordered_json::array();
  for (const FigureData& part : figure.data) {
    nlohmann::ordered_json columns = nlohmann::ordered_json::array();
    for (const FigureColumn& column : part.columns)
      columns.push_back({column.field, column.title, column.unit});
    data.push_back({{"name", part.name}, {"columns", columns}, {"rows", part.rows}});
  }
  return data;
}

void set_rows(Figure& figure, std::size_t rows, int row) {
  figure.specification["height"] = static_cast<int>(rows) * row;
}

void divide_into_panels(Figure& figure, const std::string& field, const std::vector<FigurePanel>& panels) {
  if (panels.size() < 2) return;
  const auto has_field = [&](const std::string& name) {
    const auto data = std::ranges::find(figure.data, name, &FigureData::name);
    return data != figure.data.end() &&
           std::ranges::find(data->columns, field, &FigureColumn::field) != data->columns.end();
  };
  nlohmann::ordered_json view = figure.specification;
  const nlohmann::ordered_json common = view["data"];
  for (const char* const key : {"$schema", "data", "usermeta"}) view.erase(key);
  const nlohmann::ordered_json meta =
      figure.specification.value("usermeta", nlohmann::ordered_json::object());
  nlohmann::ordered_json views = nlohmann::ordered_json::array();
  for (const FigurePanel& panel : panels) {
    nlohmann::ordered_json& part = views.emplace_back(view);
    part["title"] = panel.title;
    for (nlohmann::ordered_json& layer : part["layer"]) {
      if (!layer.contains("data")) layer["data"] = common;
      if (!layer["data"].contains("name") || !has_field(layer["data"]["name"])) continue;
      nlohmann::ordered_json& transform = layer["transform"];
      const nlohmann::ordered_json own = transform;
      transform = {{{"filter", fmt::format("datum.{} == '{}'", field, panel.value)}}};
      for (const nlohmann::ordered_json& one : own) transform.push_back(one);
    }
  }
  figure.specification = {
      {"$schema", figure.specification["$schema"]}, {"usermeta", meta}, {"vconcat", std::move(views)}};
}

FigureData boundaries_data() {
  return {"boundaries",
          {{"line", "", ""}, {"x_from", "", ""}, {"x_to", "", ""}, {"y_from", "", ""}, {"y_to", "", ""}}};
}

void add_boundary(FigureData& boundaries, const std::string& line, const std::vector<CellEdges>& cells,
                  std::size_t columns, const std::function<bool(std::size_t)>& has) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellEdges& cell = cells[i];
    if ((i + 1) % columns != 0 && has(i) != has(i + 1))
      boundaries.rows.push_back(
          {line, datum(cell.x_to), datum(cell.x_to), datum(cell.y_from), datum(cell.y_to)});
    if (i + columns < cells.size() && has(i) != has(i + columns))
      boundaries.rows.push_back(
          {line, datum(cell.x_from), datum(cell.x_to), datum(cell.y_to), datum(cell.y_to)});
  }
}

void colour_by_name(nlohmann::ordered_json& colour, const std::vector<std::string>& names) {
  constexpr std::size_t colours = 8;
  nlohmann::ordered_json range = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < names.size(); ++i) range.push_back(fmt::format("var(--s{})", i % colours + 1));
  colour["scale"] = {{"domain", names}, {"range", std::move(range)}};
}

nlohmann::ordered_json datum(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  const double rounded = text::round_to_digits(value, digits);
  if (rounded == std::floor(rounded) && std::abs(rounded) < 1e15) return static_cast<std::int64_t>(rounded);
  return rounded;
}

nlohmann::ordered_json round_numbers(double low, double high, double smallest) {
  const double largest = std::max(std::abs(low), std::abs(high));
  if (!std::isfinite(largest) || !std::isfinite(smallest) || smallest <= 0.0)
    return nlohmann::ordered_json::array();
  const bool many = largest > 300.0 * smallest;
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  const auto add = [&](double value) {
    if (value >= low && value <= high) numbers.push_back(datum(value));
  };
  add(0.0);
  const int most = static_cast<int>(std::floor(std::log10(std::max(largest, smallest))));
  for (int power = static_cast<int>(std::floor(std::log10(smallest))); power <= most; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, power);
      if (value < 0.999 * smallest || (many && digit != 1.0)) continue;
      add(value);
      add(-value);
    }
  }
  return numbers;
}

void scale_ages(Figure& figure, const std::vector<double>& ages, const std::string& unit) {
  ordered_json& x = figure.specification["encoding"]["x"];
  x["title"] = fmt::format("age ({})", unit);
  const std::size_t first = ages.front() > 0.0 ? 0 : 1;
  constexpr double decade = 10.0;
  if (first >= ages.size() || ages.back() < decade * ages[first]) return;
  x["scale"] = first == 0 ? ordered_json{{"type", "log"}, {"nice", false}}
                          : ordered_json{{"type", "symlog"}, {"constant", ages[first]}, {"nice", false}};
  x["axis"] = {{"values", ages}};
}

bool spaced_by_ratio(const std::vector<double>& sorted) {
  if (sorted.size() < 3 || sorted.front() <= 0.0) return false;
  const double steps = static_cast<double>(sorted.size() - 1);
  const double ratio = std::log(sorted.back() / sorted.front()) / steps;
  const double difference = (sorted.back() - sorted.front()) / steps;
  double by_ratio = 0.0;
  double by_difference = 0.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double step = static_cast<double>(i);
    by_ratio += std::abs(std::log(sorted[i] / sorted.front()) - step * ratio) / (steps * ratio);
    by_difference += std::abs(sorted[i] - sorted.front() - step * difference) / (steps * difference);
  }
  return by_ratio < by_difference;
}

}  // namespace zerocount::report
