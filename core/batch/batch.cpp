#include "core/batch/batch.hpp"

#include "core/batch/lane_work.hpp"
#include "core/loop/controller.hpp"
#include "core/loop/dac.hpp"

namespace zerocount {
namespace {

constexpr int longest_delay = 64;

bool ideal(const EncoderErrors& e) {
  return e.eccentricity == 0.0 && e.interpolation == 0.0 && e.noise == 0.0 && e.missed == 0.0;
}

bool lanes_have(FrictionModel model) {
  switch (model) {
    case FrictionModel::presliding:
    case FrictionModel::spring:
      return true;
    case FrictionModel::coulomb:
    case FrictionModel::none:
      break;
  }
  return false;
}

}  // namespace

bool runs_in_lanes(const TrialParameters& p) {
  const bool plain_loop = p.command.torque.levels.empty() && !p.command.targets.empty() &&
                          p.command.profile.shape == ReferenceShape::step &&
                          !has_coarse_phase(p.controller) && p.controller.encoder == EncoderChoice::fine &&
                          p.controller.delay <= longest_delay;
  const bool plain_devices = ideal(p.encoder.fine_errors) && ideal(p.encoder.coarse_errors) &&
                             !has_errors(p.dac) && p.amplifier.bandwidth == 0.0;
  return plain_loop && plain_devices && lanes_have(p.friction.model) && samples_of_move(p, 0) > 0;
}

BatchEngine::BatchEngine(const BatchSettings& settings)
    : work_(std::make_unique<batch::LaneWork>(settings)) {}
BatchEngine::~BatchEngine() = default;

void BatchEngine::run(std::span<const TrialParameters* const> trials, std::span<TrialOutcome> outcomes,
                      const BatchObservers& observers) {
  work_->run(trials, outcomes, observers);
}

}  // namespace zerocount
