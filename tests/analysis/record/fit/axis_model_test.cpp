// The model's path along a record: the same as core's Plant sample by sample, and its derivatives.
#include <gtest/gtest.h>

#include "analysis/record/fit/model.hpp"
#include "core/plant/plant.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

Eigen::VectorXd contact_path(const fit::TestRecord& record, const fit::ContactParameters& contact,
                             double offset = 0.0) {
  constexpr double creep_torque = 0.1;
  fit::Point point = fit::point_of(contact, creep_torque);
  point[fit::time_offset] = offset;
  return fit::modelled_path(record, fit::contact_model(creep_torque), point);
}

Eigen::VectorXd sample_by_sample(const fit::TestRecord& record, const fit::ContactParameters& contact) {
  Eigen::VectorXd path(static_cast<Eigen::Index>(fit::sample_count(record)));
  plant::Plant plant(contact.plant, {contact.friction, {}}, record.start, {1e-11 * record.unit});
  for (std::size_t k = 0; k < fit::sample_count(record); ++k) {
    path[static_cast<Eigen::Index>(k)] = plant.theta() / record.unit;
    plant.advance(record.torque[k], record.sample_time);
  }
  return path;
}

TEST(RecordMotion, EqualsThePlantForAnyHold) {
  std::mt19937_64 random(21);
  for (int round = 0; round < 6; ++round) {
    const fit::ContactParameters contact = random_contact(random);
    TorqueProgramme holds;
    holds.ramp(0.1, 0.2).hold(3.0).ramp(-0.1, 0.2).step(0.15).hold(2.0).ramp(0.14, 0.2).hold(1.0);
    std::vector<TorqueProgramme> programmes = three_tests();
    programmes.push_back(holds);
    for (const TorqueProgramme& programme : programmes) {
      const fit::TestRecord record = simulated_test(contact, programme, {}, random);
      const Eigen::VectorXd off = contact_path(record, contact) - sample_by_sample(record, contact);
      EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-2) << round;
    }
  }
}

// Uneven instants, all of them on a grid ten times as fine. A torque that is late gives the same readings
// later.
TEST(RecordMotion, UnevenSamplesAreEvaluatedAtTheirInstants) {
  std::mt19937_64 random(24);
  const fit::ContactParameters contact = random_contact(random);
  const fit::TestRecord even = simulated_test(contact, one_test().front(), {}, random);
  fit::TestRecord uneven = even;
  fit::TestRecord fine = even;
  fine.sample_time = 0.1 * even.sample_time;
  fine.torque.clear();
  std::vector<Eigen::Index> instants;
  for (const motion::TorqueCourse& torque : even.torque) {
    const int steps = std::uniform_int_distribution<int>(2, 17)(random);
    instants.push_back(static_cast<Eigen::Index>(fine.torque.size()));
    uneven.intervals.push_back(steps * fine.sample_time);
    fine.torque.insert(fine.torque.end(), static_cast<std::size_t>(steps), torque);
  }
  fine.reading.assign(fine.torque.size(), 0.0);
  const Eigen::VectorXd judge = sample_by_sample(fine, contact);
  for (const int late : {0, 3, 14, -4}) {  // steps of the grid; the test begins at rest
    const Eigen::VectorXd path = contact_path(uneven, contact, 0.1 * late);
    for (std::size_t k = 0; k < instants.size(); ++k) {
      const Eigen::Index at = std::clamp<Eigen::Index>(instants[k] - late, 0, judge.size() - 1);
      ASSERT_NEAR(path[static_cast<Eigen::Index>(k)], judge[at], 1e-4) << k << " " << late;
    }
  }
}

/// The simulated rotor angle θ (in the record's unit) at every sample, for a torque that acts `delay` samples
/// late, 0 to 1. Each sampling interval is split at the delayed change of the torque.
Eigen::VectorXd with_late_torque(const fit::TestRecord& record, const fit::ContactParameters& contact,
                                 double delay) {
  Eigen::VectorXd path(static_cast<Eigen::Index>(fit::sample_count(record)));
  plant::Plant plant(contact.plant, {contact.friction, {}}, record.start, {1e-11 * record.unit});
  const auto last = static_cast<double>(record.torque.size() - 1);
  const auto torque_at = [&](double sample) {
    return sample < 0.0 ? motion::constant_torque(0.0)
                        : record.torque[static_cast<std::size_t>(std::min(sample, last))];
  };
  const double before = (delay - std::floor(delay)) * record.sample_time;
  for (std::size_t k = 0; k < fit::sample_count(record); ++k) {
    path[static_cast<Eigen::Index>(k)] = plant.theta() / record.unit;
    const double newest = static_cast<double>(k) - std::floor(delay);
    if (before > 0.0) plant.advance(torque_at(newest - 1.0), before);
    plant.advance(torque_at(newest), record.sample_time - before);
  }
  return path;
}

// The path samples the response at other instants; here the torque changes at other instants.
TEST(RecordMotion, ATimeOffsetSplitsTheSampleInterval) {
  std::mt19937_64 random(26);
  for (const double delay : {0.1, 0.5, 1.0, 1.7, -0.4, -1.0, -2.0}) {
    const fit::ContactParameters contact = random_contact(random);
    TorqueProgramme test;
    // At rest as long as the torque may be early.
    test.hold(0.01).step(0.08).hold(0.3).ramp(0.1, 0.4).hold(3.0).ramp(-0.1, 0.4).step(0.05).hold(1.0);
    fit::TestRecord record = simulated_test(contact, test, {}, random);
    const Eigen::VectorXd expected = with_late_torque(record, contact, delay);
    const auto off = [&](double offset) {
      return (contact_path(record, contact, offset) - expected).cwiseAbs().maxCoeff();
    };
    EXPECT_LT(off(delay), 1e-2) << delay;
    EXPECT_GT(off(delay + 0.05), 0.1) << delay;
    if (delay <= 0.0) continue;
    record.delay_fraction = 0.1;  // given, and the rest is the offset
    EXPECT_LT(off(delay - 0.1), 1e-2) << delay;
  }
}

TEST(RecordMotion, StartsFromTheGivenContactState) {
  std::mt19937_64 random(22);
  const fit::ContactParameters contact = random_contact(random);
  fit::TestRecord record = simulated_test(contact, three_tests()[2], {}, random);
  record.start.preload = 0.2;
  record.start.hardening = 3e-4;
  const Eigen::VectorXd path = contact_path(record, contact);
  EXPECT_LT((path - sample_by_sample(record, contact)).cwiseAbs().maxCoeff(), 1e-2);
  record.start = {};
  EXPECT_GT((path - sample_by_sample(record, contact)).cwiseAbs().maxCoeff(), 10.0);
}

TEST(RecordMotion, DerivativesEqualDifferencesOfThePath) {
  std::mt19937_64 random(23);
  const fit::ContactParameters contact = random_contact(random);
  constexpr double creep_torque = 0.1;
  const fit::Point point = fit::point_of(contact, creep_torque);
  const fit::FitModel model = fit::contact_model(creep_torque);
  for (const TorqueProgramme& programme : three_tests()) {
    const fit::TestRecord record = simulated_test(contact, programme, {}, random);
    fit::FreeCoordinates free(fit::coordinate_count, true);
    free[fit::log_beta] = false;
    const fit::RecordMotion motion = fit::modelled_motions({&record, 1}, model, point, free).front();
    for (std::size_t j = 0; j < fit::coordinate_count; ++j) {
      const auto column = motion.sensitivity.col(static_cast<Eigen::Index>(j));
      if (!free[j]) {
        EXPECT_EQ(column.cwiseAbs().maxCoeff(), 0.0);
        continue;
      }
      // Central differences over a hundred times the step.
      fit::Point up = point;
      fit::Point down = point;
      up[static_cast<Eigen::Index>(j)] += 1e-4;
      down[static_cast<Eigen::Index>(j)] -= 1e-4;
      const Eigen::VectorXd expected =
          (fit::modelled_path(record, model, up) - fit::modelled_path(record, model, down)) / 2e-4;
      const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
      EXPECT_LT((column - expected).norm(), 1e-2 * expected.norm() + 1e-3)
          << fit::coordinate_keys[j] << scale;
    }
  }
}

// A step of a search knows the paths before it asks for the derivatives.
TEST(RecordMotion, DerivativesFromKnownPathsAreEqual) {
  std::mt19937_64 random(25);
  constexpr double creep_torque = 0.1;
  const fit::TestRecord record = simulated_test(random_contact(random), three_tests()[1], {}, random);
  for (const bool with_offset : {false, true}) {
    const fit::Point point = fit::point_of(random_contact(random), creep_torque);
    fit::FreeCoordinates free(fit::coordinate_count, true);
    free[fit::time_offset] = with_offset;
    fit::FreeCoordinates offset_alone(fit::coordinate_count, false);
    offset_alone[fit::time_offset] = with_offset;
    const fit::FitModel model = fit::contact_model(creep_torque);
    const std::vector<fit::RecordMotion> all = fit::modelled_motions({&record, 1}, model, point, free);
    const std::int64_t samples_of_all = model.simulated->exchange(0);
    std::vector<fit::RecordMotion> paths = fit::modelled_motions({&record, 1}, model, point, offset_alone);
    EXPECT_EQ(model.simulated->load(), fit::samples_of_paths({&record, 1}, model, point));
    const std::vector<fit::RecordMotion> after =
        fit::modelled_motions({&record, 1}, model, point, free, std::move(paths));
    EXPECT_EQ(model.simulated->load(), samples_of_all);
    EXPECT_TRUE(after.front().path == all.front().path);
    EXPECT_TRUE(after.front().sensitivity == all.front().sensitivity);
  }
}

TEST(RecordMotion, CoordinatesAndParametersConvertBothWays) {
  std::mt19937_64 random(24);
  const fit::ContactParameters contact = random_contact(random);
  for (const double creep_torque : {0.05, 1.0}) {
    const fit::ContactParameters back = fit::contact_at(fit::point_of(contact, creep_torque), creep_torque);
    for (const std::string name :
         {"k1", "k2", "beta", "presliding_damping", "inertia", "alpha", "lambda", "n"}) {
      EXPECT_NEAR(true_value(back, name) / true_value(contact, name), 1.0, 1e-12) << name;
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
