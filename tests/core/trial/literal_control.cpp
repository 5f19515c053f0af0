#include <algorithm>
#include <cmath>

#include "tests/core/trial/literal_trial.hpp"

namespace zerocount::testing {
namespace {

using Real = long double;
using Samples = std::vector<trial::SampleRecord>;

/// Error and count of each sample, in fine counts, as one control law receives them from its encoder.
struct LiteralFeedback {
  std::vector<Real> error;
  std::vector<Real> count;
  Real error_before(std::size_t k) const { return k == 0 ? 0 : error[k - 1]; }
  Real first_change{0};  ///< change of count at sample 0, for a motion at the initial velocity
  Real count_change(std::size_t k) const { return k == 0 ? first_change : count[k] - count[k - 1]; }
};

/// Change of the encoder count from sample −1 to sample 0 for a rotor that moves at the velocity v₀: ⌊θ₀/Δx +
/// phase⌋ − ⌊(θ₀ − v₀·T)/Δx + phase⌋.
Real first_change(const trial::TrialParameters& p, Real theta, Real resolution) {
  const Real phase = p.initial.encoder_phase;
  const Real before = theta - static_cast<Real>(p.initial.velocity) / p.controller.sample_rate;
  return std::floor(theta / resolution + phase) - std::floor(before / resolution + phase);
}

LiteralFeedback feedback_by(loop::EncoderChoice encoder, const trial::TrialParameters& p,
                            const Samples& samples) {
  const Real fine_per_coarse = static_cast<Real>(p.encoder.fine) / p.encoder.coarse;
  LiteralFeedback feedback;
  for (const trial::SampleRecord& sample : samples) {
    feedback.count.push_back(encoder == loop::EncoderChoice::fine
                                 ? static_cast<Real>(sample.count)
                                 : static_cast<Real>(sample.coarse_count) * fine_per_coarse);
    feedback.error.push_back(static_cast<Real>(sample.reference) - feedback.count.back());
  }
  const bool is_fine = encoder == loop::EncoderChoice::fine;
  const Real resolution = is_fine ? static_cast<Real>(p.encoder.fine_length) / p.encoder.fine
                                  : static_cast<Real>(p.encoder.coarse_length) / p.encoder.coarse;
  feedback.first_change = (is_fine ? 1 : fine_per_coarse) * first_change(p, 0, resolution);
  return feedback;
}

std::vector<loop::ControlPhase> phases(const trial::TrialParameters& p, const LiteralFeedback& fine,
                                       const LiteralFeedback& coarse) {
  const loop::CoarsePhaseParameters& rule = p.controller.coarse;
  const auto dwell = static_cast<std::size_t>(
      std::max(1LL, std::llround(rule.fine_dwell * p.controller.sample_rate)));  // samples
  const auto settled = [&](std::size_t k) {
    return std::abs(coarse.error[k]) <= rule.fine_within &&
           std::abs(coarse.count_change(k)) <= rule.fine_rate;
  };
  std::vector<loop::ControlPhase> phase;
  std::size_t entered = 0;  // the sample since which the phase is the coarse one
  for (std::size_t k = 0; k < fine.error.size(); ++k) {
    if (k == 0 || phase.back() == loop::ControlPhase::fine) {
      const bool beyond = std::abs(fine.error[k]) > rule.coarse_beyond;
      if (beyond) entered = k;
      phase.push_back(beyond ? loop::ControlPhase::coarse : loop::ControlPhase::fine);
      continue;
    }
    bool ready = k + 1 >= entered + dwell;
    for (std::size_t j = k + 1 - dwell; ready && j <= k; ++j) ready = settled(j);
    phase.push_back(ready ? loop::ControlPhase::fine : loop::ControlPhase::coarse);
  }
  return phase;
}

}  // namespace

std::vector<LiteralDecision> literal_decisions(const trial::TrialParameters& p, const Samples& samples) {
  const loop::ControllerParameters& c = p.controller;
  const bool two_phases = std::isfinite(c.coarse.coarse_beyond);
  const LiteralFeedback fine = feedback_by(c.encoder, p, samples);
  const LiteralFeedback coarse = feedback_by(c.coarse.encoder, p, samples);
  const std::vector<loop::ControlPhase> phase =
      two_phases ? phases(p, fine, coarse)
                 : std::vector<loop::ControlPhase>(samples.size(), loop::ControlPhase::fine);
  const Real lowest = -std::ldexp(Real{1}, p.dac.bits - 1) * p.dac.resolution;
  const Real highest = (std::ldexp(Real{1}, p.dac.bits - 1) - 1) * p.dac.resolution;
  std::vector<LiteralDecision> decisions;
  Real integral = p.initial.integral;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool in_fine = phase[k] == loop::ControlPhase::fine;
    const LiteralFeedback& now = in_fine ? fine : coarse;
    const Real kp = in_fine ? c.kp : c.coarse.kp;
    const Real ki = in_fine ? c.ki : c.coarse.ki;
    const Real kd = in_fine ? (two_phases ? 0.0 : c.kd) : c.coarse.kd;
    if (k > 0 && phase[k] != phase[k - 1])
      integral = static_cast<Real>(samples[k - 1].code) * p.dac.resolution;
    integral += ki * (now.error[k] + now.error_before(k));
    if (c.anti_windup == loop::AntiWindup::clamp) integral = std::clamp(integral, lowest, highest);
    decisions.push_back({phase[k], integral, integral + kp * now.error[k] - kd * now.count_change(k)});
  }
  return decisions;
}

}  // namespace zerocount::testing
