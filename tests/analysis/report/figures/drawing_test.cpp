// What figures.js makes of a specification: the labels of axes, and that it needs nothing of the page.
#include <regex>

#include <nlohmann/json.hpp>

#include "analysis/report/figures/figure.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

/// A horizontal axis whose range is that of its data.
struct RandomAxis {
  std::string scale;
  std::string unit;
  double low{0.0}, high{0.0};
};

/// Ranges about zero and far from it, wide and narrow, of units with and without SI prefixes.
RandomAxis random_axis(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  constexpr std::array scales{"linear", "linear", "linear", "log", "symlog"};
  constexpr std::array units{"m", "s", "N m/count", "counts", "µrad", "kg", "N^2/m", "", "%"};
  RandomAxis axis{scales[random() % scales.size()], units[random() % units.size()]};
  const double size = std::pow(10.0, uniform(-11.0, 8.0));
  if (axis.unit == "%") axis.scale = "linear";
  if (axis.scale == "log") {
    axis.low = size;
    axis.high = size * std::pow(10.0, uniform(0.3, 9.0));
  } else if (axis.scale == "symlog" || random() % 2 == 0) {
    axis.low = -size * uniform(0.0, 1.0);
    axis.high = size;
  } else {
    axis.high = axis.unit == "%" ? uniform(0.0, 1.0) : (random() % 2 == 0 ? size : -size);
    axis.low = axis.high - std::abs(axis.high) * std::pow(10.0, uniform(-6.0, 0.0));
  }
  return axis;
}

nlohmann::ordered_json panel_of(const RandomAxis& axis, const std::string& data, int width) {
  nlohmann::ordered_json x{
      {"field", "x"},
      {"type", "quantitative"},
      {"title", axis.unit.empty() || axis.unit == "%" ? "value" : fmt::format("value ({})", axis.unit)},
      {"scale", {{"type", axis.scale}, {"nice", false}}}};
  if (axis.scale == "linear") x["scale"]["zero"] = false;
  if (axis.scale == "symlog") {
    x["scale"]["constant"] = axis.high / 1000.0;
  }
  if (axis.unit == "%") x["axis"]["format"] = "~p";
  return {{"width", width},
          {"height", 20},
          {"data", {{"name", data}}},
          {"mark", "point"},
          {"encoding", {{"x", x}}}};
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What the program of a figure writes. @param form of drawing_program
std::string drawn_by_node(const Figure& figure, const char* form) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "draw.js") << drawing_program(figure, form);
  const std::string command = fmt::format("'{}' '{}' > '{}'", ZEROCOUNT_NODE, (folder / "draw.js").string(),
                                          (folder / "drawn").string());
  EXPECT_EQ(std::system(command.c_str()), 0);
  return text_of(folder / "drawn");
}

/// The title and the visible labels of an axis in a picture.
struct DrawnAxis {
  std::string title;
  std::vector<std::string> labels{};
};

std::vector<DrawnAxis> drawn_axes(const std::string& svg) {
  std::vector<DrawnAxis> axes;
  const std::regex text("<text([^>]*)>([^<]*)</text>");
  const std::string start = "role-axis\"";
  for (std::size_t at = svg.find(start); at != std::string::npos;) {
    const std::size_t next = svg.find(start, at + 1);
    const std::string part = svg.substr(at, next == std::string::npos ? next : next - at);
    const std::size_t title = part.find("role-axis-title");
    DrawnAxis& axis = axes.emplace_back();
    for (auto found = std::sregex_iterator(part.begin(), part.end(), text); found != std::sregex_iterator();
         ++found) {
      if (title != std::string::npos && static_cast<std::size_t>(found->position()) > title) {
        axis.title = (*found)[2];
        break;
      }
      if (found->str(1).find("opacity=\"0\"") == std::string::npos && found->length(2) > 0)
        axis.labels.push_back((*found)[2]);
    }
    at = next;
  }
  return axes;
}

/// The number that a label states in the unit of the data: "−2.5" on an axis "value (mm)", "10 nm", "20k".
double number_of(const std::string& label, const DrawnAxis& drawn, const RandomAxis& axis) {
  static const std::map<std::string, int> powers{{"f", -15}, {"p", -12}, {"n", -9}, {"µ", -6}, {"m", -3},
                                                 {"", 0},    {"k", 3},   {"M", 6},  {"G", 9},  {"T", 12}};
  std::smatch parts;
  const std::regex form("(−|)([0-9.]+)(f|p|n|µ|m|k|M|G|T|)( (?:[a-zA-Z%]|µ)+|)");
  if (!std::regex_match(label, parts, form)) return std::nan("");
  double number = std::stod(parts[2]) * (parts[1].length() > 0 ? -1.0 : 1.0);
  if (axis.unit == "%") return number / 100.0;
  const std::string unit = parts[4].length() > 0 ? parts[4].str().substr(1) : "";
  const auto power_in = [&](const std::string& whole, const std::string& base) {
    return powers.at(whole.substr(0, whole.size() - base.size()));
  };
  const std::string symbol = axis.unit == "µrad" ? "rad" : axis.unit == "kg" ? "g" : axis.unit;
  const int own = axis.unit == "µrad" ? -6 : axis.unit == "kg" ? 3 : 0;
  number *= std::pow(10.0, powers.at(parts[3]));
  if (!unit.empty()) return number * std::pow(10.0, power_in(unit, symbol) - own);
  const std::size_t open = drawn.title.find('(');
  if (open == std::string::npos) return number;
  std::string titled = drawn.title.substr(open + 1, drawn.title.size() - open - 2);
  if (!titled.starts_with("10")) return number * std::pow(10.0, power_in(titled, symbol) - own);
  int power = 0;
  const std::vector<std::string> superscripts{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::size_t at = 2;
  const bool negative = titled.compare(at, 3, "⁻") == 0;
  if (negative) at += 3;
  while (at < titled.size() && titled[at] != ' ') {
    for (std::size_t digit = 0; digit < 10; ++digit) {
      if (titled.compare(at, superscripts[digit].size(), superscripts[digit]) != 0) continue;
      power = 10 * power + static_cast<int>(digit);
      at += superscripts[digit].size();
      break;
    }
  }
  return number * std::pow(10.0, negative ? -power : power);
}

std::size_t figures_in(const std::string& label) {
  std::string digits;
  for (const char letter : label)
    if (letter >= '0' && letter <= '9') digits += letter;
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  if (label.find('.') == std::string::npos) {
    while (digits.ends_with('0')) digits.pop_back();
  }
  return digits.size();
}

/// Labels of any axis differ, have at most four figures, and state numbers in the range of the data.
TEST(TickLabels, DifferAndHaveAtMostFourFigures) {
  constexpr int axes = 240;
  std::mt19937_64 random(63);
  std::vector<RandomAxis> wanted;
  Figure figure{"axes", "", "", {{"vconcat", nlohmann::ordered_json::array()}}, {}};
  for (int i = 0; i < axes; ++i) {
    const RandomAxis& axis = wanted.emplace_back(random_axis(random));
    const std::string name = fmt::format("data{}", i);
    figure.specification["vconcat"].push_back(panel_of(axis, name, i % 2 == 0 ? 260 : 800));
    figure.data.push_back({name, {{"x", "value", axis.unit}}, {{axis.low}, {axis.high}}});
  }
  std::vector<DrawnAxis> drawn = drawn_axes(drawn_by_node(figure, "svg"));
  std::erase_if(drawn, [](const DrawnAxis& axis) { return axis.labels.empty() && axis.title.empty(); });
  ASSERT_EQ(drawn.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const RandomAxis& axis = wanted[i];
    const std::string what = fmt::format("{} {} from {} to {}: '{}' {}", axis.scale, axis.unit, axis.low,
                                         axis.high, drawn[i].title, fmt::join(drawn[i].labels, " | "));
    const std::vector<std::string>& labels = drawn[i].labels;
    EXPECT_EQ(std::set<std::string>(labels.begin(), labels.end()).size(), labels.size()) << what;
    EXPECT_GE(labels.size(), axis.scale == "linear" ? 2U : 1U) << what;
    const double room = 0.003 * std::max(std::abs(axis.low), std::abs(axis.high));
    for (const std::string& label : labels) {
      EXPECT_LE(figures_in(label), 4U) << what;
      const double number = number_of(label, drawn[i], axis);
      EXPECT_TRUE(number >= axis.low - room && number <= axis.high + room) << label << " in " << what;
    }
  }
}

TEST(DrawnFigure, NeedsNeitherDataNorThemeNorColoursOfThePage) {
  const Figure figure = figure_of("success", "success", "Success", "",
                                  {{"points",
                                    {{"label", "point", ""}, {"rate", "rate", "1"}},
                                    {nlohmann::ordered_json::array({"var(--a label)", 0.5})}}});
  const nlohmann::ordered_json whole = nlohmann::ordered_json::parse(drawn_by_node(figure, "specification"));
  EXPECT_EQ(whole["width"], 560);
  EXPECT_EQ(whole["config"]["background"], "white");
  EXPECT_EQ(whole["config"]["line"]["color"], colours_of("light")["--s1"]);
  EXPECT_EQ(whole["layer"][1]["mark"]["color"], colours_of("light")["--ink"]);
  EXPECT_EQ(whole["datasets"]["points"][0]["label"], "var(--a label)");
  EXPECT_EQ(whole["datasets"]["points"][0]["rate"], 0.5);
  nlohmann::ordered_json drawing = whole;
  drawing.erase("datasets");
  EXPECT_EQ(drawing.dump().find("var(--"), std::string::npos);
  EXPECT_EQ(drawing.dump().find("container"), std::string::npos);
}

/// Titles come from the columns, one panel is drawn for each value, and layers without rows are left out.
TEST(DrawnFigure, HasTitlesPanelsAndLayersByItsData) {
  using nlohmann::ordered_json;
  const auto layer = [](const char* data, const char* title) {
    return ordered_json{{"data", {{"name", data}}},
                        {"mark", "point"},
                        {"encoding",
                         {{"x", {{"field", "time"}, {"type", "quantitative"}, {"title", title}}},
                          {"tooltip", {{{"field", "time"}}, {{"field", "kind"}, {"title", "own"}}}}}}};
  };
  const std::vector<FigureColumn> columns{{"time", "arrived by", "s"}, {"kind", "kind of it", ""}};
  Figure figure{"f",
                "",
                "",
                {{"width", "container"}, {"layer", {layer("all", "@time"), layer("none", "words (@time)")}}},
                {{"all", columns, {{1.5, "it's"}, {2.5, "b"}}}, {"none", columns, {}}}};
  const auto drawn = [&] { return ordered_json::parse(drawn_by_node(figure, "specification")); };
  const ordered_json whole = drawn();
  ASSERT_EQ(whole["layer"].size(), 1U);
  EXPECT_EQ(whole["layer"][0]["encoding"]["x"]["title"], "arrived by (s)");
  EXPECT_EQ(whole["layer"][0]["encoding"]["tooltip"][0]["title"], "arrived by (s)");
  EXPECT_EQ(whole["layer"][0]["encoding"]["tooltip"][1]["title"], "own");
  divide_into_panels(figure, "kind", {{"it's", "first"}, {"b", "second"}});
  const ordered_json panels = drawn()["vconcat"];
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_EQ(panels[0]["title"], "first");
  EXPECT_EQ(panels[0]["layer"][0]["transform"][0]["filter"]["equal"], "it's");
}

}  // namespace
}  // namespace zerocount::report
