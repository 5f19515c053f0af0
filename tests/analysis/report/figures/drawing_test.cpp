// What figures.js makes of a specification: the labels of axes, and that it needs nothing of the page.
#include <regex>

#include <nlohmann/json.hpp>

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "tests/results/failures.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

/// A random horizontal axis of a figure whose range is that of its data.
struct RandomAxis {
  std::string scale;
  std::string unit;
  double low{0.0}, high{0.0};
};

/// A random axis: its range lies about zero or far from it, is wide or narrow, and has a unit with or without
/// SI prefix.
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

/// Output of the page's drawing program for a figure when Node.js runs it.
/// @param form argument `form` of drawing_program()
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
  EXPECT_EQ(whole["layer"][0]["mark"]["stroke"], colours_of("light")["--paper"]);
  EXPECT_EQ(whole["datasets"]["points"][0]["label"], "var(--a label)");
  EXPECT_EQ(whole["datasets"]["points"][0]["rate"], 0.5);
  nlohmann::ordered_json drawing = whole;
  drawing.erase("datasets");
  EXPECT_FALSE(says(drawing.dump(), "var(--"));
  EXPECT_FALSE(says(drawing.dump(), "container"));
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
  figure.specification["data"] = {{"name", "all"}};
  figure.specification["usermeta"]["panels"] = {{"field", "$panels"}, {"titles", "$titles"}};
  EXPECT_FALSE(drawn().contains("vconcat"));  // without the parameter
  figure.parameters = {{"panels", "kind"}, {"titles", {{"it's", "first"}}}};
  const ordered_json panels = drawn()["vconcat"];
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_EQ(panels[0]["title"], "first");
  EXPECT_EQ(panels[1]["title"], "b");
  EXPECT_EQ(panels[0]["layer"][0]["transform"][0]["filter"]["equal"], "it's");
}

/// Each condition has its own colour in all figures, also in one that does not show them all; there is a row
/// for each name.
TEST(DrawnFigure, HasColoursAndRowsByItsData) {
  using nlohmann::ordered_json;
  Figure figure =
      figure_of("success", "success", "", "",
                {{"points",
                  {{"label", "point", ""}, {"rate", "rate", "1"}, {"low", "", "1"}, {"condition", "", ""}},
                  {}}});
  for (const char* const label : {"a", "b", "b"})
    figure.data.front().rows.push_back(ordered_json::array({label, 0.97, 0.93, "warm"}));
  figure.parameters["conditions"] = {"cold", "warm"};
  const ordered_json whole = ordered_json::parse(drawn_by_node(figure, "specification"));
  EXPECT_EQ(whole["encoding"]["color"]["scale"]["domain"], ordered_json({"cold", "warm"}));
  EXPECT_TRUE(whole["height"] == 48 && whole["layer"].size() == 2U) << whole;  // nothing is asked for
  EXPECT_EQ(whole["layer"][0]["encoding"]["x"]["scale"]["domain"], ordered_json({0.92, 1}));
}

TEST(Datum, KeepsTheRequestedDigits) {
  EXPECT_EQ(datum(0.123456789).dump(), "0.123457");
  EXPECT_EQ(datum(0.123456789, 3).dump(), "0.123");
  EXPECT_EQ(datum(3.0).dump(), "3");
  EXPECT_EQ(datum(-2.0e-5).dump(), "-2e-05");
  EXPECT_TRUE(datum(std::nan("")).is_null());
  EXPECT_TRUE(datum(std::numeric_limits<double>::infinity()).is_null());
}

TEST(SpacedByRatio, DistinguishesLogarithmicFromLinearSpacing) {
  EXPECT_TRUE(spaced_by_ratio({1e-5, 1e-4, 1e-3}));
  EXPECT_TRUE(spaced_by_ratio({2.0e-5, 2.44211e-5, 2.98195e-5, 3.64113e-5}));
  EXPECT_FALSE(spaced_by_ratio({1.0, 2.0, 3.0, 4.0}));
  EXPECT_FALSE(spaced_by_ratio({0.0, 1.0, 10.0}));
  EXPECT_FALSE(spaced_by_ratio({1.0, 10.0}));
}

TEST(Specifications, AreVegaLiteWithNamedData) {
  int specifications = 0;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.ends_with(".vl.json")) continue;
    ++specifications;
    const auto json = nlohmann::ordered_json::parse(file.bytes);
    EXPECT_EQ(json["$schema"], "https://vega.github.io/schema/vega-lite/v6.json") << file.name;
    EXPECT_FALSE(says(std::string(file.bytes), "\"url\"")) << file.name;
    EXPECT_TRUE(says(std::string(file.bytes), "\"tooltip\"")) << file.name;
  }
  EXPECT_GE(specifications, 13);
}

/// Both sets of colours have every colour that a figure names.
TEST(Specifications, NameOnlyColoursThatExist) {
  const auto colours = nlohmann::ordered_json::parse(embedded_file("colours.json"));
  const std::regex name("var\\((--[a-z0-9-]+)\\)");
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.ends_with(".json") && !file.name.ends_with(".css")) continue;
    const std::string text(file.bytes);
    for (auto match = std::sregex_iterator(text.begin(), text.end(), name); match != std::sregex_iterator();
         ++match) {
      EXPECT_TRUE(colours["light"].contains((*match)[1].str())) << file.name << ": " << (*match)[1];
      EXPECT_TRUE(colours["dark"].contains((*match)[1].str())) << file.name << ": " << (*match)[1];
    }
  }
}

TEST(EmbeddedFiles, AMissingFileIsReportedWithItsRemedy) {
  testing::expect_failure(ExitCode::machine_failed, "npm ci", [] { embedded_file("vega.max.js"); });
}

/// Made-up samples of a move: counts that mostly rest, with jerks of one sample here and there.
std::vector<trial::SampleRecord> random_samples(std::uint64_t seed, std::int64_t size) {
  std::mt19937_64 random(seed);
  std::vector<trial::SampleRecord> samples;
  std::int64_t count = 0;
  for (std::int64_t k = 0; k < size; ++k) {
    if (random() % 50 == 0) count += static_cast<std::int64_t>(random() % 7) - 3;
    trial::SampleRecord sample;
    sample.k = k;
    sample.t = static_cast<double>(k) / 2000.0;
    sample.count = count + (random() % 100 == 0 ? 1 : 0);
    sample.error = 10 - sample.count;
    sample.target = 10;
    sample.torque = 1e-4 * static_cast<double>(sample.error);
    samples.push_back(sample);
  }
  return samples;
}

std::vector<trial::SampleRecord> thinned(const std::vector<trial::SampleRecord>& samples,
                                         std::int64_t buckets) {
  TraceThinner thinner(std::ssize(samples), buckets);
  for (const trial::SampleRecord& sample : samples) thinner.add(sample);
  return thinner.finish();
}

/// The value of the step line through `samples` at sample k.
std::int64_t at(const std::vector<trial::SampleRecord>& samples, std::int64_t k) {
  const auto after =
      std::upper_bound(samples.begin(), samples.end(), k,
                       [](std::int64_t at, const trial::SampleRecord& sample) { return at < sample.k; });
  return (after - 1)->error;
}

TEST(TraceThinner, KeepsTheWholeStepLineIfThereIsRoom) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<trial::SampleRecord> samples = random_samples(seed, 500);
    const std::vector<trial::SampleRecord> kept = thinned(samples, 500);
    EXPECT_LT(kept.size(), samples.size());
    for (const trial::SampleRecord& sample : samples)
      ASSERT_EQ(at(kept, sample.k), sample.error) << seed << " " << sample.k;
  }
}

TEST(TraceThinner, KeepsTheExtremesOfEveryStretch) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<trial::SampleRecord> samples = random_samples(seed, 10000);
    const std::vector<trial::SampleRecord> kept = thinned(samples, 100);
    EXPECT_LE(kept.size(), 600U);
    EXPECT_EQ(kept.front().k, 0);
    EXPECT_EQ(kept.back().k, 9999);
    for (std::int64_t stretch = 0; stretch < 100; ++stretch) {
      const auto begin = samples.begin() + stretch * 100;
      const auto by_error = [](const trial::SampleRecord& a, const trial::SampleRecord& b) {
        return a.error < b.error;
      };
      const auto [least, most] = std::minmax_element(begin, begin + 100, by_error);
      std::int64_t low = at(kept, stretch * 100);
      std::int64_t high = low;
      for (const trial::SampleRecord& sample : kept) {
        if (sample.k / 100 != stretch) continue;
        low = std::min(low, sample.error);
        high = std::max(high, sample.error);
      }
      ASSERT_EQ(low, least->error) << seed;
      ASSERT_EQ(high, most->error) << seed;
    }
  }
}

TEST(TraceThinner, AConstantTraceKeepsOnlyItsEnds) {
  std::vector<trial::SampleRecord> samples(1000);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].k = static_cast<std::int64_t>(k);
  EXPECT_EQ(thinned(samples, 50).size(), 2U);
  EXPECT_TRUE(thinned({}, 50).empty());
}

}  // namespace
}  // namespace zerocount::report
