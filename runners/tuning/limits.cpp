#include "runners/tuning/limits.hpp"

#include <algorithm>

#include "core/loop/controller.hpp"

namespace zerocount::tuning {
namespace {

// Causes of failures. A finer encoder keeps the motion, the gains in physical units, and the goal: an error
// of up to b counts is one of up to 4b + 2 of the finer ones.

void without_creep(trial::TrialParameters& p) {
  p.friction.uniform.alpha = 0.0;
  std::erase_if(p.friction.profiled,
                [](const auto& one) { return one.parameter == &friction::FrictionParameters::alpha; });
  std::erase_if(p.friction.per_contact,
                [](const auto& one) { return one.parameter == &friction::FrictionParameters::alpha; });
}

void with_finer_converter(trial::TrialParameters& p) {
  p.dac.resolution /= 16.0;
  p.dac.bits += 4;
}

void with_finer_encoder(trial::TrialParameters& p) {
  constexpr double ratio = 4.0;
  constexpr std::int64_t whole_ratio = 4;
  p.encoder.fine *= ratio;
  p.encoder.fine_errors.noise *= ratio;
  p.encoder.fine_errors.interpolation *= ratio;
  p.encoder.fine_errors.interpolation_period *= ratio;
  p.verdict.limit *= ratio;
  p.controller.kp /= ratio;
  p.controller.ki /= ratio;
  p.controller.kd /= ratio;
  p.controller.blocks.deadband.enter *= p.controller.blocks.deadband.enter > 0.0 ? ratio : 1.0;
  p.controller.blocks.deadband.leave *= p.controller.blocks.deadband.leave > 0.0 ? ratio : 1.0;
  loop::ControlBlocks& blocks = p.controller.blocks;
  blocks.integrator_zone *= ratio;
  for (double* const band :
       {&blocks.error_deadband.band, &blocks.hold.enter, &blocks.hold.leave, &blocks.standstill.band})
    *band *= *band > 0.0 ? ratio : 1.0;
  for (double* const gain : {&blocks.standstill.kp, &blocks.standstill.ki, &blocks.standstill.kd})
    *gain /= ratio;
  for (std::int64_t& target : p.command.targets) target *= whole_ratio;
  for (std::size_t b = 0; b < p.verdict.bands.count; ++b)
    p.verdict.bands.limits[b] = whole_ratio * p.verdict.bands.limits[b] + whole_ratio / 2;
}

void with_twice_the_rate(trial::TrialParameters& p) {
  p.controller.sample_rate *= 2.0;
  p.controller.ki /= 2.0;
  p.controller.kd *= 2.0;
  p.controller.blocks.standstill.ki /= 2.0;
  p.controller.blocks.standstill.kd *= 2.0;
}

void without_delay(trial::TrialParameters& p) {
  p.controller.delay = 0.0;
  p.amplifier.bandwidth = 0.0;
}

void without_noise(trial::TrialParameters& p) {
  p.encoder.fine_errors.noise = 0.0;
  p.encoder.coarse_errors.noise = 0.0;
  p.dac.noise = 0.0;
}

void without_disturbance(trial::TrialParameters& p) {
  p.disturbance = {};
  p.initial.holding = false;
}

void with_a_regular_clock(trial::TrialParameters& p) {
  p.controller.missed = 0.0;
  p.controller.jitter = 0.0;
}

bool has_disturbance(const trial::TrialParameters& p) {
  return p.disturbance.torque != 0.0 || !p.disturbance.ripple.empty() || !p.disturbance.vibration.empty() ||
         !p.disturbance.spectra.empty();
}
bool has_irregular_clock(const trial::TrialParameters& p) {
  return p.controller.missed > 0.0 || p.controller.jitter > 0.0;
}
bool has_delay(const trial::TrialParameters& p) {
  return p.controller.delay > 0.0 || p.amplifier.bandwidth > 0.0;
}
bool has_noise(const trial::TrialParameters& p) {
  return p.encoder.fine_errors.noise > 0.0 || p.encoder.coarse_errors.noise > 0.0 || p.dac.noise > 0.0;
}
bool has_creep(const trial::TrialParameters& p) {
  return friction::has_creep(p.friction.model) && p.friction.uniform.alpha > 0.0;
}
bool has_own_controller(const trial::TrialParameters& p) {
  return p.controller.user.plugin || loop::has_coarse_phase(p.controller) ||
         p.controller.blocks.structure != loop::ControlStructure::pid;
}
bool is_plain(const trial::TrialParameters& p) {
  return !has_own_controller(p);
}
bool always(const trial::TrialParameters&) {
  return true;
}

struct Cause {
  const char* name;
  bool (*is_there)(const trial::TrialParameters&);
  void (*change)(trial::TrialParameters&);
};

constexpr Cause causes[] = {
    {"creep off", has_creep, without_creep},
    {"a converter 16 times finer", always, with_finer_converter},
    {"an encoder 4 times finer", is_plain, with_finer_encoder},
    {"twice the sample rate", is_plain, with_twice_the_rate},
    {"no delay, no amplifier lag", has_delay, without_delay},
    {"no noise", has_noise, without_noise},
    {"no disturbance", has_disturbance, without_disturbance},
    {"no missed or late samples", has_irregular_clock, with_a_regular_clock},
};

}  // namespace

double rate_of(const study::Study& study, const Units& units, std::int64_t count, const Change* change,
               const std::stop_token& stop) {
  const Candidate candidate{{}, {}, results_of(study, units, count, change, stop)};
  return estimate_of(aim_of(study), candidate, units.count).rate;
}

std::vector<Limit> limits_of(const study::Study& study, const Units& units, const std::stop_token& stop) {
  const trial::TrialParameters first = study::study_trial(study, units.point, 0).parameters;
  std::vector<const Cause*> there;
  std::vector<Limit> limits{{"none", rate_of(study, units, units.count, nullptr, stop)}};
  for (const Cause& cause : causes) {
    if (!cause.is_there(first)) continue;
    there.push_back(&cause);
    const Change change = cause.change;
    limits.push_back({cause.name, rate_of(study, units, units.count, &change, stop)});
  }
  Limit best{"", -1.0};
  for (std::size_t a = 0; a < there.size(); ++a) {
    for (std::size_t b = a + 1; b < there.size(); ++b) {
      const Change both = [&](trial::TrialParameters& p) {
        there[a]->change(p);
        there[b]->change(p);
      };
      const double rate = rate_of(study, units, units.count, &both, stop);
      if (rate > best.rate) best = {std::string(there[a]->name) + " and " + there[b]->name, rate};
    }
  }
  const auto by_rate = [](const Limit& a, const Limit& b) { return a.rate < b.rate; };
  if (best.rate > std::ranges::max_element(limits, by_rate)->rate) limits.push_back(best);
  return limits;
}

}  // namespace zerocount::tuning
