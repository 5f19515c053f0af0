#include "tests/core/batch/reversal_depths.hpp"

#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "core/plant/plant.hpp"
#include "core/trial/machine.hpp"
#include "core/trial/trial.hpp"

namespace zerocount::testing {
namespace {

/// A torque and the duration for which it is held.
struct HeldTorque {
  double torque;    ///< torque, N m
  double duration;  ///< duration, s
};

/// [move][sample] the torques of a trial that run_trial() simulates, each held for one sample.
std::vector<std::vector<HeldTorque>> torques_of(const trial::TrialParameters& parameters) {
  std::vector<std::vector<HeldTorque>> moves;
  std::int64_t remaining = 0;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) {
    if (remaining == 0) {
      remaining = trial::samples_of_move(parameters, moves.size());
      moves.emplace_back();
    }
    --remaining;
    moves.back().push_back({sample.drive_torque, 1.0 / parameters.controller.sample_rate});
  };
  trial::run_trial(parameters, observers);
  return moves;
}

std::vector<HeldTorque> joined(const std::vector<HeldTorque>& holds) {
  std::vector<HeldTorque> longer;
  for (const HeldTorque& hold : holds) {
    if (!longer.empty() && longer.back().torque == hold.torque) {
      longer.back().duration += hold.duration;
    } else {
      longer.push_back(hold);
    }
  }
  return longer;
}

std::vector<HeldTorque> cut(const std::vector<HeldTorque>& holds, std::mt19937_64& random) {
  std::vector<HeldTorque> pieces;
  for (const HeldTorque& hold : holds) {
    double rest = hold.duration;
    for (int i = 0; i < 2; ++i) {
      const double piece = rest * 0x1p-64 * static_cast<double>(random());
      pieces.push_back({hold.torque, piece});
      rest -= piece;
    }
    pieces.push_back({hold.torque, rest});
  }
  return pieces;
}

}  // namespace

bool reversal_depth_changes_with_steps(const trial::TrialParameters& parameters) {
  const std::vector<trial::MoveOutcome> moves = trial::run_trial(parameters).moves;
  const std::vector<std::vector<HeldTorque>> torques = torques_of(parameters);
  const double resolution = 2.0 * std::numbers::pi / parameters.encoder.fine;
  std::mt19937_64 random(1);
  for (const double factor : {1.0, 0.1, 3.0, 10.0, 0.3}) {
    for (int time = 0; time < 4; ++time) {
      motion::MotionTolerance tolerance = trial::motion_tolerance(resolution);
      tolerance.elongation *= factor;
      plant::Plant plant(parameters.plant, parameters.friction, trial::plant_start(parameters), tolerance);
      for (std::size_t m = 0; m < torques.size(); ++m) {
        plant.forget_deepest();
        for (const HeldTorque& hold : time == 0 ? joined(torques[m]) : cut(torques[m], random))
          plant.advance(motion::constant_torque(hold.torque), hold.duration);
        if (plant.deepest() != moves[m].reversal_depth) return true;
      }
    }
  }
  return false;
}

}  // namespace zerocount::testing
