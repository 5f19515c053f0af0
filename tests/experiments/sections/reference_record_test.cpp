// A recorded reference in a manifest: as a table, and as a list of pairs.
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount::sections {
namespace {

std::string followed(const std::string& reference, const std::string& more = "") {
  return "zerocount: 1\nname: followed\nseed: 1\ntrials: 1\ncommand: {reference: " + reference + more +
         "}\nverdict: {motion: true}\n";
}

study::Study followed_study(const std::string& manifest, const std::string& table = "") {
  ExternalInputs external;
  external.samples = [&table](const std::string&, std::string_view) { return table; };
  return manifest::parse_study(manifest, "followed.yaml", {}, external);
}

std::string refusal(const std::string& manifest, const std::string& table = "") {
  return refusal_by([&] { followed_study(manifest, table); });
}

TEST(ReferenceFromAFile, IsOneMoveAsLongAsTheRecord) {
  const study::Study study = followed_study(followed("{file: r.csv, column: axis 2}"),
                                            "time [ms];axis 2 [mrad]\n100;0\n200;2\n500;-1\n");
  EXPECT_FALSE(study.open_loop);
  EXPECT_EQ(study.moves, 1);
  const trial::TrialParameters trial = study::study_trial(study, 0, 0).parameters;
  EXPECT_EQ(trial.command.targets, std::vector<std::int64_t>{0});
  EXPECT_EQ(trial.command.profile.shape, loop::ReferenceShape::record);
  ASSERT_NE(trial.command.profile.record, nullptr);
  const loop::ReferenceRecord& record = *trial.command.profile.record;
  ASSERT_EQ(record.time.size(), 3u);
  EXPECT_NEAR(record.time[2], 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(record.position[1], 0.002);
  EXPECT_NEAR(trial.command.hold, 0.4 + 1.0 / trial.controller.sample_rate, 1e-12);
  EXPECT_TRUE(study.features.following);
  EXPECT_FALSE(study.features.reversals) << "those of a sine";
  EXPECT_FALSE(study.features.steps);
  const study::Study again =
      manifest::parse_study(study.manifest.text, "followed.yaml", study.manifest.overrides, {});
  EXPECT_EQ(again.study_sha256, study.study_sha256) << "the study is whole without the file";
}

TEST(ReferenceFromAFile, LastsUntilItsLastRowAndOneSampleUnlessAHoldIsGiven) {
  const auto hold_of = [](const std::string& more) {
    const study::Study study = followed_study(followed("{file: [[0, 0], [2, 0.001], [5, 0]]}", more));
    return study::study_trial(study, 0, 0).parameters.command.hold;
  };
  EXPECT_EQ(hold_of(""), 5.0 + 1.0 / 2000.0);
  EXPECT_EQ(hold_of(", hold: 3"), 3.0);
  EXPECT_EQ(hold_of(", hold: 30"), 30.0) << "after the record the reference stands";
}

// A record at the controller's rate has as many samples as rows, whichever rate that is.
TEST(ReferenceFromAFile, LastsOneSampleLongerAtEachSampleRate) {
  const study::Study study = followed_study(followed("{file: [[0, 0], [2, 0.001], [5, 0]]}") +
                                            "sweep: {grid: {controller.sample_rate: [500, 2000, 7000]}}\n");
  for (std::int64_t point = 0; point < 3; ++point) {
    const trial::TrialParameters trial = study::study_trial(study, point, 0).parameters;
    EXPECT_EQ(trial::samples_of_trial(trial), std::llround(5.0 * trial.controller.sample_rate) + 1);
  }
  EXPECT_TRUE(study.warnings.empty()) << study.warnings.front();
}

TEST(ReferenceFromAFile, IsCutByAShorterHoldWithAWarning) {
  const auto warnings_of = [](const std::string& hold) {
    return followed_study(followed("{file: [[0, 0], [2, 0.001], [5, 0]]}", ", hold: " + hold)).warnings;
  };
  ASSERT_EQ(warnings_of("4.9").size(), 1u);
  EXPECT_TRUE(says(warnings_of("4.9").front(),
                   "command.hold: a hold of 4.9 s cuts the record of command.reference.file, whose last row "
                   "is at 5 s; expected command.hold at least 5.0005 s, or none"));
  EXPECT_EQ(warnings_of("5").size(), 1u) << "its last row is no sample";
  EXPECT_TRUE(warnings_of("5.0005").empty());
  EXPECT_TRUE(warnings_of("9").empty());
}

/// Text of a record of 1000 rows, 1 ms apart, without the 50 rows from row `lost` on.
/// @param row function that returns the line of a row
template <class Row>
std::string record_without(int lost, const Row& row) {
  std::string text;
  for (int k = 0; k < 1000; ++k)
    if (k < lost || k >= lost + 50) text += row(0.001 * k, 1e-3 * std::sin(0.009 * k));
  return text;
}

TEST(ReferenceFromAFile, AGapInItsTimesIsReportedWithItsLine) {
  const auto table_row = [](double t, double x) { return fmt::format("{:.3f},{:.9f}\n", 2.0 + t, x); };
  const std::string table = "# axis 1\nt,reference\n" + record_without(400, table_row);
  const study::Study study = followed_study(followed("{file: r.csv}"), table);
  ASSERT_EQ(study.warnings.size(), 1u);
  EXPECT_EQ(
      study.warnings.front(),
      "r.csv:403:1: command.reference.file: no rows for 0.051 s, between 2.399 and 2.45 s, where others are "
      "0.001 s apart: a straight line joins them");
  const study::Study again =
      manifest::recorded_study(study.manifest.text, "followed.yaml", study.manifest.overrides, {});
  EXPECT_TRUE(again.warnings.empty()) << again.warnings.front() << ": it was said when the study was made";
  EXPECT_TRUE(followed_study(followed("{file: r.csv}"), "t,reference\n" + record_without(1000, table_row))
                  .warnings.empty());

  const auto pair = [](double t, double x) { return fmt::format("[{:.3f}, {:.9f}], ", t, x); };
  const std::vector<std::string> of_list =
      followed_study(followed("{file: [" + record_without(700, pair) + "]}")).warnings;
  ASSERT_EQ(of_list.size(), 1u);
  EXPECT_TRUE(says(of_list.front(), "followed.yaml:5:", "between 0.699 and 0.75 s"));
}

TEST(ReferenceFromAFile, RowsMayBeLeftOutAtStandstill) {
  std::string table = "t,reference\n";
  for (int k = 0; k <= 300; ++k) table += fmt::format("{},{}\n", 0.001 * k, 1e-5 * k);
  for (int k = 0; k <= 300; ++k) table += fmt::format("{},{}\n", 1.0 + 0.001 * k, 3e-3 - 1e-5 * k);
  EXPECT_TRUE(followed_study(followed("{file: r.csv}"), table).warnings.empty());
}

// A torque is held across the gap.
TEST(TorqueFromAFile, AGapInItsTimesIsReported) {
  const std::string manifest =
      "zerocount: 1\nname: driven\nseed: 1\ntrials: 1\ncommand: {torque: {file: u.csv, through: exact}}\n";
  const auto row = [](double t, double u) { return fmt::format("{:.3f},{:.9f}\n", t, u); };
  const std::vector<std::string> warnings =
      followed_study(manifest, "t,torque\n" + record_without(100, row)).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(says(warnings.front(), "u.csv:102:1: command.torque.file: no rows for 0.051 s",
                   "the value before it is held"));
}

TEST(ReferenceFromAFile, ItsHoldMayBeSwept) {
  const std::string moving =
      "controller: {feedforward: {velocity: 0.1}}\nsweep: {grid: {command.hold: [0.4, 0.2]}}\n";
  const study::Study study =
      followed_study(followed("{file: r.csv}") + moving, "t,reference\n0,0\n0.5,0.01\n");
  EXPECT_EQ(study::study_trial(study, 1, 0).parameters.command.hold, 0.2);
}

TEST(ReferenceFromAFile, MistakesAreReportedWithTheirPlace) {
  const std::string table = "t,reference\n0,0\n0.1,0.01\n";
  EXPECT_TRUE(says(refusal(followed("{file: r.csv}"), "t,position\n0,1\n1,2\n"),
                   "r.csv:1:1: command.reference.file: the table has no column reference; expected a header "
                   "such as t [s], reference [rad]"));
  EXPECT_TRUE(says(refusal(followed("{file: r.csv}"), "t,reference [mm]\n0,1\n1,2\n"),
                   "r.csv:1:1: command.reference.file: the column reference has the unit 'mm'; expected rad, "
                   "mrad or deg"));
  EXPECT_TRUE(says(refusal(followed("{file: r.csv}", ", profile: {shape: step}"), table),
                   "command.profile: command.reference defines the path of the reference"));
  EXPECT_TRUE(says(refusal(followed("{file: r.csv}", ", targets: [1]"), table),
                   "command.targets: command.reference already defines the moves"));
  EXPECT_TRUE(says(refusal(followed("{file: [[0, 0], [1, 0.01]], column: x}")),
                   "command.reference.column: it has no effect: the record is a list of pairs"));
  EXPECT_TRUE(says(refusal(followed("{column: x}")), "command.reference.file"));
  EXPECT_TRUE(says(refusal(followed("{file: [[0, 0], [1, 1e12]]}")),
                   "command.reference.file: the command can reach"));
  EXPECT_TRUE(says(refusal("zerocount: 1\nname: n\nseed: 1\ntrials: 1\ncommand: {targets: [1], profile: "
                           "{shape: record}}\n"),
                   "command.profile.shape: there is no record; expected command.reference"));
  EXPECT_TRUE(says(refusal(followed("{file: [[0, 0], [1, 1.0e-9]]}")),
                   "command.reference.file: a record from 0 to 1e-09 rad stays at one count"));
}

}  // namespace
}  // namespace zerocount::sections
