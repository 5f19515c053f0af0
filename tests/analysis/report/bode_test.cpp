// The Bode plot marks the margins.
#include <nlohmann/json.hpp>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/report.hpp"
#include "core/theory/margins.hpp"
#include "tests/analysis/report/run_studies.hpp"
#include "tests/core/theory/frozen_loops.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

/// The smallest angle between two phases, degrees.
double between(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

constexpr const char* fixed_study =
    "zerocount: 1\nname: bode\nseed: 3\ntrials: 2\ncommand: {targets: [3], hold: 0.1}\n"
    "verdict: {dwell: 0.02, window: 0.02}\nfriction: {k1: 97, k2: 640}\n";

/// The report page of the fixed study of these tests, with the further manifest lines `more`.
ReportPage bode_page(const std::string& more) {
  const testing::TemporaryFolder folder;
  testing::run_study_file(folder / "a.h5", fixed_study + more);
  return study_report(reading::AllTrialsFile(folder / "a.h5")).page;
}

bool has_bode(const ReportPage& page) {
  const std::vector<std::string> names = figure_names(page);
  return std::count(names.begin(), names.end(), "bode") == 1;
}

const FigureData& data_named(const Figure& figure, const std::string& name) {
  return *std::find_if(figure.data.begin(), figure.data.end(),
                       [&](const FigureData& data) { return data.name == name; });
}

std::map<std::string, nlohmann::ordered_json> fields(const FigureData& data,
                                                     const nlohmann::ordered_json& row) {
  std::map<std::string, nlohmann::ordered_json> values;
  for (std::size_t i = 0; i < data.columns.size(); ++i) values[data.columns[i].field] = row[i];
  return values;
}

// The marks of each loop against margins_about, which check prints too, of the parameters of the manifest.
TEST(BodeFigure, MarksTheMargins) {
  const ReportPage page = bode_page("controller: {kp: 3.0e-4, ki: 2.0e-5, delay: 1}\n");
  const Figure& figure = find_figure(page, "bode");
  const FigureData& marks = data_named(figure, "margins");
  loop::ControllerParameters controller;
  controller.kp = 3e-4;
  controller.ki = 2e-5;
  controller.delay = 1;
  const motion::PlantParameters plant;
  const std::map<std::string, theory::StabilityMargins> expected{
      {"at k1:", theory::margins_about(97.0, plant.presliding_damping, plant, {}, controller)},
      {"at k1 + k2:", theory::margins_about(737.0, plant.presliding_damping, plant, {}, controller)},
      {"while sliding:", theory::margins_about(0.0, plant.sliding_damping, plant, {}, controller)}};
  std::size_t marked = 0;
  for (const auto& [name, margins] : expected)
    marked += !std::isnan(margins.gain.value) + !std::isnan(margins.phase.value);
  EXPECT_EQ(marks.rows.size(), marked);
  EXPECT_GE(marked, 4U);
  for (const auto& row : marks.rows) {
    auto mark = fields(marks, row);
    const auto label = mark["label"].get<std::string>();
    const theory::StabilityMargins& margins = expected.at(label.substr(0, label.find(':') + 1));
    const bool gain = mark["margin"] == "gain margin";
    const theory::Margin& margin = gain ? margins.gain : margins.phase;
    EXPECT_NEAR(mark["frequency"].get<double>(), margin.frequency, 1e-6 * margin.frequency) << label;
    const double expected_magnitude = gain ? -20.0 * std::log10(margin.value) : 0.0;
    const double expected_phase = -180.0 + (gain ? 0.0 : margin.value);
    EXPECT_NEAR(mark["magnitude"].get<double>(), expected_magnitude, 1e-4) << label;
    EXPECT_LT(between(mark["phase"].get<double>(), expected_phase), 1e-3) << label;
    EXPECT_LT(between(mark["reversal"].get<double>(), -180.0), 1e-3) << label;
    const FigureData& curves = data_named(figure, "curves");
    EXPECT_TRUE(std::any_of(curves.rows.begin(), curves.rows.end(), [&](const auto& point) {
      auto at = fields(curves, point);
      return at["label"] == label && at["frequency"] == mark["frequency"] && at["phase"] == mark["phase"];
    })) << label;
  }
}

TEST(BodeFigure, ShowsTheSelectedPoint) {
  const testing::TemporaryFolder folder;
  testing::run_study_file(folder / "a.h5",
                          std::string(fixed_study) + "sweep: {grid: {controller.ki: [1.0e-5, 2.0e-5]}}\n");
  for (const std::int64_t point : {0, 1}) {
    ReportOptions options;
    options.point = point;
    const ReportPage page = study_report(reading::AllTrialsFile(folder / "a.h5"), options).page;
    loop::ControllerParameters controller;
    controller.ki = point == 0 ? 1e-5 : 2e-5;
    const FigureData& marks = data_named(find_figure(page, "bode"), "margins");
    EXPECT_NEAR(fields(marks, marks.rows.front())["magnitude"].get<double>(),
                -20.0 * std::log10(theory::margins_about(97.0, 0.2, {}, {}, controller).gain.value), 1e-4);
  }
}

TEST(BodeFigure, IsAbsentForALoopWithoutGain) {
  EXPECT_TRUE(has_bode(bode_page("")));
  EXPECT_TRUE(has_bode(bode_page("controller: {ki: 0, kp: 1.0e-4}\n")));
  EXPECT_FALSE(has_bode(bode_page("controller: {ki: 0}\n")));
}

const std::string hostile = "</script><script>alert('x')</script><!-- & \"quoted\" \xff\x01";

TEST(Escaping, TextHoldsNoMarkup) {
  const std::string text = document::markup(hostile);
  EXPECT_EQ(text.find_first_of("<>\"'"), std::string::npos) << text;
  EXPECT_EQ(document::markup("a < b & c"), "a &lt; b &amp; c");
  EXPECT_EQ(document::markup("µrad\n\tnext"), "µrad\n\tnext");
}

TEST(Escaping, InvalidBytesAreReplaced) {
  EXPECT_EQ(document::markup("a\xff"), "a\xEF\xBF\xBD");
  EXPECT_EQ(document::markup(std::string("a\0b", 3)),
            "a\xEF\xBF\xBD"
            "b");
}

TEST(Escaping, NoLineBreaksBeforeAPercentSign) {
  EXPECT_EQ(document::prose_markup("95 % of < 3"), "95&nbsp;% of &lt; 3");
}

TEST(Escaping, JsonCannotEndItsScriptAndReadsBack) {
  const std::string valid = hostile.substr(0, hostile.size() - 2);
  const nlohmann::ordered_json json{{"text", valid}, {"nan", std::nan("")}};
  const std::string text = script_json(json);
  EXPECT_EQ(text.find('<'), std::string::npos);
  const auto read = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(read["text"], valid);
  EXPECT_TRUE(read["nan"].is_null());
  EXPECT_NO_THROW(script_json({{"text", hostile}}));
}

TEST(Escaping, ScriptsDoNotEndThemselves) {
  const std::string source = script_source("a = '</script>' + '<!--';");
  EXPECT_EQ(source, "a = '<\\/script>' + '<\\!--';");
}

}  // namespace
}  // namespace zerocount::report
