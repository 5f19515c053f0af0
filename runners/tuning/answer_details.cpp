#include "runners/tuning/answer_details.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "analysis/measures/goal_counts.hpp"
#include "core/loop/controller.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t units_of_details = 1024;

/// Rate of the goal, as Estimate::rate.
double rate_of(const study::Study& study, const Aim& aim, const Units& units, const Change* change,
               const std::stop_token& stop) {
  const Candidate candidate{{}, {}, results_of(study, units, change, stop)};
  return estimate_of(aim, candidate, units.count).rate;
}

Units fewer(const Units& units) {
  return {std::min(units.count, units_of_details), units.trials_each};
}

/// The place in [kept, lost], or [lost, kept], where `holds` ends.
double bisect(double kept, double lost, int steps, const std::function<bool(double)>& holds) {
  for (int i = 0; i < steps; ++i) {
    const double middle = 0.5 * (kept + lost);
    (holds(middle) ? kept : lost) = middle;
  }
  return kept;
}

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
  p.controller.kp /= ratio;
  p.controller.ki /= ratio;
  p.controller.kd /= ratio;
  p.controller.blocks.deadband.enter *= p.controller.blocks.deadband.enter > 0.0 ? ratio : 1.0;
  p.controller.blocks.deadband.leave *= p.controller.blocks.deadband.leave > 0.0 ? ratio : 1.0;
  p.controller.blocks.integrator_zone *= ratio;
  for (std::int64_t& target : p.command.targets) target *= whole_ratio;
  for (std::size_t b = 0; b < p.verdict.bands.count; ++b)
    p.verdict.bands.limits[b] = whole_ratio * p.verdict.bands.limits[b] + whole_ratio / 2;
}

void with_twice_the_rate(trial::TrialParameters& p) {
  p.controller.sample_rate *= 2.0;
  p.controller.ki /= 2.0;
  p.controller.kd *= 2.0;
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

bool has_delay(const trial::TrialParameters& p) {
  return p.controller.delay > 0.0 || p.amplifier.bandwidth > 0.0;
}
bool has_noise(const trial::TrialParameters& p) {
  return p.encoder.fine_errors.noise > 0.0 || p.encoder.coarse_errors.noise > 0.0 || p.dac.noise > 0.0;
}
bool has_creep(const trial::TrialParameters& p) {
  return p.friction.model == friction::FrictionModel::presliding && p.friction.uniform.alpha > 0.0;
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
};

}  // namespace

std::vector<UnitResult> results_of(const study::Study& study, const Units& units, const Change* change,
                                   const std::stop_token& stop) {
  std::vector<UnitResult> results;
  const UnitsToRun all{&study, 0, units.count, &results, change};
  run_units({&all, 1}, units, criterion_of(study), stop);
  return results;
}

std::optional<double> delay_lost(const Details& details, double delay) {
  const Units units = fewer(details.units);
  std::vector<std::string> overrides = overrides_of(details.free, details.gains);
  for (const std::string& one : overrides_for(details.study, units)) overrides.push_back(one);
  const study::Study study = variant_of(details.study, overrides);
  const auto holds = [&](double at) {
    const Change later = [&](trial::TrialParameters& p) { p.controller.delay += at - delay; };
    return rate_of(study, details.aim, units, &later, details.stop) >= wanted_rate(details.aim);
  };
  constexpr double step = 0.25;
  constexpr double most = 5.0;
  for (double more = step; more <= most; more += step) {
    if (!holds(delay + more)) return bisect(delay + more - step, delay + more, 3, holds);
  }
  return std::nullopt;
}

double rate_in_wider_band(const Details& details) {
  std::vector<std::string> overrides = overrides_of(details.free, details.gains);
  for (const std::string& one : overrides_for(details.study, details.units)) overrides.push_back(one);
  const study::Study study = variant_of(details.study, overrides);
  const std::size_t slot = measures::counted_goal(study).value().slot;
  const Change wider = [slot](trial::TrialParameters& p) {
    for (std::size_t b = slot; b < p.verdict.bands.count; ++b) ++p.verdict.bands.limits[b];
  };
  return rate_of(study, details.aim, details.units, &wider, details.stop);
}

std::vector<Room> room_of(const Details& details) {
  const Units units = fewer(details.units);
  const std::vector<std::string> sizes = overrides_for(details.study, units);
  const Place tuned = place_of(details.free, details.gains);
  std::vector<Room> room;
  for (std::size_t i = 0; i < details.free.size(); ++i) {
    const auto value_at = [&](double share) {
      Place place = tuned;
      place[i] = share;
      return values_at(details.free, place);
    };
    const auto holds = [&](double share) {
      std::vector<std::string> overrides = overrides_of(details.free, value_at(share));
      overrides.insert(overrides.end(), sizes.begin(), sizes.end());
      return rate_of(variant_of(details.study, overrides), details.aim, units, nullptr, details.stop) >=
             wanted_rate(details.aim);
    };
    // Outwards in steps, because the goal may be lost and met again farther off.
    const auto end = [&](double to) {
      constexpr int steps = 8;
      double kept = tuned[i];
      for (int step = 1; step <= steps; ++step) {
        const double next = tuned[i] + (to - tuned[i]) * step / steps;
        if (!holds(next)) return bisect(kept, next, 4, holds);
        kept = next;
      }
      return to;
    };
    room.push_back({details.free[i].name, value_at(end(0.0))[i], value_at(end(1.0))[i]});
  }
  return room;
}

Units limit_units(const Details& details) {
  return details.units;
}

std::vector<Limit> limits_of(const study::Study& study, const Units& units, const std::stop_token& stop) {
  const Aim aim = aim_of(study, criterion_of(study));
  const trial::TrialParameters first = study::study_trial(study, 0, 0).parameters;
  std::vector<const Cause*> there;
  std::vector<Limit> limits{{"none", rate_of(study, aim, units, nullptr, stop)}};
  for (const Cause& cause : causes) {
    if (!cause.is_there(first)) continue;
    there.push_back(&cause);
    const Change change = cause.change;
    limits.push_back({cause.name, rate_of(study, aim, units, &change, stop)});
  }
  Limit best{"", -1.0};
  for (std::size_t a = 0; a < there.size(); ++a) {
    for (std::size_t b = a + 1; b < there.size(); ++b) {
      const Change both = [&](trial::TrialParameters& p) {
        there[a]->change(p);
        there[b]->change(p);
      };
      const double rate = rate_of(study, aim, units, &both, stop);
      if (rate > best.rate) best = {std::string(there[a]->name) + " and " + there[b]->name, rate};
    }
  }
  const auto by_rate = [](const Limit& a, const Limit& b) { return a.rate < b.rate; };
  if (best.rate > std::ranges::max_element(limits, by_rate)->rate) limits.push_back(best);
  return limits;
}

Units units_of(const study::Study& study) {
  if (study.rigs == 0) return {study.trials, 1};
  return {study.rigs, study.trials / study.rigs};
}

WorstMachine worst_machine(const study::Study& study, const Units& units, const std::stop_token& stop) {
  const std::vector<UnitResult> results = results_of(study, units, nullptr, stop);
  const auto met = [](const UnitResult& unit) { return static_cast<double>(unit.met) / unit.moves; };
  const auto latest = [](const UnitResult& unit) {
    return unit.values.empty() ? 0.0 : *std::ranges::max_element(unit.values);
  };
  const auto worst = std::ranges::min_element(results, [&](const UnitResult& a, const UnitResult& b) {
    return met(a) != met(b) ? met(a) < met(b) : latest(a) > latest(b);
  });
  WorstMachine machine{worst - results.begin(), met(*worst), {}};
  if (study.rigs > 0 && !study.rig_columns.empty()) {
    const std::vector<double> inputs = study::rig_inputs(study, machine.rig);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      machine.inputs.emplace_back(study.rig_columns[i].name, inputs[i]);
    return machine;
  }
  const std::vector<double> inputs = study::study_trial(study, 0, machine.rig).inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    machine.inputs.emplace_back(study.input_columns[i].name, inputs[i]);
  return machine;
}

}  // namespace zerocount::tuning
