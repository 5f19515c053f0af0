#include "analysis/trials/summary/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/trials/measures/point_accumulator.hpp"
#include "analysis/trials/measures/point_columns.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/summary_forms.hpp"

namespace zerocount::summary {
namespace {

using testing::summary_csv;
using testing::summary_json;
using testing::summary_text;

/// Statistics of a design point with `zero` trials that succeed at random times and have jerks, and `lost`
/// trials that never arrive.
measures::PointSummary point_of(int zero, int lost) {
  std::mt19937_64 random(51);
  measures::PointAccumulator point;
  for (int i = 0; i < zero; ++i) {
    trial::MoveOutcome move;
    move.outcome = trial::Outcome::zero_count;
    move.arrived = move.stable = true;
    move.arrival_time = static_cast<double>(random() % 400) / 2000.0;
    move.holding_torque = 0.013 + 1e-5 * static_cast<double>(random() % 1000);
    move.jerk_count = 2;
    const double onset = static_cast<double>(random() % 1000) / 2000.0;
    point.add({{move}}, std::vector<trial::Jerk>{{0, onset, 0.001, 1, 1}, {0, onset + 0.1, 0.001, 1, -1}});
  }
  for (int i = 0; i < lost; ++i) {
    trial::MoveOutcome move;
    move.outcome = trial::Outcome::oscillating;
    point.add({{move}}, {});
  }
  return point.statistics();
}

StudySummary two_cases() {
  StudySummary summary;
  summary.name = "paper-gains";
  summary.labels = {"low gain", "high, gain"};
  summary.axes.push_back({"case", "", "case of the sweep", study::SweepAxis::Kind::text, {}, {"a", "b"}});
  summary.axes.push_back({"controller.ki",
                          "N m/count",
                          "integral gain",
                          study::SweepAxis::Kind::number,
                          {3.85e-5, std::nan("")},
                          {}});
  summary.observed = {{"low gain", "stable in all tests"}};
  summary.points = {point_of(40, 0), point_of(0, 7)};
  summary.predictions = {{40, 40, 0}, {7, 1, 2}};
  return summary;
}

bool same_double(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The lines of the table of design points in a summary: its head, a rule, and the rows.
std::vector<std::string> table_in(const std::string& text) {
  std::vector<std::string> lines = lines_of(text);
  const auto head =
      std::ranges::find_if(lines, [](const std::string& line) { return line.starts_with("point"); });
  return {head, lines.end()};
}

TEST(SummaryJson, HasTheDocumentedKeys) {
  const nlohmann::ordered_json json = summary_json(two_cases());
  EXPECT_EQ(json["name"], "paper-gains");
  ASSERT_EQ(json["points"].size(), 2U);
  const auto& point = json["points"][0];
  EXPECT_TRUE(point["trials"].is_number_integer());
  EXPECT_TRUE(point["success_rate"].is_number_float());
  EXPECT_EQ(point["label"], "low gain");
  EXPECT_EQ(point["axes"]["case"], "a");
  EXPECT_EQ(point["axes"]["controller.ki"], 3.85e-5);
  EXPECT_EQ(point["trials"], 40);
  EXPECT_EQ(point["arrival_time"]["n"], 40);
  EXPECT_EQ(point["jerk_agreement"], 0.5);
  EXPECT_NEAR(point["success_rate_low"].get<double>(), std::pow(0.025, 1.0 / 40.0),
              1e-12);  // Clopper–Pearson
  EXPECT_EQ(point["observed"], "stable in all tests");
  EXPECT_EQ(point["prediction"]["verdict"], "stable");
}

TEST(SummaryJson, CountsPerMoveAreNamedLikeThosePerTrial) {
  const nlohmann::ordered_json json = summary_json(two_cases());
  for (const auto& point : json["points"]) {
    const auto& move = point["moves"][0];
    EXPECT_EQ(move.size(), 10U);
    for (const auto& [name, count] : move.items())
      EXPECT_EQ(count, point[name]) << name;  // trials of one move
  }
}

TEST(SummaryJson, UndefinedNumbersAreNull) {
  const nlohmann::ordered_json json = summary_json(two_cases());
  const auto& lost = json["points"][1];
  EXPECT_EQ(lost["success_rate"], 0.0);
  EXPECT_TRUE(lost["arrival_time"]["median"].is_null());
  EXPECT_TRUE(lost["jerk_agreement"].is_null());
  EXPECT_TRUE(lost["axes"]["controller.ki"].is_null());
  EXPECT_TRUE(lost["observed"].is_null());
  EXPECT_EQ(json["points"][0]["arrival_time"]["p95_high"], nullptr);  // 40 trials are too few
}

TEST(SummaryJson, NumbersReadBackToTheSameDouble) {
  const StudySummary summary = two_cases();
  const nlohmann::ordered_json json = summary_json(summary);
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    for (const measures::StatisticField& field : measures::statistic_fields()) {
      const auto& point = json["points"][i];
      const auto& object = field.band ? point["bands"][static_cast<std::size_t>(*field.band)] : point;
      const auto& place = field.group.empty() ? object : object[std::string(field.group)];
      const auto& written = place[std::string(field.name)];
      const double value = field.value(summary.points[i]);
      if (std::isnan(value)) {
        EXPECT_TRUE(written.is_null()) << text::flat_name(field);
      } else {
        EXPECT_TRUE(same_double(written.get<double>(), value)) << text::flat_name(field);
      }
    }
  }
}

TEST(SummaryJson, TextThatIsNotUtf8DoesNotStopIt) {
  StudySummary summary = two_cases();
  summary.labels[0] = "bad \xFF byte";
  const std::string text = text::json_text(summary_json(summary));
  EXPECT_EQ(nlohmann::json::parse(text)["points"][0]["label"], "bad \uFFFD byte");
}

TEST(SummaryCsv, HasALinePerPointAndReadsBackToTheSameDoubles) {
  const StudySummary summary = two_cases();
  const std::vector<std::string> lines = lines_of(summary_csv(summary));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].rfind("point,label,case,controller.ki,trials,zero_count,", 0), 0U);
  EXPECT_EQ(lines[2].rfind("1,\"high, gain\",b,nan,7,0,0,0,7,0,", 0), 0U);

  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    return cells;
  };
  const std::vector<std::string> names = cells_of(lines[0]), cells = cells_of(lines[1]);
  const auto cell_at = [&](const std::string& name) {
    const auto column = std::ranges::find(names, name);
    return column == names.end() ? "missing" : cells.at(static_cast<std::size_t>(column - names.begin()));
  };
  for (const measures::StatisticField& field : measures::statistic_fields()) {
    const std::string name = text::flat_name(field), cell = cell_at(name);
    const double value = field.value(summary.points[0]);
    if (std::isnan(value)) {
      EXPECT_EQ(cell, "nan") << name;
    } else {
      EXPECT_TRUE(same_double(std::stod(cell), value)) << name << ": " << cell;
    }
  }
  EXPECT_EQ(cell_at("predicted_stable_share"), "1");
  EXPECT_EQ(cell_at("predicted"), "stable");
  EXPECT_EQ(cell_at("observed"), "stable in all tests");
}

TEST(SummaryTable, HasARowPerPointWithItsRateAndBounds) {
  const std::string text = summary_text(two_cases());
  EXPECT_TRUE(text.starts_with("best of 2 points: low gain: at least 91.1 % of axes succeed")) << text;
  EXPECT_NE(text.find("\npaper-gains: 2 points\ndesign: monte_carlo\n\npoint "), std::string::npos) << text;
  const std::vector<std::string> lines = table_in(text);
  ASSERT_GE(lines.size(), 4U);
  for (const char* part : {"low gain *", "40", "100 %", "[91.1, 100.0]", "stable in all tests"}) {
    EXPECT_NE(lines[2].find(part), std::string::npos) << part << " in: " << lines[2];
  }
  for (const char* part : {"high, gain", "7", "0 %", "[0.0, 41.0]", "> hold", "14.3 %", "28.6 %"}) {
    EXPECT_NE(lines[3].find(part), std::string::npos) << part << " in: " << lines[3];
  }
}

TEST(SummaryTable, ShowsATimeBeyondTheHoldAsLongerThanTheHold) {
  StudySummary summary = two_cases();
  summary.points[1].hold = 1.0;
  EXPECT_NE(table_in(summary_text(summary))[3].find("> 1 s"), std::string::npos);
}

TEST(SummaryTable, NamesTheDesignAndItsEffectOnTheBounds) {
  StudySummary summary = two_cases();
  EXPECT_NE(summary_text(summary).find("\ndesign: monte_carlo\n"), std::string::npos);
  EXPECT_EQ(summary_json(summary)["conservative_bounds"], false);
  summary.design = "sobol";
  summary.features.spread_trials = true;
  EXPECT_NE(summary_text(summary).find("\ndesign: sobol: bounds are conservative"), std::string::npos);
  EXPECT_EQ(summary_json(summary)["conservative_bounds"], true);
  EXPECT_EQ(summary_json(summary)["design"], "sobol");
}

TEST(SummaryTable, HasMachineColumnsIfTrialsShareMachines) {
  StudySummary summary = two_cases();
  EXPECT_FALSE(summary_json(summary)["points"][0].contains("machines"));
  summary.features.machines = true;
  summary.points[0].machines.n = 20;
  summary.points[0].machines.without_failure = 0.5;
  const std::string table = summary_text(summary);
  EXPECT_NE(table.find("machines w/o failure"), std::string::npos);
  EXPECT_NE(table.find("50.0 %"), std::string::npos) << table;
  EXPECT_NE(table.find("design: monte_carlo, 20 machines: bounds hold for all machines"), std::string::npos)
      << table;
  const auto machines = summary_json(summary)["points"][0]["machines"];
  EXPECT_EQ(machines["without_failure"], 0.5);
}

TEST(SummaryTable, ShowsTheValuesOfAGridInPlaceOfItsLabels) {
  StudySummary summary = two_cases();
  summary.labels = {"a, controller.kp=0, controller.coarse.kp=1",
                    "a, controller.kp=0.5, controller.coarse.kp=1"};
  summary.axes[0].texts = {"a", "a"};
  summary.axes[1] = {"controller.kp", "N m/count", "", study::SweepAxis::Kind::number, {0, 0.5}, {}};
  summary.axes.push_back(
      {"controller.coarse.kp", "N m/count", "", study::SweepAxis::Kind::number, {1, 1}, {}});
  summary.axes.push_back({"command.targets.0", "count", "", study::SweepAxis::Kind::number, {7, 8}, {}});
  const std::vector<std::string> lines = table_in(summary_text(summary));
  EXPECT_EQ(lines[0].rfind("point  case  kp (N m/count)  targets.0 (count)  zero-count", 0), 0U) << lines[0];
  EXPECT_EQ(lines[3].rfind("1      a                0.5                  8", 0), 0U) << lines[3];
  EXPECT_EQ(point_names(summary)[1], "1 (a kp=0.5 coarse.kp=1)");
}

TEST(SummaryTable, ShowsLabelsIfManyParametersAreSwept) {
  StudySummary summary = two_cases();
  for (const char* name : {"dac.offset", "dac.noise", "dac.bits", "controller.kp"}) {
    summary.axes.push_back({name, "1", "", study::SweepAxis::Kind::number, {0, 1}, {}});
  }
  EXPECT_EQ(table_in(summary_text(summary))[0].rfind("point       zero-count", 0), 0U);
}

TEST(SummaryTable, NamesThePointsThatLostTrials) {
  StudySummary summary = two_cases();
  EXPECT_EQ(summary_text(summary).find("nonfinite"), std::string::npos);
  summary.points[1].outcomes.nonfinite = 3;
  EXPECT_NE(summary_text(summary).find("high, gain: 3 of 7 trials nonfinite"), std::string::npos);
}

/// Statistics of a design point with a hundred trials that end in these ways, so many in jerks, off target or
/// oscillating. The last ones of those that ended within one count are not stable.
measures::PointSummary point_with(int in_jerks, int off_target, int oscillating) {
  measures::PointAccumulator point;
  for (int i = 0; i < 100; ++i) {
    trial::MoveOutcome move;
    move.arrived = move.stable = i >= in_jerks + off_target + oscillating;
    move.outcome = i < oscillating                ? trial::Outcome::oscillating
                   : i < oscillating + off_target ? trial::Outcome::off_target
                   : i % 2 == 0                   ? trial::Outcome::zero_count
                                                  : trial::Outcome::one_count;
    point.add({{move}}, {});
  }
  return point.statistics();
}

// What keeps trials from being stable adds up to those that are not, and none of it is called instability
// that is not.
TEST(SummaryTable, SplitsTrialsThatAreNotStableByTheirReason) {
  StudySummary summary = two_cases();
  const auto row_of = [&](int in_jerks, int off_target, int oscillating) {
    summary.points[0] = summary.points[1] = point_with(in_jerks, off_target, oscillating);
    const std::vector<std::string> lines = table_in(summary_text(summary));
    std::string row;
    for (const char* head : {"stable", "undecided", "in jerks", "oscillates"}) {
      const std::size_t at = lines[0].find(std::string("  ") + head);
      if (at == std::string::npos) continue;
      const std::size_t end = at + 2 + std::string(head).size();
      const std::size_t begin = lines[2].find_last_of(' ', lines[2].find_last_not_of(" %", end - 1));
      const std::string cell = lines[2].substr(begin + 1, end - begin - 1);
      row += fmt::format("{} {} ", head, cell.substr(0, cell.find_last_not_of(' ') + 1));
    }
    return row;
  };
  EXPECT_EQ(row_of(0, 0, 0), "stable 100 % ");
  EXPECT_EQ(row_of(4, 0, 0), "stable 96.0 % in jerks 4.0 % ");
  EXPECT_EQ(row_of(20, 5, 10), "stable 65.0 % undecided 5.0 % in jerks 20.0 % oscillates 10.0 % ");
  EXPECT_EQ(row_of(0, 0, 37), "stable 63.0 % oscillates 37.0 % ");
  const std::string legend = summary_text(summary, {.legend = true});
  EXPECT_NE(legend.find("oscillates: proportion of trials with a move"), std::string::npos) << legend;
}

TEST(SummaryTable, HasColumnsForTheFeaturesOfTheStudy) {
  StudySummary summary = two_cases();
  const std::string plain = summary_text(summary);
  for (const char* head : {"travel", "|e|", "|true e|", "phase changes", "disagreeing"}) {
    EXPECT_EQ(plain.find(head), std::string::npos) << head;
  }
  summary.features = {.encoder_errors = true};
  summary.points[0].of(&trial::MoveOutcome::true_error).mean = 0.3;
  const std::string without_coarse = summary_text(summary, {.legend = true});
  EXPECT_NE(without_coarse.find("|true e| mean"), std::string::npos);
  EXPECT_EQ(without_coarse.find("coarse"), std::string::npos) << "of an encoder that is not there";
  summary.features = {
      .travel = true, .phases = true, .encoder_errors = true, .coarse_errors = true, .final_error = true};
  summary.points[0].of(&trial::MoveOutcome::travel_time).mean = 0.25;
  const std::vector<std::string> lines = table_in(summary_text(summary));
  for (const char* head : {"travel (s)", "|e| median", "phase changes", "|true e| mean", "disagreeing"})
    EXPECT_NE(lines[0].find(head), std::string::npos) << head;
  EXPECT_NE(lines[2].find(" 0.25 "), std::string::npos) << lines[2];
}

TEST(Summary, SaysThatTheBoundsOfASaltelliDesignAreTooNarrow) {
  StudySummary summary = two_cases();
  EXPECT_EQ(summary_text(summary).find("too narrow"), std::string::npos);
  summary.features.dependent_trials = true;
  EXPECT_NE(summary_text(summary).find("not independent: all bounds here are too narrow"), std::string::npos);
}

TEST(Summary, CountsStoppedTrialsIfTheStudyCanStopThem) {
  StudySummary summary = two_cases();
  measures::MeasureStatistics& stopped = summary.points[1].of(&trial::MoveOutcome::stopped);
  stopped.trials = stopped.by_move[0] = 5;
  EXPECT_EQ(summary_text(summary).find("stopped"), std::string::npos);
  EXPECT_EQ(summary_csv(summary).find("stopped"), std::string::npos);
  EXPECT_EQ(summary_json(summary).dump().find("stopped"), std::string::npos);
  const std::size_t columns = measures::point_columns(summary.points).size();

  summary.features.stopping = true;
  const std::vector<std::string> lines = table_in(summary_text(summary));
  EXPECT_NE(lines[0].find("stopped"), std::string::npos);
  EXPECT_NE(lines[3].find(" 71.4 % "), std::string::npos) << lines[3];
  EXPECT_NE(summary_csv(summary).find(",stopped,"), std::string::npos);
  const nlohmann::ordered_json json = summary_json(summary);
  EXPECT_EQ(json["points"][0]["stopped"], 0);
  EXPECT_EQ(json["points"][1]["stopped"], 5);
  EXPECT_EQ(json["points"][1]["moves"][0]["stopped"], 5);
  const std::vector<layout::PointColumn> stored = measures::point_columns(summary.points, summary.features);
  ASSERT_EQ(stored.size(), columns + 1);
  EXPECT_EQ(stored.back().name, "stopped");
  EXPECT_EQ(stored.back().values, (std::vector<double>{0, 5}));
}

TEST(SummaryTable, ShowsADashForPointsOutsideTheCriteria) {
  StudySummary summary = two_cases();
  summary.predictions[1] = {7, 0, 0, 7};
  const std::vector<std::string> lines = table_in(summary_text(summary));
  EXPECT_TRUE(lines[3].ends_with("–             –")) << lines[3];
}

/// Summary of an open-loop study with two design points of three torque levels each; the one trial of the
/// second point diverges in the second level.
StudySummary load_and_unload() {
  measures::PointAccumulator kept({.open_loop = true}), lost({.open_loop = true});
  for (int i = 0; i < 4; ++i) {
    trial::TrialOutcome trial;
    for (const double torque : {0.1, 0.2, 0.0}) {
      trial::MoveOutcome move;
      move.outcome = trial::Outcome::open_loop;
      move.holding_torque = torque;
      move.final_position = 1e-3 * torque + 1e-6 * i;
      move.creep = 1e-7;
      move.reversal_depth = 2;
      move.broke_away = torque == 0.2 && i == 0;
      trial.moves.push_back(move);
    }
    kept.add(trial, {});
    if (i == 0) {
      trial.moves[1] = trial.moves[2] = trial::MoveOutcome{};
      lost.add(trial, {});
    }
  }
  StudySummary summary;
  summary.name = "loads";
  summary.labels = {"kept", "lost"};
  summary.points = {kept.statistics(), lost.statistics()};
  summary.features.open_loop = true;
  return summary;
}

TEST(SummaryOfLevels, TableHasARowPerPointAndLevel) {
  const std::vector<std::string> lines = table_in(summary_text(load_and_unload()));
  ASSERT_GE(lines.size(), 10U);
  EXPECT_EQ(lines[0].find("zero-count"), std::string::npos) << lines[0];
  // By SciPy: mean 101.5, sd 1.291, t interval [99.446, 103.554] of 100 … 103.
  EXPECT_NE(lines[2].find("101.5 [99.4, 103.6]      1.291"), std::string::npos) << lines[2];
  EXPECT_NE(lines[3].find("25.0 %"), std::string::npos) << lines[3];
  EXPECT_NE(lines[4].find("[-0.6, 3.6]"), std::string::npos) << lines[4];
  EXPECT_TRUE(lines[6].ends_with("–           –")) << lines[6];
  EXPECT_TRUE(lines[9].starts_with("lost: 1 of 1 trials nonfinite")) << lines[9];
}

TEST(SummaryOfLevels, JsonHasTheLevelsInEachPoint) {
  const nlohmann::ordered_json json = summary_json(load_and_unload());
  const auto& point = json["points"][0];
  EXPECT_TRUE(point["success_rate"].is_null());
  EXPECT_TRUE(point["success_rate_low"].is_null() && point["success_rate_high"].is_null());
  EXPECT_EQ(point["open_loop"], 4);
  EXPECT_EQ(point["zero_count"], 0);
  ASSERT_EQ(point["levels"].size(), 3U);
  EXPECT_EQ(point["levels"][1]["broke_away"], 1);
  EXPECT_NEAR(point["levels"][1]["position"]["mean"].get<double>(), 201.5e-6, 1e-18);
  EXPECT_TRUE(json["points"][1]["levels"][2]["position"]["mean"].is_null());
  EXPECT_FALSE(summary_json(two_cases())["points"][0].contains("levels"));
}

TEST(SummaryOfLevels, CsvHasALinePerPointAndLevel) {
  const std::vector<std::string> lines = lines_of(summary_csv(load_and_unload()));
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[0].rfind("point,label,level,n,nonfinite,torque,position_mean,position_low,", 0), 0U)
      << lines[0];
  EXPECT_EQ(lines[2].rfind("0,kept,1,4,0,0.2,", 0), 0U) << lines[2];
  EXPECT_EQ(lines[6].rfind("1,lost,2,0,1,nan,nan,nan,nan,", 0), 0U) << lines[6];
}

TEST(Summary, PartsOfDifferentLengthAreRefused) {
  StudySummary summary = two_cases();
  summary.axes[1].numbers.pop_back();
  EXPECT_THROW(summary_json(summary), Failure);
  EXPECT_THROW(summary_csv(summary), Failure);
  EXPECT_THROW(summary_text(summary), Failure);
}

TEST(PointColumns, EqualTheFieldsOfEachPoint) {
  const StudySummary summary = two_cases();
  const std::vector<layout::PointColumn> columns = measures::point_columns(summary.points);
  ASSERT_EQ(columns.size(), measures::statistic_fields().size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    EXPECT_EQ(columns[i].name, text::flat_name(measures::statistic_fields()[i]));
    EXPECT_FALSE(columns[i].unit.empty());
    EXPECT_FALSE(columns[i].long_name.empty());
    EXPECT_EQ(columns[i].values.size(), 2U);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(columns[i].name, columns[j].name);
  }
  const auto success =
      std::find_if(columns.begin(), columns.end(), [](const auto& c) { return c.name == "success_rate"; });
  ASSERT_NE(success, columns.end());
  EXPECT_EQ(success->values, (std::vector<double>{1.0, 0.0}));
  const std::vector<layout::PointColumn> predictions = measures::prediction_columns(summary.predictions);
  EXPECT_EQ(predictions[0].values, (std::vector<double>{1.0, 1.0 / 7.0}));
  EXPECT_EQ(predictions[1].values, (std::vector<double>{0.0, 2.0 / 7.0}));
}

TEST(SummaryTable, ShowsADisabledLimitAsNone) {
  StudySummary summary = two_cases();
  summary.axes.back() = {"controller.deadband.enter",    "count",     "",
                         study::SweepAxis::Kind::number, {-1.0, 2.0}, {}};
  EXPECT_NE(table_in(summary_text(summary))[2].find(" none "), std::string::npos) << summary_text(summary);
}

TEST(SummaryTable, ShowsTheCriteriaOnlyIfTheyApply) {
  StudySummary summary = two_cases();
  EXPECT_NE(summary_text(summary).find("(6) holds"), std::string::npos);
  summary.predictions = {{.trials = 40, .outside = 40}, {.trials = 7, .outside = 7}};
  EXPECT_EQ(summary_text(summary).find("(6) holds"), std::string::npos) << summary_text(summary);
  summary.predictions.clear();
  EXPECT_EQ(summary_text(summary).find("(6) holds"), std::string::npos) << summary_text(summary);
}

}  // namespace
}  // namespace zerocount::summary
