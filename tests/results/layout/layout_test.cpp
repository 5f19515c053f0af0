#include "results/layout/layout.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/results/equality.hpp"
#include "tests/results/samples.hpp"

namespace zerocount::testing {
namespace {

std::vector<std::string> names(const std::vector<Column>& columns) {
  std::vector<std::string> result;
  for (const Column& column : columns) result.push_back(column.name);
  return result;
}

std::vector<Table> all_tables() {
  const Study study = sample_study();
  return {point_table(study.axes, {{"trials", "1", "trials", {}}}),
          trial_table(study.input_columns),
          outcome_table(format_version, {true}),
          jerk_table(),
          trace_table({true, true, true}),
          statistic_table(level_group(), {{"torque", "N m", "torque", {}}}),
          profile_table("friction.k1", "N m/rad")};
}

TEST(Layout, OfALinearAxisSpeaksOfForcesAndPositions) {
  const auto expect_linear = [](const Column& column) {
    for (const char* word : {"rad", "N m", "rotor", "torque", "angle"}) {
      EXPECT_EQ(column.unit.find(word), std::string::npos) << column.name << " " << column.unit;
      EXPECT_EQ(column.long_name.find(word), std::string::npos) << column.name << ": " << column.long_name;
    }
  };
  for (const Table& table : all_tables()) {
    if (table.group == "point" || table.group == "trial") continue;  // the study's own columns
    const Table linear = on_axis(table, AxisKind::linear);
    EXPECT_EQ(names(linear.columns), names(table.columns)) << "only their description differs";
    expect_linear(linear.rows);
    for (const Column& column : linear.columns) expect_linear(column);
    const Table rotary = on_axis(table, AxisKind::rotary);
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      EXPECT_EQ(rotary.columns[i].unit, table.columns[i].unit);
      EXPECT_EQ(rotary.columns[i].long_name, table.columns[i].long_name);
    }
  }
}

TEST(Layout, HasOneColumnPerMeasureOfAMove) {
  const std::vector<std::string> expected{"outcome",
                                          "arrived",
                                          "arrival",
                                          "settling_time",
                                          "final_settling_time",
                                          "zero_fraction",
                                          "stable",
                                          "broke_away",
                                          "saturated",
                                          "overshoot",
                                          "holding_torque",
                                          "peak_torque",
                                          "creep",
                                          "final_position",
                                          "midway_error",
                                          "final_error",
                                          "true_error",
                                          "travel_time",
                                          "phase_changes",
                                          "encoder_disagreement",
                                          "oscillation_amplitude",
                                          "oscillation_period",
                                          "reversal_depth",
                                          "jerk_count",
                                          "jerk_agreement"};
  EXPECT_EQ(names(outcome_table().columns), expected);
}

TEST(Layout, TellsWhatWasStoppedLastAndOnlyWhereItCanBe) {
  std::vector<std::string> expected = names(outcome_table().columns);
  EXPECT_EQ(std::count(expected.begin(), expected.end(), "stopped"), 0);
  expected.emplace_back("stopped");
  EXPECT_EQ(names(outcome_table(format_version, {true}).columns), expected);
}

TEST(Layout, OfVersion1HasTheFirstMeasures) {
  EXPECT_EQ(
      names(outcome_table(1).columns),
      (std::vector<std::string>{"outcome", "arrived", "arrival", "settling_time", "stable", "broke_away",
                                "saturated", "overshoot", "holding_torque", "peak_torque", "creep",
                                "final_position", "reversal_depth", "jerk_count", "jerk_agreement"}));
}

TEST(Layout, OfVersion2LacksTheMeasuresOfTheEndOfAMove) {
  std::vector<std::string> expected = names(outcome_table(format_version, {true}).columns);
  for (const char* measure : {"final_settling_time", "zero_fraction", "midway_error", "oscillation_amplitude",
                              "oscillation_period"}) {
    EXPECT_EQ(std::erase(expected, measure), 1U) << measure;
  }
  EXPECT_EQ(names(outcome_table(2, {true}).columns), expected);
}

TEST(Layout, TracesHaveTheColumnsOfTheTraceCommandAfterTheTrial) {
  const std::vector<std::string> always{"trial",        "k",     "t",    "target", "count",
                                        "coarse_count", "error", "code", "torque", "theta",
                                        "omega",        "xp",    "xh",   "depth",  "mode"};
  EXPECT_EQ(names(trace_table({}).columns), always);
  for (unsigned which = 0; which < 8; ++which) {
    const TraceExtras extras{(which & 1U) != 0, (which & 2U) != 0, (which & 4U) != 0};
    std::vector<std::string> expected = always;
    if (extras.reference) expected.emplace_back("reference");
    if (extras.phase) expected.emplace_back("phase");
    if (extras.drive_torque) expected.emplace_back("drive_torque");
    EXPECT_EQ(names(trace_table(extras).columns), expected);
  }
}

TEST(Layout, JerksHaveTheColumnsOfTheFormat) {
  EXPECT_EQ(names(jerk_table().columns),
            (std::vector<std::string>{"trial", "move", "onset", "duration", "magnitude", "direction"}));
}

TEST(Layout, EveryColumnHasAUnitAndAMeaning) {
  for (const Table& table : all_tables()) {
    for (const Column& column : table.columns) {
      EXPECT_FALSE(column.unit.empty()) << table.group << "/" << column.name;
      EXPECT_FALSE(column.long_name.empty()) << table.group << "/" << column.name;
    }
  }
}

TEST(Layout, NamesAreUniqueWithinATable) {
  for (const Table& table : all_tables()) {
    std::set<std::string> seen{table.rows.name};
    if (table.second) seen.insert(table.second->name);
    for (const Column& column : table.columns) {
      if (table.group == "trial" && column.name == "trial") continue;
      if (table.group == "jerk" && column.name == "move") continue;
      EXPECT_TRUE(seen.insert(column.name).second) << table.group << "/" << column.name;
    }
  }
}

TEST(Layout, EnumerationsNameEveryValueAndFlagsAreNoOrYes) {
  for (const Table& table : all_tables()) {
    for (const Column& column : table.columns) {
      EXPECT_EQ(!column.flags.empty(), column.element == Element::int8 || column.element == Element::flag)
          << column.name;
      for (std::size_t value = 0; value < column.flags.size(); ++value) {
        EXPECT_EQ(column.flags[value].value, static_cast<std::int64_t>(value));
      }
    }
  }
  EXPECT_EQ(outcome_fields()[0].column.flags.size(), 6U);
  EXPECT_EQ(outcome_fields()[0].column.flags[2].word, "oscillating");
}

TEST(Fields, ScatterIsTheReverseOfGather) {
  const Study study = sample_study();
  std::vector<MoveOutcome> moves;
  std::vector<TraceRecord> records;
  for (const TrialResult& result : sample_results(study, all_rows(study))) {
    moves.insert(moves.end(), result.outcome.moves.begin(), result.outcome.moves.end());
    for (const SampleRecord& record : result.trace) records.push_back({record, result.row});
  }
  std::vector<MoveOutcome> moves_back(moves.size());
  const auto& measures = outcome_fields(format_version, study.outcome_extras);
  for (const RecordField<MoveOutcome>& field : measures) {
    scatter(field, gather(field, std::span<const MoveOutcome>(moves)), std::span(moves_back));
  }
  expect_equal_records(measures, moves, moves_back);
  std::vector<TraceRecord> records_back(records.size());
  for (const RecordField<TraceRecord>& field : trace_fields(study.trace_extras)) {
    scatter(field, gather(field, std::span<const TraceRecord>(records)), std::span(records_back));
  }
  expect_equal_records(trace_fields(study.trace_extras), records, records_back);
}

}  // namespace
}  // namespace zerocount::testing
