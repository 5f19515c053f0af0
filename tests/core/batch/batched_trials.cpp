#include "tests/core/batch/batched_trials.hpp"

#include <bit>
#include <cmath>

#include <fmt/core.h>

#include "core/trial/trial.hpp"

namespace zerocount::testing {
namespace {

std::vector<const trial::TrialParameters*> pointers_to(const std::vector<trial::TrialParameters>& trials) {
  std::vector<const trial::TrialParameters*> pointers;
  pointers.reserve(trials.size());
  for (const trial::TrialParameters& trial : trials) pointers.push_back(&trial);
  return pointers;
}

/// Collects the names of the results in which two runs of a trial differ.
class Differences {
 public:
  void expect_same(const char* name, double a, double b) {
    if (std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b)) return;
    if (std::isnan(a) && std::isnan(b)) return;
    text += fmt::format(" {} {:.17g} and {:.17g};", name, a, b);
  }
  void expect_same(const char* name, std::int64_t a, std::int64_t b) {
    if (a != b) text += fmt::format(" {} {} and {};", name, a, b);
  }
  void expect_same_size(const char* name, std::size_t a, std::size_t b) {
    if (a != b) text += fmt::format(" {} {} and {};", name, a, b);
  }

  std::string text;
};

void compare(Differences& d, const trial::MoveOutcome& a, const trial::MoveOutcome& b) {
  d.expect_same("outcome", static_cast<std::int64_t>(a.outcome), static_cast<std::int64_t>(b.outcome));
  d.expect_same("arrived", std::int64_t{a.arrived}, std::int64_t{b.arrived});
  d.expect_same("stable", std::int64_t{a.stable}, std::int64_t{b.stable});
  d.expect_same("broke_away", std::int64_t{a.broke_away}, std::int64_t{b.broke_away});
  d.expect_same("saturated", std::int64_t{a.saturated}, std::int64_t{b.saturated});
  d.expect_same("stopped", std::int64_t{a.stopped}, std::int64_t{b.stopped});
  d.expect_same("arrival", a.arrival, b.arrival);
  d.expect_same("arrival_time", a.arrival_time, b.arrival_time);
  d.expect_same("final_settling_time", a.final_settling_time, b.final_settling_time);
  d.expect_same("zero_fraction", a.zero_fraction, b.zero_fraction);
  d.expect_same("oscillation_amplitude", a.oscillation_amplitude, b.oscillation_amplitude);
  d.expect_same("oscillation_period", a.oscillation_period, b.oscillation_period);
  d.expect_same("midway_error", a.midway_error, b.midway_error);
  d.expect_same("travel_time", a.travel_time, b.travel_time);
  d.expect_same("overshoot", a.overshoot, b.overshoot);
  d.expect_same("final_error", a.final_error, b.final_error);
  d.expect_same("true_error", a.true_error, b.true_error);
  d.expect_same("final_position", a.final_position, b.final_position);
  d.expect_same("holding_torque", a.holding_torque, b.holding_torque);
  d.expect_same("peak_torque", a.peak_torque, b.peak_torque);
  d.expect_same("creep", a.creep, b.creep);
  d.expect_same("reversal_depth", a.reversal_depth, b.reversal_depth);
  d.expect_same("phase_changes", a.phase_changes, b.phase_changes);
  d.expect_same("encoder_disagreement", a.encoder_disagreement, b.encoder_disagreement);
  d.expect_same("jerk_count", a.jerk_count, b.jerk_count);
  d.expect_same("jerk_agreement", a.jerk_agreement, b.jerk_agreement);
  d.expect_same("rest_error_rms", a.rest_error_rms, b.rest_error_rms);
  d.expect_same("rest_error_range", a.rest_error_range, b.rest_error_range);
  d.expect_same("rest_torque_power", a.rest_torque_power, b.rest_torque_power);
  d.expect_same("rest_torque_noise", a.rest_torque_noise, b.rest_torque_noise);
  d.expect_same("following_error_rms", a.following_error_rms, b.following_error_rms);
  d.expect_same("reversal_spike", a.reversal_spike, b.reversal_spike);
  d.expect_same("true_overshoot", a.true_overshoot, b.true_overshoot);
  for (std::size_t i = 0; i < trial::max_tolerances; ++i)
    d.expect_same("tolerance_settling_time", a.tolerance_settling_times[i], b.tolerance_settling_times[i]);
  d.expect_same("step_motion", a.step_motion, b.step_motion);
}

void compare(Differences& d, const trial::Jerk& a, const trial::Jerk& b) {
  d.expect_same("jerk's move", a.move, b.move);
  d.expect_same("onset", a.onset, b.onset);
  d.expect_same("duration", a.duration, b.duration);
  d.expect_same("magnitude", a.magnitude, b.magnitude);
  d.expect_same("direction", std::int64_t{a.direction}, std::int64_t{b.direction});
}

void compare(Differences& d, const batch::BatchSample& a, const batch::BatchSample& b) {
  d.expect_same("k", a.k, b.k);
  d.expect_same("count", a.count, b.count);
  d.expect_same("code", a.code, b.code);
  d.expect_same("theta", a.theta, b.theta);
  d.expect_same("xp", a.xp, b.xp);
}

/// Compares two lists of results element by element, up to the first pair that differs, and reports the
/// difference.
template <class T>
void compare_all(Differences& d, const char* what, const std::vector<T>& a, const std::vector<T>& b) {
  d.expect_same_size(what, a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && d.text.empty(); ++i) {
    compare(d, a[i], b[i]);
    if (!d.text.empty()) d.text = fmt::format("{} {}:{}", what, i, d.text);
  }
}

}  // namespace

std::vector<BatchedTrial> run_batch(const std::vector<trial::TrialParameters>& trials,
                                    const batch::BatchSettings& settings, Observed observed) {
  batch::BatchEngine engine(settings);
  return run_batch(engine, trials, observed);
}

std::vector<BatchedTrial> run_batch(batch::BatchEngine& engine,
                                    const std::vector<trial::TrialParameters>& trials, Observed observed) {
  std::vector<BatchedTrial> results(trials.size());
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  batch::BatchObservers observers;
  observers.jerk = [&](std::size_t trial, const trial::Jerk& jerk) {
    results.at(trial).jerks.push_back(jerk);
  };
  if (observed == Observed::samples_and_jerks) {
    observers.sample = [&](const batch::BatchSample& s) { results.at(s.trial).samples.push_back(s); };
  }
  engine.run(pointers_to(trials), outcomes, observers);
  for (std::size_t i = 0; i < trials.size(); ++i) results[i].outcome = std::move(outcomes[i]);
  return results;
}

std::string difference_in_bits(const BatchedTrial& one, const BatchedTrial& other) {
  Differences d;
  if (!one.samples.empty() && !other.samples.empty()) compare_all(d, "sample", one.samples, other.samples);
  if (d.text.empty()) compare_all(d, "jerk", one.jerks, other.jerks);
  if (d.text.empty()) compare_all(d, "move", one.outcome.moves, other.outcome.moves);
  return d.text;
}

BatchedTrial run_by_reference(const trial::TrialParameters& parameters) {
  BatchedTrial trial;
  trial::TrialObservers observers;
  observers.jerk = [&](const trial::Jerk& jerk) { trial.jerks.push_back(jerk); };
  observers.sample = [&](const trial::SampleRecord& r) {
    trial.samples.push_back({0, r.k, r.count, r.code, r.theta, r.xp});
  };
  trial.outcome = trial::run_trial(parameters, observers);
  return trial;
}

std::vector<batch::InstructionSet> available_instruction_sets() {
  std::vector<batch::InstructionSet> sets;
  for (const batch::InstructionSet set :
       {batch::InstructionSet::portable, batch::InstructionSet::avx2, batch::InstructionSet::avx512}) {
    if (batch::is_available(set)) sets.push_back(set);
  }
  return sets;
}

trial::TrialParameters trial_with_any_exponent(TrialKind kind, std::uint64_t index) {
  trial::TrialParameters p = random_trial(kind, index);
  p.amplifier = {};
  if (p.friction.model == friction::FrictionModel::coulomb)
    p.friction.model = friction::FrictionModel::presliding;
  return p;
}

trial::TrialParameters trial_for_lanes(TrialKind kind, std::uint64_t index) {
  trial::TrialParameters p = trial_with_any_exponent(kind, index);
  friction::FrictionParameters& f = p.friction.uniform;
  constexpr double torque = 0.02;  // N m
  f.lambda = torque * torque / (std::pow(torque, f.n) / f.lambda);
  f.n = 2.0;
  return p;
}

}  // namespace zerocount::testing
