#include "results/layout/layout.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/results/equality.hpp"
#include "tests/results/samples.hpp"

namespace zerocount::testing {
namespace {

std::vector<std::string> names(const std::vector<layout::Column>& columns) {
  std::vector<std::string> result;
  for (const layout::Column& column : columns) result.push_back(column.name);
  return result;
}

std::vector<layout::Table> all_tables() {
  const study::Study study = sample_study();
  return {layout::point_table(study.points.axes, {{"trials", "1", "trials", {}}}),
          layout::trial_table(study.columns.inputs),
          layout::outcome_table(layout::format_version, {.stopping = true}),
          layout::jerk_table(),
          layout::trace_table({.travel = true, .phases = true, .drive_torque = true}),
          layout::statistic_table(layout::level_group(), {{"torque", "N m", "$torque", {}}}),
          layout::profile_table("friction.k1", "N m/rad")};
}

TEST(Layout, OfALinearAxisSpeaksOfForcesAndPositions) {
  const auto expect_linear = [](const layout::Column& column) {
    for (const char* word : {"rad", "N m", "rotor", "torque", "angle", "$"}) {
      EXPECT_EQ(column.unit.find(word), std::string::npos) << column.name << " " << column.unit;
      EXPECT_EQ(column.long_name.find(word), std::string::npos) << column.name << ": " << column.long_name;
    }
  };
  for (const layout::Table& table : all_tables()) {
    if (table.group == "point" || table.group == "trial") continue;  // the study's own columns
    const layout::Table linear = layout::on_axis(table, parameters::AxisKind::linear);
    EXPECT_EQ(names(linear.columns), names(table.columns)) << "only their description differs";
    expect_linear(linear.rows);
    for (const layout::Column& column : linear.columns) expect_linear(column);
    const layout::Table rotary = layout::on_axis(table, parameters::AxisKind::rotary);
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      EXPECT_EQ(rotary.columns[i].unit, table.columns[i].unit);
      EXPECT_EQ(rotary.columns[i].long_name.find('$'), std::string::npos) << rotary.columns[i].long_name;
    }
  }
}

TEST(Layout, TellsWhatWasStoppedLastAndOnlyWhereItCanBe) {
  std::vector<std::string> expected = names(layout::outcome_table().columns);
  EXPECT_EQ(std::count(expected.begin(), expected.end(), "stopped"), 0);
  expected.emplace_back("stopped");
  EXPECT_EQ(names(layout::outcome_table(layout::format_version, {.stopping = true}).columns), expected);
}

TEST(Layout, OfVersion2LacksTheMeasuresOfTheEndOfAMove) {
  std::vector<std::string> expected =
      names(layout::outcome_table(layout::format_version, {.stopping = true}).columns);
  for (const char* measure : {"final_settling_time", "zero_fraction", "midway_error", "oscillation_amplitude",
                              "oscillation_period"}) {
    EXPECT_EQ(std::erase(expected, measure), 1U) << measure;
  }
  EXPECT_EQ(names(layout::outcome_table(2, {.stopping = true}).columns), expected);
}

TEST(Layout, TracesHaveTheColumnsOfTheFeaturesLast) {
  const std::vector<std::string> always = names(layout::trace_table({}).columns);
  for (unsigned which = 0; which < 8; ++which) {
    const study::StudyFeatures features{
        .travel = (which & 1U) != 0, .phases = (which & 2U) != 0, .drive_torque = (which & 4U) != 0};
    std::vector<std::string> expected = always;
    if (features.travel) expected.emplace_back("reference");
    if (features.phases) expected.emplace_back("phase");
    if (features.drive_torque) expected.emplace_back("drive_torque");
    EXPECT_EQ(names(layout::trace_table(features).columns), expected);
  }
}

TEST(Layout, EveryColumnHasAUnitAndAMeaning) {
  for (const layout::Table& table : all_tables()) {
    for (const layout::Column& column : table.columns) {
      EXPECT_FALSE(column.unit.empty()) << table.group << "/" << column.name;
      EXPECT_FALSE(column.long_name.empty()) << table.group << "/" << column.name;
    }
  }
}

TEST(Layout, NamesAreUniqueWithinATable) {
  for (const layout::Table& table : all_tables()) {
    std::set<std::string> seen{table.rows.name};
    if (table.second) seen.insert(table.second->name);
    for (const layout::Column& column : table.columns) {
      if (table.group == "trial" && column.name == "trial") continue;
      if (table.group == "jerk" && column.name == "move") continue;
      EXPECT_TRUE(seen.insert(column.name).second) << table.group << "/" << column.name;
    }
  }
}

TEST(Layout, EnumerationsNameEveryValueAndFlagsAreNoOrYes) {
  for (const layout::Table& table : all_tables()) {
    for (const layout::Column& column : table.columns) {
      EXPECT_EQ(!column.flags.empty(),
                column.element == hdf5::Element::int8 || column.element == hdf5::Element::flag)
          << column.name;
      for (std::size_t value = 0; value < column.flags.size(); ++value) {
        EXPECT_EQ(column.flags[value].value, static_cast<std::int64_t>(value));
      }
    }
  }
}

TEST(Fields, ScatterIsTheReverseOfGather) {
  const study::Study study = sample_study();
  std::vector<trial::MoveOutcome> moves;
  std::vector<layout::TraceRecord> records;
  for (const shards::TrialResult& result : sample_results(study, layout::all_rows(study))) {
    moves.insert(moves.end(), result.outcome.moves.begin(), result.outcome.moves.end());
    for (const trial::SampleRecord& record : result.trace) records.push_back({record, result.row});
  }
  std::vector<trial::MoveOutcome> moves_back(moves.size());
  const auto& measures = layout::outcome_fields(layout::format_version, study.features);
  for (const layout::RecordField<trial::MoveOutcome>& field : measures) {
    layout::scatter(field,
                    layout::columns_of<trial::MoveOutcome>({field}, layout::pointers_to(moves)).front(),
                    std::span(moves_back));
  }
  expect_equal_records(measures, moves, moves_back);
  std::vector<layout::TraceRecord> records_back(records.size());
  for (const layout::RecordField<layout::TraceRecord>& field : layout::trace_fields(study.features)) {
    layout::scatter(field,
                    layout::columns_of<layout::TraceRecord>({field}, layout::pointers_to(records)).front(),
                    std::span(records_back));
  }
  expect_equal_records(layout::trace_fields(study.features), records, records_back);
}

}  // namespace
}  // namespace zerocount::testing
