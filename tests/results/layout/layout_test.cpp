#include "results/layout/layout.hpp"

#include <set>

#include "core/trial/move_measures.hpp"
#include "results/layout/header.hpp"
#include "results/layout/measure_table.hpp"
#include "tests/results/equality.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/test.hpp"

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
          layout::outcome_table({.stopping = true}),
          layout::jerk_table(),
          layout::trace_table({.travel = true, .phases = true, .drive_torque = true}),
          layout::statistic_table(layout::level_group(), {{"torque", "N m", "$torque", {}}}),
          layout::profile_table("friction.k1", "N m/rad")};
}

TEST(Layout, ALinearAxisHasForcesAndPositions) {
  const auto expect_linear = [](const layout::Column& column) {
    for (const char* word : {"rad", "N m", "rotor", "torque", "angle", "$"}) {
      EXPECT_FALSE(says(column.unit, word)) << column.name << " " << column.unit;
      EXPECT_FALSE(says(column.long_name, word)) << column.name << ": " << column.long_name;
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

TEST(Layout, HasAStoppedColumnOnlyIfTrialsCanBeStopped) {
  std::vector<std::string> expected = names(layout::outcome_table().columns);
  EXPECT_EQ(std::count(expected.begin(), expected.end(), "stopped"), 0);
  expected.emplace_back("stopped");
  EXPECT_EQ(names(layout::outcome_table({.stopping = true}).columns), expected);
}

TEST(Layout, TracesEndWithTheColumnsOfOptionalFeatures) {
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
      for (std::size_t value = 0; value < column.flags.size(); ++value)
        EXPECT_EQ(column.flags[value].value, static_cast<std::int64_t>(value));
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
  const auto& measures = layout::outcome_fields(study.features);
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

namespace zerocount::layout {
namespace {

bool matches(const std::string& text, const std::string& expression) {
  return ::testing::Matcher<std::string>(::testing::MatchesRegex(expression)).Matches(text);
}

TEST(Provenance, NamesVersionCommitCompilerProcessorAndTime) {
  const Provenance provenance = current_provenance();
  EXPECT_TRUE(matches(provenance.zerocount_version, "[0-9]+[.][0-9]+[.][0-9]+"))
      << provenance.zerocount_version;
  EXPECT_TRUE(matches(provenance.git_commit, "unknown|[0-9a-f]{40}(-dirty)?")) << provenance.git_commit;
  EXPECT_TRUE(matches(provenance.compiler, "[A-Za-z]+ [0-9.]+")) << provenance.compiler;
  EXPECT_FALSE(provenance.cpu.empty());
  EXPECT_TRUE(matches(provenance.created, "[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"))
      << provenance.created;
}

TEST(Provenance, EqualVersionAndCommitMeanTheSameBuild) {
  const auto build = [](const char* version, const char* commit) {
    return Provenance{version, commit, "GNU 12.2.0", "some processor", "2002-07-21T12:00:00Z"};
  };
  EXPECT_TRUE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "a1b2")));
  EXPECT_TRUE(same_build(build("0.1.0", "unknown"), build("0.1.0", "unknown")));
  EXPECT_TRUE(same_build(build("0.1.0", "a1b2-dirty"), build("0.1.0", "a1b2")));
  EXPECT_TRUE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "a1b2-dirty")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "c3d4")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2-dirty"), build("0.1.0", "c3d4-dirty")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2"), build("0.1.0", "unknown")));
  EXPECT_FALSE(same_build(build("0.1.0", "a1b2"), build("0.2.0", "a1b2")));
  EXPECT_TRUE(is_dirty(build("0.1.0", "a1b2-dirty")));
  EXPECT_FALSE(is_dirty(build("0.1.0", "a1b2")));
}

}  // namespace
}  // namespace zerocount::layout

// The measures that a goal can limit are those of the file.

namespace zerocount::testing {
namespace {

TEST(NamedMeasures, AreColumnsOfTheFile) {
  const study::StudyFeatures features{.bands = {{3}, 1}, .tolerances = {{1e-8}, 1}};
  const layout::MeasureTable& measures = layout::measure_table(features);
  const auto expect_column = [&](std::string_view name) {
    EXPECT_TRUE(std::ranges::any_of(measures, [name](const layout::Measure& measure) {
      return measure.field.column.name == name;
    })) << name;
  };
  for (const trial::NamedMeasure& named : trial::named_measures()) expect_column(named.name);
  for (const std::string_view named : trial::named_band_measures())
    expect_column(layout::name_of_band(named, 3));
  expect_column(layout::name_of_tolerance(trial::tolerance_measure, 1e-8));
}

TEST(NamedMeasures, CoverAllMeasuresExceptTheOutcome) {
  const std::set<std::string_view> not_limited{"outcome", "stopped", "controller_failed"};
  for (const layout::Measure& measure : layout::measure_table({})) {
    const std::string_view name = measure.field.column.name;
    const bool of_limit = name.ends_with(']');
    if (of_limit || not_limited.contains(name) || name.starts_with("load_") || name.starts_with("motor_"))
      continue;
    EXPECT_NE(std::ranges::find(trial::named_measures(), name, &trial::NamedMeasure::name),
              trial::named_measures().end())
        << name;
  }
}

// The study of a results file, by its manifest and overrides, has the trials that the file has.

layout::FileHeader header_of(std::int64_t points, std::int64_t trials) {
  layout::FileHeader header;
  header.manifest =
      "zerocount: 1\nname: recorded\nseed: 1\ntrials: 2\ncommand: {targets: [1], hold: 0.5}\n"
      "sweep: {grid: {controller.kp: [0, 1.0e-4, 2.0e-4]}}\n";
  header.points = points;
  header.trials = trials;
  return header;
}

TEST(RecordedStudy, HasTheTrialsOfTheFile) {
  EXPECT_EQ(study::trial_count(layout::recorded_study(header_of(3, 2), "study.h5")), 6);
}

// Statistics of the trials of a file by another study wrote beyond the end of their vectors.
TEST(RecordedStudy, AStudyWithOtherTrialsThanTheFileIsRefused) {
  layout::FileHeader more = header_of(3, 2);
  more.overrides = {"trials=4"};
  expect_failure(ExitCode::bad_data,
                 "study.h5: damaged: it has 3 design points with 2 trials each; its manifest and overrides "
                 "have 3 with 4",
                 [&] { layout::recorded_study(more, "study.h5"); });
  expect_failure(ExitCode::bad_data, "it has 4 design points with 2 trials each",
                 [&] { layout::recorded_study(header_of(4, 2), "study.h5"); });
}

}  // namespace
}  // namespace zerocount::testing
