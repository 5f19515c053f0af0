// How often the 95 % intervals hold the truth, over simulated motion records.
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "tests/analysis/record/sliding_identification/coverage.hpp"
#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

struct SlidingCoverage {
  int held{0};
  int estimated{0};
};

using CoverageOf = std::map<std::string, SlidingCoverage>;

double factor(std::mt19937_64& random) {
  return std::exp2(std::uniform_real_distribution<double>(-1.0, 1.0)(random));
}

/// A random axis with a Stribeck curve, each of whose parameters is half to twice that of the EMPS benchmark.
SlidingAxis random_axis(std::mt19937_64& random) {
  SlidingAxis axis;
  axis.mass *= factor(random);
  axis.damping *= factor(random);
  axis.coulomb *= factor(random);
  axis.offset *= factor(random);
  axis.breakaway = axis.coulomb * std::uniform_real_distribution<double>(1.2, 1.6)(random);
  axis.stribeck_velocity = 0.015 * factor(random);
  return axis;
}

CoverageOf coverage(int axes,
                    const std::function<records::RawSeries(std::mt19937_64&, SlidingAxis&)>& record) {
  CoverageOf coverage;
  for (int i = 0; i < axes; ++i) {
    std::mt19937_64 random(static_cast<std::uint64_t>(i) + 1000);
    SlidingAxis axis = random_axis(random);
    const records::RawSeries series = record(random, axis);
    const auto found =
        sliding_identification::identify_sliding({sliding_identification::sliding_record(series)});
    const std::map<std::string, double> truths{{"inertia", axis.mass},
                                               {"sliding_damping", axis.damping},
                                               {"coulomb_level", axis.coulomb},
                                               {"breakaway_level", axis.breakaway},
                                               {"coulomb_ratio", axis.coulomb / axis.breakaway},
                                               {"stribeck_velocity", axis.stribeck_velocity},
                                               {"offset", axis.offset}};
    for (const auto& parameter : found.parameters) {
      if (parameter.status != fit::EstimateStatus::estimated) continue;
      SlidingCoverage& count = coverage[parameter.name];
      ++count.estimated;
      const double truth = truths.at(parameter.name);
      count.held += parameter.low <= truth && truth <= parameter.high ? 1 : 0;
    }
  }
  return coverage;
}

void expect_coverage(const CoverageOf& coverage, int axes, const std::string& what) {
  int held = 0;
  int estimated = 0;
  for (const auto& [name, count] : coverage) {
    EXPECT_GE(count.held, least_expected(count.estimated))
        << what << ": " << name << " of " << count.estimated;
    EXPECT_GE(count.estimated, axes * 8 / 10) << what << ": " << name;
    held += count.held;
    estimated += count.estimated;
  }
  EXPECT_GE(held, least_expected(estimated)) << what;
}

void expect_coverage_in_closed_loops(int axes) {
  expect_coverage(
      coverage(axes, [](std::mt19937_64& random,
                        SlidingAxis& axis) { return closed_loop_record(axis, {}, emps_lap(), 1, random); }),
      axes, "closed loop");
}

// Forces that the record does not show, correlated in time, fed back by the loop.
void expect_coverage_with_unknown_forces(int axes) {
  expect_coverage(coverage(axes,
                           [](std::mt19937_64& random, SlidingAxis& axis) {
                             axis.friction_noise = 0.01 * axis.coulomb;
                             return closed_loop_record(axis, {}, emps_lap(), 2, random);
                           }),
                  axes, "unknown forces");
}

void expect_coverage_of_coarse_readings(int axes) {
  expect_coverage(coverage(axes,
                           [](std::mt19937_64& random, SlidingAxis& axis) {
                             AxisLoop loop;
                             loop.resolution = 1e-6;
                             loop.noise = 1e-6;
                             loop.velocity_gain = 60.0;
                             return closed_loop_record(axis, loop, emps_lap(), 2, random);
                           }),
                  axes, "coarse");
}

void expect_coverage_in_open_loops(int axes) {
  expect_coverage(coverage(axes, [](std::mt19937_64& random,
                                    SlidingAxis& axis) { return open_loop_record(axis, {}, 6.0, random); }),
                  axes, "open loop");
}

TEST(SlidingCoverage, IntervalsCoverInClosedLoopRecords) {
  expect_coverage_in_closed_loops(12);
}

TEST(SlidingCoverage, IntervalsCoverWithUnknownForces) {
  expect_coverage_with_unknown_forces(2);
}

TEST(SlidingCoverage, IntervalsCoverInCoarseNoisyRecords) {
  expect_coverage_of_coarse_readings(12);
}

TEST(SlidingCoverage, IntervalsCoverInOpenLoopRecords) {
  expect_coverage_in_open_loops(12);
}

TEST(SlidingCoverage, DISABLED_IntervalsCoverInManyRecords) {
  expect_coverage_in_closed_loops(60);
  expect_coverage_with_unknown_forces(50);
  expect_coverage_of_coarse_readings(60);
  expect_coverage_in_open_loops(60);
}

}  // namespace
}  // namespace zerocount::testing
