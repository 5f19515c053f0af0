// The motion over a window: that of core's Plant, and its derivatives.
#include <array>
#include <cmath>

#include <ceres/cost_function.h>
#include <gtest/gtest.h>

#include "analysis/record/sliding_identification/sliding_record.hpp"
#include "core/plant/plant.hpp"

namespace zerocount::testing {
namespace {

using sliding_identification::sliding_dimension;
using sliding_identification::SlidingPoint;
using sliding_identification::SlidingRecord;
using sliding_identification::Window;

constexpr double inertia = 0.02;
constexpr double coulomb = 0.4;
constexpr double damping = 0.05;
constexpr double offset = 0.03;
constexpr double excess = 0.15;
constexpr double stribeck_velocity = 0.5;

SlidingPoint point_of_motion() {
  SlidingPoint point = SlidingPoint::Zero();
  point.head<sliding_identification::position_amplitudes>() << std::log(inertia), coulomb, damping, offset,
      excess, std::log(stribeck_velocity);
  return point;
}

/// A made-up record of 200 samples under a wavy torque; behind an amplifier of bandwidth `rate` if it is not
/// 0. Torques that depend on the position have a given shape at each sample; their amplitudes are parameters
/// of the model.
SlidingRecord wavy_record(double direction, double rate) {
  SlidingRecord record;
  for (int k = 0; k < 200; ++k) {
    record.time.push_back(1e-3 * k);
    const double torque = direction * (0.6 + 0.1 * std::sin(0.05 * k));
    record.torque.push_back({torque, rate > 0.0 ? torque + 0.02 : torque, rate});
    auto& shape = record.shape.emplace_back();
    auto& between = record.shape_between.emplace_back();
    for (std::size_t term = 0; term < shape.size(); ++term) {
      shape[term] = std::sin(0.01 * k * static_cast<double>(term + 1));
      between[term] = std::sin(0.01 * (k + 0.5) * static_cast<double>(term + 1));
    }
  }
  record.position.assign(200, 0.0);
  record.resolution = 1.0;
  record.waves = sliding_identification::max_position_waves;
  return record;
}

/// Parameters from which a motion is simulated: those of the friction model, then initial position and
/// velocity.
using MotionStart = Eigen::Matrix<double, sliding_dimension + 2, 1>;

/// The simulated positions in a window of a record whose readings are all 0, and their derivatives with
/// respect to the parameters.
struct WindowMotion {
  Eigen::VectorXd position;
  Eigen::MatrixXd slopes;
};

WindowMotion window_motion(const SlidingRecord& record, const Window& window, const MotionStart& start) {
  const auto residuals = window_residuals(record, window);
  Eigen::VectorXd position(residuals->num_residuals());
  Eigen::Matrix<double, Eigen::Dynamic, sliding_dimension, Eigen::RowMajor> by_point(position.size(),
                                                                                     sliding_dimension);
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> by_start(position.size(), 2);
  const std::array parameters{start.data(), start.data() + sliding_dimension};
  std::array jacobians{by_point.data(), by_start.data()};
  EXPECT_TRUE(residuals->Evaluate(parameters.data(), position.data(), jacobians.data()));
  Eigen::MatrixXd slopes(position.size(), sliding_dimension + 2);
  slopes << by_point, by_start;
  return {position, slopes};
}

MotionStart start_of_motion(double position, double velocity) {
  MotionStart start;
  start << point_of_motion(), position, velocity;
  return start;
}

TEST(SlidingMotion, EqualsThePlant) {
  for (const double direction : {-1.0, 1.0}) {
    for (const double rate : {0.0, 500.0}) {
      const SlidingRecord record = wavy_record(direction, rate);
      const WindowMotion motion =
          window_motion(record, {0, 199, 0, direction}, start_of_motion(0.0, direction * 0.2));
      motion::PlantParameters plant;
      plant.inertia = inertia;
      plant.sliding_damping = damping;
      friction::FrictionAlongRotor friction;
      friction.model = friction::FrictionModel::coulomb;
      friction.uniform.breakaway = coulomb + excess;
      friction.uniform.coulomb_ratio = coulomb / (coulomb + excess);
      friction.uniform.stribeck_velocity = stribeck_velocity;
      motion::PlantStart start;
      start.velocity = direction * 0.2;
      plant::Plant judge(plant, friction, start, {1e-13});
      for (std::size_t k = 0; k < 200; ++k) {
        ASSERT_NEAR(motion.position[static_cast<Eigen::Index>(k)], judge.theta(), 5e-9) << k;
        motion::TorqueCourse course = record.torque[k];
        course.now -= offset;
        course.settled -= offset;
        judge.advance(course, 1e-3);
      }
    }
  }
}

TEST(SlidingMotion, DerivativesEqualDifferencesOfTheMotion) {
  const SlidingRecord record = wavy_record(1.0, 0.0);
  const Window window{3, 180, 0, 1.0};
  MotionStart start = start_of_motion(0.1, 0.3);
  start.segment<sliding_identification::position_terms>(sliding_identification::position_amplitudes)
      .setConstant(0.005);
  const WindowMotion motion = window_motion(record, window, start);
  for (Eigen::Index column = 0; column < start.size(); ++column) {
    const MotionStart step = 1e-5 * MotionStart::Unit(column);
    const Eigen::VectorXd judge = (window_motion(record, window, start + step).position -
                                   window_motion(record, window, start - step).position) /
                                  2e-5;
    const Eigen::VectorXd off = motion.slopes.col(column) - judge;
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-6 * judge.cwiseAbs().maxCoeff() + 1e-10) << column;
  }
}

}  // namespace
}  // namespace zerocount::testing
