#include "analysis/report/figures/figure.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/text/text.hpp"

namespace zerocount::report {

using boost::algorithm::replace_all_copy;
using nlohmann::ordered_json;

std::string_view embedded_file(std::string_view name) {
  const std::span<const EmbeddedFile> files = embedded_files();
  const auto found = std::ranges::find(files, name, &EmbeddedFile::name);
  if (found != files.end()) return found->bytes;
  throw Failure(
      ExitCode::machine_failed,
      fmt::format("this zerocount was built without {}, which draws the figures; in its sources, run "
                  "'npm ci --prefix analysis/report' (./quickstart does), then cmake and the build again",
                  name));
}

void require_drawing_libraries() {
  for (const std::string_view script : drawing_scripts) embedded_file(script);
}

Figure figure_of(std::string_view specification, std::string name, std::string title, std::string caption,
                 std::vector<FigureData> data) {
  return {std::move(name), std::move(title), std::move(caption),
          ordered_json::parse(embedded_file(fmt::format("{}.vl.json", specification))), std::move(data)};
}

void call_bounds_too_narrow(Figure& figure, const std::string& why) {
  bool found = false;
  for (FigureData& data : figure.data) {
    for (FigureColumn& column : data.columns) {
      if (column.title.find("bound") == std::string::npos) continue;
      column.title += ", too narrow";
      found = true;
    }
  }
  if (found) figure.caption += (figure.caption.ends_with(' ') ? "" : " ") + why;
}

void put_on_axis(Figure& figure, parameters::AxisKind axis) {
  figure.title = parameters::text_on(axis, figure.title);
  figure.caption = parameters::text_on(axis, figure.caption);
  for (FigureData& data : figure.data) {
    for (FigureColumn& column : data.columns) {
      column.title = parameters::text_on(axis, column.title);
      column.unit = parameters::unit_on(axis, column.unit);
    }
  }
}

ordered_json figure_json(const Figure& figure) {
  ordered_json data = ordered_json::array();
  for (const FigureData& part : figure.data) {
    ordered_json columns = ordered_json::array();
    for (const FigureColumn& column : part.columns)
      columns.push_back({column.field, column.title, column.unit});
    data.push_back({{"name", part.name}, {"columns", columns}, {"rows", part.rows}});
  }
  return {{"name", figure.name},
          {"specification", figure.specification},
          {"parameters", figure.parameters},
          {"data", std::move(data)}};
}

ordered_json figure_theme() {
  return ordered_json::parse(embedded_file("theme.json"));
}

ordered_json colours_of(const char* mode) {
  return ordered_json::parse(embedded_file("colours.json"))[mode];
}

std::string script_json(const ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  return replace_all_copy(text, "<", "\\u003c");
}

std::string script_source(std::string_view source) {
  return replace_all_copy(replace_all_copy(std::string(source), "</script", "<\\/script"), "<!--", "<\\!--");
}

std::string drawing_program(const Figure& figure, std::string_view form) {
  const auto quoted = [](std::string_view name) { return ordered_json(embedded_file(name)).dump(); };
  const ordered_json subject{{"figure", figure_json(figure)},
                             {"theme", figure_theme()},
                             {"colours", colours_of("light")},
                             {"wanted", form}};
  return fmt::format(
      // Prevents the libraries from using node's module system.
      "const run = require('vm').runInThisContext;\n"
      "for (const name of ['exports', 'module', 'require']) delete globalThis[name];\n"
      "for (const source of [{}, {}, {}]) run(source);\n"
      "const {{figure, theme, colours, wanted}} = {};\n{}",
      quoted("vega.min.js"), quoted("vega-lite.min.js"), quoted("figures.js"), script_json(subject),
      embedded_file("render.js"));
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

ordered_json datum(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  const double rounded = text::round_to_digits(value, digits);
  if (rounded == std::floor(rounded) && std::abs(rounded) < 1e15) return static_cast<std::int64_t>(rounded);
  return rounded;
}

void scale_ages(Figure& figure, const std::vector<double>& ages) {
  const std::size_t first = ages.front() > 0.0 ? 0 : 1;
  constexpr double decade = 10.0;
  if (first >= ages.size() || ages.back() < decade * ages[first]) return;
  figure.parameters["ages"] = ages;
  figure.parameters["scale"] = first == 0 ? "log" : "symlog";
  if (first > 0) figure.parameters["constant"] = ages[first];
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

std::vector<std::size_t> extreme_samples(std::size_t first, std::size_t end,
                                         const std::vector<SampleQuantity>& quantities) {
  if (first >= end) return {};
  std::vector<std::size_t> samples{first, end - 1};
  for (const SampleQuantity& quantity : quantities) {
    const auto [lowest, highest] = std::ranges::minmax_element(std::views::iota(first, end), {}, quantity);
    samples.insert(samples.end(), {*lowest, *highest});
  }
  std::sort(samples.begin(), samples.end());
  samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
  return samples;
}

std::vector<std::size_t> thinned_samples(std::size_t samples, std::size_t length,
                                         const std::vector<SampleQuantity>& quantities,
                                         const std::function<bool(std::size_t)>& begins) {
  std::vector<std::size_t> kept;
  for (std::size_t first = 0, end = 0; first < samples; first = end) {
    do ++end;
    while (end < samples && end % length != 0 && !(begins && begins(end)));
    const std::vector<std::size_t> group = extreme_samples(first, end, quantities);
    kept.insert(kept.end(), group.begin(), group.end());
  }
  return kept;
}

}  // namespace zerocount::report
