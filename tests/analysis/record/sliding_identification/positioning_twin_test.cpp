// Inertia and sliding friction of a synthetic twin of the EMPS benchmark: its loop, rate, motion and
// resolution.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "analysis/record/sliding_identification/sliding_identification.hpp"
#include "core/failure/failure.hpp"
#include "tests/analysis/record/sliding_identification/records.hpp"

namespace zerocount::testing {
namespace {

using fit::EstimateStatus;
using fit::ParameterEstimate;
using sliding_identification::SlidingIdentification;

SlidingIdentification identified(const records::RawSeries& series) {
  return sliding_identification::identify_sliding({sliding_identification::sliding_record(series)});
}

const ParameterEstimate& parameter(const SlidingIdentification& found, const std::string& name) {
  return *std::find_if(found.parameters.begin(), found.parameters.end(),
                       [&](const ParameterEstimate& one) { return one.name == name; });
}

TEST(PositioningTwin, RecoversThePublishedParameters) {
  std::mt19937_64 random(1);
  const SlidingAxis truth;
  const SlidingIdentification found = identified(closed_loop_record(truth, {}, emps_lap(), 4, random));
  const std::pair<const char*, double> truths[] = {{"inertia", truth.mass},
                                                   {"sliding_damping", truth.damping},
                                                   {"coulomb_level", truth.coulomb},
                                                   {"offset", truth.offset}};
  for (const auto& [name, value] : truths) {
    const ParameterEstimate& estimate = parameter(found, name);
    ASSERT_EQ(estimate.status, EstimateStatus::estimated) << name;
    EXPECT_NEAR(estimate.value / value, 1.0, 1e-3) << name;
    EXPECT_LT(std::abs(estimate.value - value), 4.0 * estimate.standard_error) << name;
  }
  EXPECT_EQ(parameter(found, "stribeck_velocity").status, EstimateStatus::not_identifiable);
  EXPECT_EQ(found.records[0].axis, parameters::AxisKind::linear);
}

TEST(PositioningTwin, ShowsItsStribeckCurve) {
  std::mt19937_64 random(2);
  SlidingAxis truth;
  truth.breakaway = 28.0;
  truth.stribeck_velocity = 0.02;
  const SlidingIdentification found = identified(closed_loop_record(truth, {}, emps_lap(), 2, random));
  const std::pair<const char*, double> truths[] = {{"inertia", truth.mass},
                                                   {"sliding_damping", truth.damping},
                                                   {"coulomb_level", truth.coulomb},
                                                   {"breakaway_level", truth.breakaway},
                                                   {"coulomb_ratio", truth.coulomb / truth.breakaway},
                                                   {"stribeck_velocity", truth.stribeck_velocity}};
  for (const auto& [name, value] : truths) {
    const ParameterEstimate& estimate = parameter(found, name);
    ASSERT_EQ(estimate.status, EstimateStatus::estimated) << name << ": " << estimate.reason;
    EXPECT_NEAR(estimate.value / value, 1.0, 5e-3) << name;
  }
}

// In one direction an offset is part of the Coulomb level; records of both directions tell them apart.
TEST(PositioningTwin, IsFoundOverSeveralRecordsAndOneDirection) {
  std::mt19937_64 random(3);
  const SlidingAxis truth;
  const std::vector<Cruise> forward{{0.0417, 0.35}, {0.1228, 0.6}, {0.0813, 0.4}};
  const records::RawSeries series = closed_loop_record(truth, {}, forward, 1, random);
  const SlidingIdentification found = identified(series);
  EXPECT_EQ(parameter(found, "offset").status, EstimateStatus::not_identifiable);
  // An offset of any size would give the same record: their sum is all that it tells.
  EXPECT_EQ(parameter(found, "coulomb_level").status, EstimateStatus::not_identifiable);
  EXPECT_NE(parameter(found, "coulomb_level").reason.find("together they are 17.2"), std::string::npos)
      << parameter(found, "coulomb_level").reason;
  EXPECT_NE(reason_of_distrust(found).find("the motion has one direction"), std::string::npos);
  EXPECT_NEAR(parameter(found, "inertia").value / truth.mass, 1.0, 1e-3);

  const std::vector<Cruise> backward{{-0.0417, 0.35}, {-0.1228, 0.6}, {-0.0813, 0.4}};
  const SlidingIdentification both = sliding_identification::identify_sliding(
      {sliding_identification::sliding_record(series),
       sliding_identification::sliding_record(closed_loop_record(truth, {}, backward, 1, random))});
  EXPECT_NEAR(parameter(both, "coulomb_level").value, truth.coulomb, 1e-2);
  EXPECT_NEAR(parameter(both, "offset").value, truth.offset, 1e-2);
  EXPECT_EQ(both.records.size(), 2u);
}

TEST(PositioningTwin, AWrongSignIsReported) {
  std::mt19937_64 random(4);
  records::RawSeries series = closed_loop_record({}, {}, emps_lap(), 1, random);
  for (double& force : series.torque) force = -force;
  try {
    identified(series);
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_data);
    EXPECT_NE(std::string(failure.what()).find("motion.csv: the axis accelerates against the torque"),
              std::string::npos)
        << failure.what();
  }
}

// From an inertia of e⁻⁸⁰⁰, which underflows to 0, there is no motion to fit.
TEST(PositioningTwin, AFailedFitIsReported) {
  std::mt19937_64 random(7);
  const std::vector<sliding_identification::SlidingRecord> records{
      sliding_identification::sliding_record(closed_loop_record({}, {}, emps_lap(), 1, random))};
  sliding_identification::SlidingPoint start = sliding_identification::SlidingPoint::Zero();
  start[sliding_identification::log_inertia] = -800.0;
  start[sliding_identification::viscous_damping] = 1.0;
  sliding_identification::FreeParameters free{};
  free[sliding_identification::log_inertia] = true;
  try {
    sliding_identification::fit_sliding(records, start, free);
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_data);
    EXPECT_NE(std::string(failure.what()).find("motion.csv: the simulated motion cannot be fitted"),
              std::string::npos)
        << failure.what();
  }
}

TEST(PositioningTwin, ARecordWithoutSlidingIsReported) {
  std::mt19937_64 random(5);
  records::RawSeries series = closed_loop_record({}, {}, emps_lap(), 1, random);
  for (std::size_t k = 0; k < series.torque.size(); ++k)
    series.torque[k] += 4000.0 * series.angle[k];  // a spring
  EXPECT_THROW(identified(series), Failure);
  for (double& position : series.angle) position *= 1e-6;
  for (double& position : series.angle) position = 5e-8 * std::floor(position / 5e-8);
  try {
    identified(series);
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_NE(std::string(failure.what()).find("shows no sliding"), std::string::npos) << failure.what();
  }
}

// What the record shows goes into a manifest, and every number reads back.
TEST(PositioningTwin, ReportNamesItsParameters) {
  std::mt19937_64 random(6);
  SlidingAxis truth;
  truth.breakaway = 28.0;
  const SlidingIdentification found = identified(closed_loop_record(truth, {}, emps_lap(), 1, random));
  const std::string& fragment = found.fragment;
  for (const char* line :
       {"axis: linear\n", "plant:\n", "  inertia: {lognormal: {median: 95.1", "  sliding_damping: ",
        "friction:\n", "  breakaway: ", "  coulomb_ratio: {truncated_normal: ", "  stribeck_velocity: "}) {
    EXPECT_NE(fragment.find(line), std::string::npos) << line << fragment;
  }
  const auto json = document::json(sliding_identification::sliding_answer().of(found));
  EXPECT_EQ(json["kind"], "sliding");
  EXPECT_EQ(json["parameters"][0]["value"].get<double>(), found.parameters[0].value);
  EXPECT_EQ(json["correlation"]["matrix"].size(), 6u);
  EXPECT_NEAR(json["correlation"]["matrix"][2][2].get<double>(), 1.0, 1e-12);
  EXPECT_EQ(json["manifest"], fragment);

  const SlidingIdentification without = identified(closed_loop_record({}, {}, emps_lap(), 1, random));
  EXPECT_NE(without.fragment.find("  coulomb_ratio: 1 "), std::string::npos);
}

}  // namespace
}  // namespace zerocount::testing
