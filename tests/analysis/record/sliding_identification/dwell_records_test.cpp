// Dwells: the rotor creeps on its bristles under the loop's integral and does not slide, although a fine
// encoder sees it move.
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/record/sliding_identification/coverage.hpp"
#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

using sliding_identification::SlidingIdentification;

SlidingIdentification identified_dwells(const records::RawSeries& series) {
  return sliding_identification::identify_sliding({sliding_identification::sliding_record(series)});
}

BristleAxis random_bristle_axis(std::mt19937_64& random) {
  BristleAxis axis;
  axis.mass = log_uniform(random, 5.0, 200.0);
  axis.damping = axis.mass * log_uniform(random, 0.5, 4.0);
  axis.coulomb = axis.mass * log_uniform(random, 0.1, 0.5);
  axis.offset = axis.coulomb * std::uniform_real_distribution<double>(-0.3, 0.3)(random);
  axis.bristle_travel = log_uniform(random, 2e-6, 2e-5);
  return axis;
}

struct DwellCoverage {
  int held{0};
  int estimated{0};
};

/// Expects that the confidence intervals cover the true values often enough, over `axes` random axes and
/// their records.
void expect_dwell_coverage(
    int axes, const std::function<records::RawSeries(const BristleAxis&, std::mt19937_64&)>& record) {
  std::map<std::string, DwellCoverage> coverage;
  for (int seed = 1; seed <= axes; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const BristleAxis axis = random_bristle_axis(random);
    const std::map<std::string, double> truths{{"inertia", axis.mass},
                                               {"sliding_damping", axis.damping},
                                               {"coulomb_level", axis.coulomb},
                                               {"offset", axis.offset}};
    for (const auto& parameter : identified_dwells(record(axis, random)).parameters) {
      const auto truth = truths.find(parameter.name);
      if (truth == truths.end() || parameter.status != fit::EstimateStatus::estimated) continue;
      DwellCoverage& count = coverage[parameter.name];
      ++count.estimated;
      count.held += parameter.low <= truth->second && truth->second <= parameter.high ? 1 : 0;
      const double far = parameter.name == "offset" ? 0.03 * axis.coulomb : 0.03 * truth->second;
      EXPECT_NEAR(parameter.value, truth->second, far) << parameter.name << ", seed " << seed;
    }
  }
  int held = 0;
  int estimated = 0;
  for (const auto& [name, count] : coverage) {
    EXPECT_GE(count.estimated, axes * 8 / 10) << name;
    held += count.held;
    estimated += count.estimated;
  }
  EXPECT_GE(held, 0.9 * estimated) << "of " << estimated;
}

void expect_creep_not_taken_for_sliding(int axes) {
  expect_dwell_coverage(axes, [](const BristleAxis& axis, std::mt19937_64& random) {
    DwellLoop loop;
    loop.resolution = axis.bristle_travel * log_uniform(random, 2e-3, 3e-2);
    loop.dwell = log_uniform(random, 0.3, 3.0);
    return dwell_record(axis, loop, random);
  });
}

TEST(DwellRecords, CreepInDwellsIsNotTakenForSliding) {
  expect_creep_not_taken_for_sliding(8);
}

TEST(DwellRecords, DISABLED_CreepInDwellsOfMoreAxesIsNotTakenForSliding) {
  expect_creep_not_taken_for_sliding(20);
}

TEST(DwellRecords, CoarseAndNoisyReadingsOfDwellsKeepTheirBounds) {
  expect_dwell_coverage(10, [](const BristleAxis& axis, std::mt19937_64& random) {
    DwellLoop loop;
    loop.resolution = axis.bristle_travel * log_uniform(random, 0.1, 2.0);
    loop.noise = 0.5 * loop.resolution;
    return dwell_record(axis, loop, random);
  });
}

// Moves of 50 to 200 pre-sliding travels, between dwells three times as long.
TEST(DwellRecords, ShortMovesBetweenLongDwellsSuffice) {
  expect_dwell_coverage(10, [](const BristleAxis& axis, std::mt19937_64& random) {
    DwellLoop loop;
    loop.resolution = 1e-2 * axis.bristle_travel;
    loop.amplitude = axis.bristle_travel * log_uniform(random, 50.0, 200.0);
    loop.move = 0.2;
    loop.dwell = 0.6;
    loop.moves = 12;
    return dwell_record(axis, loop, random);
  });
}

TEST(DwellRecords, RampsBelowTheFrictionAreNotTakenForSliding) {
  expect_dwell_coverage(8, [](const BristleAxis& axis, std::mt19937_64& random) {
    DwellLoop loop;
    loop.resolution = 1e-2 * axis.bristle_travel;
    return pulsed_record(axis, loop, random);
  });
}

// A trace says where the axis slides.
TEST(DwellRecords, TheFlagsOfARecordReplaceThePresumption) {
  std::mt19937_64 random(3);
  records::RawSeries series = dwell_record({}, {}, random);
  series.sliding.assign(series.time.size(), false);
  for (std::size_t k = 100; k < 400; ++k) series.sliding[k] = true;
  const auto record = sliding_identification::sliding_record(series);
  EXPECT_EQ(record.presliding_travel, 0.0);
  ASSERT_FALSE(record.strokes.empty());
  for (const auto& stroke : record.strokes) {
    EXPECT_GE(stroke.first, 100u);
    EXPECT_LT(stroke.last, 400u);
  }
}

TEST(DwellRecords, MotionWithinThePreslidingRangeIsRefused) {
  std::mt19937_64 random(4);
  BristleAxis axis;
  axis.bristle_travel = 1e-3;
  DwellLoop loop;
  for (const double amplitude : {2e-4, 5e-4, 1e-3}) {
    loop.amplitude = amplitude;
    try {
      identified_dwells(dwell_record(axis, loop, random));
      ADD_FAILURE() << amplitude;
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_data);
      EXPECT_NE(std::string(failure.what()).find("dwells.csv: shows no sliding"), std::string::npos)
          << failure.what();
    }
  }
}

// Ceres' reasons are not the user's.
TEST(DwellRecords, AFailedFitPrintsNothing) {
  std::mt19937_64 random(5);
  const std::vector<sliding_identification::SlidingRecord> records{
      sliding_identification::sliding_record(dwell_record({}, {}, random))};
  sliding_identification::SlidingPoint start = sliding_identification::SlidingPoint::Zero();
  start[sliding_identification::log_inertia] = -800.0;  // underflows
  start[sliding_identification::viscous_damping] = 1.0;
  sliding_identification::FreeParameters free{};
  free[sliding_identification::log_inertia] = true;
  ::testing::internal::CaptureStderr();
  EXPECT_THROW(sliding_identification::fit_sliding(records, start, free), Failure);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace zerocount::testing
