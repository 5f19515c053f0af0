#include "tests/core/batch/batched_trials.hpp"

#include <bit>
#include <cmath>

#include <fmt/core.h>

#include "core/trial/trial.hpp"
#include "results/layout/measure_table.hpp"

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
  d.expect_same("number", a.number, b.number);
  for (const layout::RecordField<trial::MoveOutcome>& field : fields_of_moves())
    d.expect_same(field.column.name.c_str(), layout::value_of(field, a), layout::value_of(field, b));
}

void compare(Differences& d, const trial::Jerk& a, const trial::Jerk& b) {
  for (const layout::RecordField<layout::JerkRecord>& field : layout::jerk_fields())
    d.expect_same(field.column.name.c_str(), layout::value_of(field, {a}), layout::value_of(field, {b}));
}

void compare(Differences& d, const batch::BatchSample& a, const batch::BatchSample& b) {
  // A trial has another number alone than in a batch.
  [[maybe_unused]] const auto& [trial, k, count, code, theta, xp, xh] = a;
  d.expect_same("k", k, b.k);
  d.expect_same("count", count, b.count);
  d.expect_same("code", code, b.code);
  d.expect_same("theta", theta, b.theta);
  d.expect_same("xp", xp, b.xp);
  d.expect_same("xh", xh, b.xh);
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

const std::vector<layout::RecordField<trial::MoveOutcome>>& fields_of_moves() {
  static const std::vector<layout::RecordField<trial::MoveOutcome>> fields = [] {
    const trial::VerdictParameters verdict = verdict_with_all_measures();
    std::vector<layout::RecordField<trial::MoveOutcome>> all;
    for (const layout::Measure& measure :
         layout::measure_table({.bands = verdict.bands, .tolerances = verdict.tolerances}))
      all.push_back(measure.field);
    return all;
  }();
  return fields;
}

trial::VerdictParameters verdict_with_all_measures() {
  trial::VerdictParameters verdict;
  verdict.bands.count = verdict.bands.limits.size();
  for (std::size_t i = 0; i < verdict.bands.count; ++i)
    verdict.bands.limits[i] = static_cast<std::int64_t>(i * i);
  verdict.tolerances.count = verdict.tolerances.limits.size();
  for (std::size_t i = 0; i < verdict.tolerances.count; ++i)
    verdict.tolerances.limits[i] = std::ldexp(1e-7, static_cast<int>(i));
  verdict.position_error = verdict.motion = true;
  verdict.rest_band = 1.0;
  return verdict;
}

trial::TrialParameters with_all_measures(trial::TrialParameters trial) {
  trial::VerdictParameters verdict = verdict_with_all_measures();
  verdict.dwell = trial.verdict.dwell;
  verdict.window = trial.verdict.window;
  if (trial.plant.load.inertia > 0.0) {
    verdict.other_mass = trial.plant.load.encoder == motion::EncoderPlace::load ? motion::EncoderPlace::motor
                                                                                : motion::EncoderPlace::load;
  }
  trial.verdict = verdict;
  return trial;
}

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
    trial.samples.push_back({0, r.k, r.count, r.code, r.theta, r.xp, r.xh});
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
