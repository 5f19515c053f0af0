// A file of format version 1 is read, and what it lacks is what was true of its trials, or not known.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "experiments/manifest/load_study.hpp"
#include "experiments/parameters/earlier_defaults.hpp"
#include "results/layout/header.hpp"
#include "results/reading/export.hpp"
#include "tests/results/samples.hpp"
#include "tests/results/walk.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/version_1_file.hpp"

namespace zerocount::testing {
namespace {

class Version1 : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  reading::AllTrialsFile file{version_1_file(folder.path())};
};

TEST_F(Version1, IsWholeAndKnownAsSuch) {
  EXPECT_EQ(file.header().version, 1);
  EXPECT_TRUE(file.header().complete);
  EXPECT_EQ(file.header().name, "version-1");
  EXPECT_EQ(file.rows(), (layout::RowRange{0, 6}));
  EXPECT_EQ(file.moves(), 2);
  EXPECT_EQ(file.measures().size(), 15U);
  read_everything(file.path());
}

TEST_F(Version1, HasItsMeasuresAsTheyWereWritten) {
  // By h5dump of the file.
  const std::vector<trial::MoveOutcome> moves = file.outcomes(file.rows());
  ASSERT_EQ(moves.size(), 12U);
  const std::vector<std::int64_t> arrivals{66, 53, 33, 28, 49, 45, -1, -1, -1, -1, -1, -1};
  for (std::size_t i = 0; i < moves.size(); ++i) {
    EXPECT_EQ(moves[i].outcome, i < 6 ? trial::Outcome::zero_count : trial::Outcome::oscillating);
    EXPECT_EQ(moves[i].arrival, arrivals[i]);
  }
}

TEST_F(Version1, LacksMeasuresThatWereZeroOrAreNotKnown) {
  const trial::MoveOutcome move = file.outcomes({3, 1})[0];
  EXPECT_EQ(move.travel_time, 0.0);
  EXPECT_EQ(move.phase_changes, 0);
  EXPECT_EQ(move.encoder_disagreement, 0);
  EXPECT_FALSE(move.stopped);
  for (const char* measure : {"travel_time", "phase_changes", "encoder_disagreement", "stopped"}) {
    EXPECT_EQ(file.measure(measure, {0, 6}), std::vector<double>(12, 0.0)) << measure;
  }
  EXPECT_TRUE(std::isnan(move.true_error));
  for (const char* measure : {"final_error", "true_error", "final_settling_time", "zero_fraction",
                              "midway_error", "oscillation_amplitude", "oscillation_period"}) {
    const std::vector<double> errors = file.measure(measure, {0, 6});
    ASSERT_EQ(errors.size(), 12U);
    for (const double error : errors) EXPECT_TRUE(std::isnan(error)) << measure;
  }
}

TEST_F(Version1, HasSampleRecordsWhoseReferenceIsTheTarget) {
  const std::vector<layout::TraceRecord> records = file.trace_at(0, file.trace_count());
  ASSERT_EQ(records.size(), 400U);
  for (const layout::TraceRecord& record : records) {
    EXPECT_EQ(record.reference, record.target);
    EXPECT_EQ(record.error, record.target - record.count);
    EXPECT_EQ(record.phase, loop::ControlPhase::fine);
    EXPECT_EQ(record.drive_torque, record.torque);
  }
}

TEST_F(Version1, IsOfAStudyWithTheDefaultsOfItsTime) {
  const study::StudyTrial recorded =
      study::study_trial(layout::recorded_study(file.header(), file.path()), 0, 1);
  EXPECT_EQ(recorded.parameters.friction.uniform.beta, 2.0e5);
  EXPECT_EQ(recorded.parameters.friction.uniform.alpha, friction::FrictionParameters{}.alpha);
  const study::Study today =
      manifest::parse_study(file.header().manifest, "today.yaml", file.header().overrides);
  EXPECT_EQ(study::study_trial(today, 0, 1).parameters.friction.uniform.beta,
            friction::FrictionParameters{}.beta);
}

TEST(EarlierDefaults, AreOfEarlierVersionsAndAreNoLongerTheDefault) {
  for (const parameters::EarlierDefault& earlier : parameters::earlier_defaults()) {
    EXPECT_GE(earlier.until_version, 1) << earlier.name;
    EXPECT_LT(earlier.until_version, layout::format_version) << earlier.name;
    const auto row = parameters::find_parameter(earlier.name);
    ASSERT_TRUE(row) << earlier.name;
    const parameters::Parameter& parameter = parameters::parameter_table()[*row];
    EXPECT_TRUE(numerics::contains(parameter.range, earlier.value)) << earlier.name;
    EXPECT_EQ(parameters::default_value_in(parameter, earlier.until_version), earlier.value) << earlier.name;
    EXPECT_NE(parameters::default_value_in(parameter, earlier.until_version + 1), earlier.value)
        << earlier.name;
    EXPECT_EQ(parameters::default_value_in(parameter, layout::format_version),
              parameters::default_value(parameter))
        << earlier.name;
    EXPECT_EQ(parameters::default_value_in(parameter, parameters::newest_version),
              parameters::default_value(parameter))
        << earlier.name;
  }
}

TEST_F(Version1, IsExportedWithTheColumnsItHas) {
  EXPECT_TRUE(file.statistic_tables().empty());
  reading::export_csv(file, folder / "csv");
  std::ifstream outcomes(folder / "csv/outcomes.csv"), trace(folder / "csv/trace.csv");
  std::string header;
  std::getline(outcomes, header);
  EXPECT_EQ(header.find("final_error"), std::string::npos) << header;
  EXPECT_EQ(header.find("true_error"), std::string::npos) << header;
  EXPECT_NE(header.find("final_position"), std::string::npos) << header;
  std::getline(trace, header);
  EXPECT_TRUE(header.ends_with(",mode")) << header;
}

}  // namespace
}  // namespace zerocount::testing
