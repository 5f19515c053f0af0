// Branches, holds and ring-downs, as the torque shows them.
#include <gtest/gtest.h>

#include "analysis/record/fit/record.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

fit::RecordParts parts_of_programme(const TorqueProgramme& programme, double torque_step = 2.4e-4) {
  std::mt19937_64 random(41);
  TestInstrument instrument;
  instrument.torque_step = torque_step;
  return fit::parts_of(simulated_test({}, programme, instrument, random));
}

TEST(RecordParts, BranchesGoFromReversalToReversal) {
  TorqueProgramme programme;
  programme.ramp(0.1, 0.4).ramp(-0.05, 0.4).ramp(0.02, 0.4).hold(0.1).ramp(-0.1, 0.4);
  for (const double torque_step : {0.0, 2.4e-4}) {
    const fit::RecordParts parts = parts_of_programme(programme, torque_step);
    ASSERT_EQ(parts.branches.size(), 4u);
    EXPECT_EQ(parts.reversals(), 3u);
    const double turns[] = {0.0, 0.1, -0.05, 0.02, -0.1};
    for (std::size_t b = 0; b < 4; ++b) {
      EXPECT_NEAR(parts.branches[b].from, turns[b], 2.4e-4);
      EXPECT_NEAR(parts.branches[b].to, turns[b + 1], 2.4e-4);
      EXPECT_TRUE(parts.branches[b].slow);
      if (b > 0) {
        EXPECT_EQ(parts.branches[b].first, parts.branches[b - 1].last);
      }
    }
  }
}

TEST(RecordParts, SmallOscillationsAreNotReversals) {
  TorqueProgramme programme;
  for (int i = 1; i <= 50; ++i) programme.ramp(0.002 * i, 0.4).ramp(0.002 * i - 0.001, 0.4);
  EXPECT_EQ(parts_of_programme(programme).reversals(), 0u);
}

TEST(RecordParts, OnlyAStepStartsARingDown) {
  TorqueProgramme programme;
  programme.step(0.1).hold(0.2).ramp(0.15, 0.1).hold(0.3).step(0.0).hold(0.1);
  const fit::RecordParts parts = parts_of_programme(programme);
  ASSERT_EQ(parts.holds.size(), 3u);
  EXPECT_TRUE(parts.holds[0].rings_down);
  EXPECT_FALSE(parts.holds[1].rings_down);
  EXPECT_TRUE(parts.holds[2].rings_down);
  EXPECT_NEAR(parts.holds[1].torque, 0.15, 2.4e-4);
  EXPECT_NEAR(static_cast<double>(parts.holds[1].last - parts.holds[1].first), 600.0, 3.0);
}

TEST(RecordParts, AMonotoneTorqueHasNoReversal) {
  TorqueProgramme programme;
  programme.ramp(0.1, 0.2);
  EXPECT_EQ(parts_of_programme(programme).reversals(), 0u);
  EXPECT_EQ(parts_of_programme(programme).branches.size(), 1u);
  EXPECT_TRUE(fit::parts_of(fit::TestRecord{}).branches.empty());
}

}  // namespace
}  // namespace zerocount::testing
