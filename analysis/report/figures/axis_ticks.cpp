#include "analysis/report/figures/axis_ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr int figures_of_label = 4;
constexpr double narrowest = 1.0 / 400.0;  ///< range over its largest number, that has two labels

/// An axis of a view, with the channels that share it.
struct NumberAxis {
  std::vector<ordered_json*> channels{};
  double low{INFINITY}, high{-INFINITY};  ///< of the data, or the domain
  double least{INFINITY};                 ///< the least positive absolute value
  bool has_domain{false};

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    if (value != 0.0) least = std::min(least, std::abs(value));
  }
};

std::string text_at(const ordered_json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

/// The value at object[outer][inner]; null where there is none.
const ordered_json* inner_of(const ordered_json& object, const char* outer, const char* inner) {
  const auto part = object.find(outer);
  if (part == object.end() || !part->is_object()) return nullptr;
  const auto found = part->find(inner);
  return found == part->end() ? nullptr : &*found;
}

void take_field(NumberAxis& axis, const Figure& figure, const ordered_json& source,
                const std::string& field) {
  if (const auto values = source.find("values"); values != source.end()) {
    for (const ordered_json& row : *values)
      if (row.contains(field) && row[field].is_number()) axis.take(row[field].get<double>());
    return;
  }
  const auto data = std::ranges::find(figure.data, text_at(source, "name"), &FigureData::name);
  if (data == figure.data.end()) return;
  const auto column = std::ranges::find(data->columns, field, &FigureColumn::field);
  if (column == data->columns.end()) return;
  const auto place = static_cast<std::size_t>(column - data->columns.begin());
  for (const ordered_json& row : data->rows)
    if (row[place].is_number()) axis.take(row[place].get<double>());
}

/// Adds what a view or one of its layers says of an axis.
void add_channel(NumberAxis& axis, const Figure& figure, ordered_json& part, const ordered_json& source,
                 const std::string& name, bool right) {
  const auto encoding = part.find("encoding");
  if (encoding == part.end()) return;
  for (const std::string& channel : {name, name + "2"}) {
    const auto found = encoding->find(channel);
    if (found == encoding->end() || !found->is_object()) continue;
    const ordered_json* orient = inner_of(*found, "axis", "orient");
    if ((orient != nullptr && *orient == "right") != right) continue;
    if (channel == name) {
      if (text_at(*found, "type") != "quantitative") continue;
      axis.channels.push_back(&*found);
    }
    take_field(axis, figure, source, text_at(*found, "field"));
  }
}

NumberAxis axis_of(const Figure& figure, ordered_json& view, const std::string& name, bool right) {
  NumberAxis axis;
  const auto source_of = [&](const ordered_json& part, const ordered_json& otherwise) {
    return part.contains("data") ? part["data"] : otherwise;
  };
  const ordered_json source = source_of(view, source_of(figure.specification, ordered_json::object()));
  add_channel(axis, figure, view, source, name, right);
  const auto add_layers = [&](const auto& self, ordered_json& part) -> void {
    if (!part.contains("layer")) return;
    for (ordered_json& layer : part["layer"]) {
      add_channel(axis, figure, layer, source_of(layer, source), name, right);
      self(self, layer);
    }
  };
  add_layers(add_layers, view);
  for (const ordered_json* channel : axis.channels) {
    const ordered_json* domain = inner_of(*channel, "scale", "domain");
    if (domain == nullptr || domain->size() != 2 || !domain->front().is_number()) continue;
    axis = {.channels = axis.channels, .least = axis.least, .has_domain = true};
    axis.take(domain->front().get<double>());
    axis.take(domain->back().get<double>());
    break;
  }
  return axis;
}

struct Prefix {
  std::string_view text;
  int power;
};
constexpr std::array<Prefix, 10> prefixes{{{"f", -15},
                                           {"p", -12},
                                           {"n", -9},
                                           {"µ", -6},
                                           {"m", -3},
                                           {"", 0},
                                           {"k", 3},
                                           {"M", 6},
                                           {"G", 9},
                                           {"T", 12}}};
constexpr std::array<std::string_view, 10> symbols{"m", "s", "N", "rad", "Hz", "V", "A", "W", "J", "g"};

/// A unit whose first symbol takes SI prefixes.
struct PrefixableUnit {
  int power;           ///< of the prefix that it has
  std::string symbol;  ///< "N", without it
  std::string rest;    ///< " m/count"
};

std::optional<PrefixableUnit> prefixable(std::string_view unit) {
  const std::size_t end = std::min(unit.find_first_of(" /^"), unit.size());
  const std::string_view rest = unit.substr(end);
  if (rest.starts_with('^')) return std::nullopt;
  const std::string_view first = unit.substr(0, end);
  for (const std::string_view symbol : symbols) {
    for (const Prefix& prefix : prefixes) {
      if (first.size() == prefix.text.size() + symbol.size() && first.starts_with(prefix.text) &&
          first.ends_with(symbol))
        return PrefixableUnit{prefix.power, std::string(symbol), std::string(rest)};
    }
  }
  return std::nullopt;
}

/// A title without its unit, and the unit: "controller.ki (N m/(rad s))".
struct TitleParts {
  std::string text;
  std::string unit{};
};

TitleParts parts_of_title(const std::string& title) {
  if (!title.ends_with(')')) return {title};
  int depth = 0;
  for (std::size_t i = title.size(); i-- > 0;) {
    if (title[i] == ')') ++depth;
    if (title[i] != '(' || --depth > 0) continue;
    if (i == 0 || title[i - 1] != ' ') return {title};
    return {title.substr(0, i - 1), title.substr(i + 1, title.size() - i - 2)};
  }
  return {title};
}

int power_of_thousand(double value) {
  return 3 * static_cast<int>(std::floor(std::log10(value) / 3.0 + 1e-9));
}

std::string superscript(int power) {
  constexpr std::array<std::string_view, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = power < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(power)))
    text += digits[static_cast<std::size_t>(digit - '0')];
  return text;
}

/// The power of ten by which numbers of an axis are divided so that four figures show them; nothing if they
/// range over too many decades. @param exact whether numbers need not be divided up to four digits
std::optional<int> power_for(double least, double largest, bool logarithmic, bool whole) {
  if (whole && largest < 1e4 && largest >= 0.01 && (!logarithmic || least >= 1e-3)) return 0;
  if (!logarithmic) return power_of_thousand(largest);
  int power = power_of_thousand(std::sqrt(least) * std::sqrt(largest));
  if (largest * std::pow(10.0, -power) >= 1e4) power = power_of_thousand(largest);
  if (least * std::pow(10.0, -power) < 1e-3 * (1.0 - 1e-9)) return std::nullopt;
  return power;
}

/// Labels of ticks whose values are divided by 10^power, where four figures state them exactly.
std::string label_expression(int power, std::string_view suffix) {
  const std::string value = power == 0 ? "datum.value" : fmt::format("datum.value * 1e{}", -power);
  return fmt::format(
      "format(abs({0}), '.{1}~r') === format(abs({0}), '.{2}~r') ? format({0}, '.{1}~r'){3} : ''", value,
      figures_of_label, 2 * figures_of_label, suffix.empty() ? "" : fmt::format(" + '{}'", suffix));
}

/// Labels each with its own prefix; on an axis whose labels have the unit.
std::string prefixed_expression(std::string_view symbol) {
  if (symbol.empty()) return fmt::format("format(datum.value, '.{}~s')", figures_of_label);
  return fmt::format("replace(format(datum.value, '.{}~s'), regexp('([a-zA-Zµ]?)$'), ' $1{}')",
                     figures_of_label, symbol);
}

std::string_view prefix_of(int power) {
  return std::ranges::find(prefixes, power, &Prefix::power)->text;
}

/// Thousands of seconds are not counted in kiloseconds.
int power_within_prefixes(int power, const PrefixableUnit& unit) {
  return std::clamp(power, prefixes.front().power, unit.symbol == "s" ? 0 : prefixes.back().power);
}

std::string scaled_title(const TitleParts& title, int power, const std::optional<PrefixableUnit>& unit) {
  if (power == 0 && !unit)
    return title.unit.empty() ? title.text : fmt::format("{} ({})", title.text, title.unit);
  if (!unit)
    return fmt::format("{} (10{}{}{})", title.text, superscript(power), title.unit.empty() ? "" : " ",
                       title.unit);
  return fmt::format("{} ({}{}{})", title.text, prefix_of(power), unit->symbol, unit->rest);
}

/// Widens a range of which fewer than two numbers of four figures may lie in it.
void widen(NumberAxis& axis, ordered_json& channel, double largest) {
  const double span = axis.high - axis.low;
  const ordered_json* zero = inner_of(channel, "scale", "zero");
  const bool without_zero = zero != nullptr && *zero == false;
  if (axis.has_domain || span >= narrowest * largest || (span == 0.0 && !without_zero)) return;
  const double middle = 0.5 * (axis.low + axis.high);
  const double half = 0.5 * narrowest * largest;
  channel["scale"]["domain"] = {middle - half, middle + half};
}

void label_ticks(NumberAxis& axis) {
  const auto titled = std::ranges::find_if(
      axis.channels, [](const ordered_json* one) { return !text_at(*one, "title").empty(); });
  if (titled == axis.channels.end() || axis.low > axis.high) return;
  ordered_json& channel = **titled;
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  if (largest == 0.0) return;
  std::string type = "linear";
  double constant = 0.0;
  bool has_values = false;
  bool percent = false;
  for (ordered_json* one : axis.channels) {
    if (const ordered_json* found = inner_of(*one, "scale", "type")) type = found->get<std::string>();
    if (const ordered_json* found = inner_of(*one, "scale", "constant")) constant = found->get<double>();
    if (const ordered_json* values = inner_of(*one, "axis", "values")) {
      has_values = true;
      (*one)["axis"]["tickCount"] = values->size();  // fewer would leave out every other one
    }
    if (const ordered_json* found = inner_of(*one, "axis", "format")) {
      percent = percent || found->get<std::string>().ends_with('p');
      (*one)["axis"].erase("format");
    }
  }
  if (type == "linear") widen(axis, channel, largest);
  ordered_json& style = channel["axis"];
  if (percent) {
    style["labelExpr"] = label_expression(-2, " %");
    return;
  }
  const bool logarithmic = type != "linear";
  const double least = type == "symlog" ? std::min(constant, largest) : axis.least;
  const TitleParts title = parts_of_title(text_at(channel, "title"));
  const std::optional<PrefixableUnit> unit = prefixable(title.unit);
  const double own = unit ? std::pow(10.0, unit->power) : 1.0;
  std::optional<int> power = power_for(own * least, own * largest, logarithmic, !unit);
  if (!power) {
    const bool simple = unit && unit->rest.empty() && unit->power == 0;
    style["labelExpr"] = prefixed_expression(simple ? unit->symbol : "");
    if (simple) channel["title"] = title.text;
    return;
  }
  if (unit) *power = power_within_prefixes(*power, *unit);
  channel["title"] = scaled_title(title, *power, unit);
  std::string expression = label_expression(*power - (unit ? unit->power : 0), "");
  if (type == "log" && !has_values && axis.high >= 2.5 * axis.low) {
    const char* const digits = axis.high >= 10.0 * axis.low ? "125" : "123457";
    expression = fmt::format("indexof('{}', substring(format(datum.value, 'e'), 0, 1)) < 0 ? '' : {}", digits,
                             expression);
  }
  style["labelExpr"] = expression;
}

}  // namespace

ordered_json with_tick_labels(const Figure& figure) {
  ordered_json specification = figure.specification;
  const auto label_view = [&](ordered_json& view) {
    for (const char* name : {"x", "y"}) {
      for (const bool right : {false, true}) {
        NumberAxis axis = axis_of(figure, view, name, right);
        label_ticks(axis);
      }
    }
  };
  if (specification.contains("vconcat")) {
    for (ordered_json& view : specification["vconcat"]) label_view(view);
  } else {
    label_view(specification);
  }
  return specification;
}

}  // namespace zerocount::report
