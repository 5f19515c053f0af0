#include "runners/tuning/loop_examiner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "analysis/parallel/parallel.hpp"
#include "analysis/theory/trial_loops.hpp"
#include "core/friction/parameters.hpp"
#include "core/loop/controller.hpp"
#include "core/theory/margins.hpp"

namespace zerocount::tuning {
namespace {

constexpr std::int64_t most_unlike_machines = 100;
constexpr int places_on_profile = 64;
constexpr int stiffnesses = 4;  // from the softest to the stiffest
constexpr double longest_delay = 10.0;

/// The loops of a machine before it slides, with this much more delay.
std::vector<theory::FrozenLoop> loops_of(trial::TrialParameters p, double softest, double stiffest,
                                         double more_delay) {
  p.controller.delay += more_delay;
  std::vector<theory::FrozenLoop> loops;
  if (!friction::has_spring(p.friction.model)) {
    const bool free = !friction::has_friction(p.friction.model);
    for (const theory::TrialLoop& one : theory::trial_loops(p)) {
      if (!one.slides || free) loops.push_back(one.loop);
    }
    return loops;
  }
  const loop::ControllerParameters fine = loop::controller_in_phase(p.controller, loop::ControlPhase::fine);
  for (int i = 0; i < stiffnesses; ++i) {
    const double share = static_cast<double>(i) / (stiffnesses - 1);
    const double stiffness = softest * std::pow(stiffest / softest, share);
    loops.push_back(theory::frozen_loop(stiffness, p.plant.presliding_damping, p.plant, p.encoder, fine,
                                        theory::drive_of(p)));
    if (softest == stiffest) break;
  }
  return loops;
}

bool all_stable(const std::vector<theory::FrozenLoop>& loops) {
  return std::ranges::all_of(loops, [](const theory::FrozenLoop& one) {
    return theory::stability_of(one) == theory::LoopStability::stable;
  });
}

double decibels(double factor) {
  return std::isnan(factor) ? std::numeric_limits<double>::infinity() : std::abs(20.0 * std::log10(factor));
}

double degrees(double phase) {
  return std::isnan(phase) ? std::numeric_limits<double>::infinity() : std::abs(phase);
}

bool keeps_margins(const trial::TrialParameters& p, double softest, double stiffest,
                   const study::LoopMargins& margins) {
  if (!margins.gain && !margins.phase && !margins.delay) return true;
  const std::vector<theory::FrozenLoop> loops = loops_of(p, softest, stiffest, 0.0);
  if (!all_stable(loops)) return false;
  for (const double share : {0.5, 1.0}) {
    if (margins.delay && !all_stable(loops_of(p, softest, stiffest, share * *margins.delay))) return false;
  }
  if (!margins.gain && !margins.phase) return true;
  return std::ranges::all_of(loops, [&](const theory::FrozenLoop& one) {
    const theory::StabilityMargins found = theory::stability_margins(one);
    return !(margins.gain && decibels(found.gain.value) < *margins.gain) &&
           !(margins.phase && degrees(found.phase.value) < *margins.phase);
  });
}

/// The delay (samples) by which the loop may grow until it is unstable, to 0.01.
double delay_margin(const trial::TrialParameters& p, double softest, double stiffest) {
  const auto stable = [&](double more) { return all_stable(loops_of(p, softest, stiffest, more)); };
  double kept = 0.0;
  double lost = 0.25;
  if (!stable(0.0)) return 0.0;
  while (stable(lost)) {
    kept = lost;
    lost += 0.25;
    if (kept >= longest_delay) return longest_delay;
  }
  while (lost - kept > 0.01) {
    const double middle = 0.5 * (kept + lost);
    (stable(middle) ? kept : lost) = middle;
  }
  return kept;
}

/// Whether the drawn quantities change nothing of the loop but the stiffness of the contact.
bool differ_in_stiffness_alone(const study::Study& study) {
  return std::ranges::all_of(study.input_columns, [](const study::InputColumn& column) {
    const auto is_of = [&column](std::string_view section) { return column.name.starts_with(section); };
    return is_of("friction.") || is_of("initial.") || is_of("command.");
  });
}

/// The softest and the stiffest contact over the friction profile of a trial.
std::pair<double, double> stiffness_range(const trial::TrialParameters& p, double period) {
  double softest = std::numeric_limits<double>::infinity();
  double stiffest = 0.0;
  const int places = p.friction.profiled.empty() ? 1 : places_on_profile;
  for (int place = 0; place < places; ++place) {
    const friction::FrictionParameters contact =
        friction::friction_at(p.friction, p.initial.position + period * place / places);
    softest = std::min(softest, contact.k1);
    stiffest = std::max(stiffest, contact.k1 + contact.k2);
  }
  return {softest, stiffest};
}

}  // namespace

LoopExaminer::LoopExaminer(const study::Study& study, std::int64_t machines) {
  const trial::TrialParameters first = study::study_trial(study, 0, 0).parameters;
  if (theory::has_no_linear_loop(first)) return;
  const bool alike = friction::has_spring(first.friction.model) && differ_in_stiffness_alone(study);
  examined_ = alike ? machines : std::min(machines, most_unlike_machines);
  machines_.resize(static_cast<std::size_t>(examined_));
  parallel::for_each_index(machines_.size(), [&](std::size_t i) {
    const auto trial = static_cast<std::int64_t>(i);
    const auto [softest, stiffest] =
        stiffness_range(study::study_trial(study, 0, trial).parameters, study.period);
    machines_[i] = {trial, softest, stiffest};
  });
  if (alike) {
    Machine all = machines_.front();
    for (const Machine& one : machines_) {
      all.softest = std::min(all.softest, one.softest);
      all.stiffest = std::max(all.stiffest, one.stiffest);
    }
    machines_ = {all};
  }
  const auto by = [this](auto less) {
    return static_cast<std::size_t>(std::ranges::min_element(machines_, less) - machines_.begin());
  };
  critical_ = {by([](const Machine& a, const Machine& b) { return a.softest < b.softest; }),
               by([](const Machine& a, const Machine& b) { return a.stiffest > b.stiffest; })};
  if (critical_[0] == critical_[1]) critical_.pop_back();
}

bool LoopExaminer::may_keep(const study::Study& candidate, const study::LoopMargins& margins) const {
  return std::ranges::all_of(critical_, [&](std::size_t index) {
    const Machine& one = machines_[index];
    return keeps_margins(study::study_trial(candidate, 0, one.trial).parameters, one.softest, one.stiffest,
                         margins);
  });
}

bool LoopExaminer::keeps(const study::Study& candidate, const study::LoopMargins& margins) {
  std::vector<char> kept(machines_.size(), 1);
  parallel::for_each_index(machines_.size(), [&](std::size_t i) {
    const Machine& one = machines_[i];
    kept[i] = keeps_margins(study::study_trial(candidate, 0, one.trial).parameters, one.softest, one.stiffest,
                            margins)
                  ? 1
                  : 0;
  });
  const auto broken = std::ranges::find(kept, 0);
  if (broken == kept.end()) return true;
  const auto index = static_cast<std::size_t>(broken - kept.begin());
  if (std::ranges::find(critical_, index) == critical_.end()) critical_.push_back(index);
  return false;
}

SmallestMargins LoopExaminer::margins_of(const study::Study& candidate) const {
  std::vector<SmallestMargins> found(machines_.size());
  constexpr double none = std::numeric_limits<double>::infinity();
  parallel::for_each_index(machines_.size(), [&](std::size_t i) {
    const Machine& one = machines_[i];
    const trial::TrialParameters p = study::study_trial(candidate, 0, one.trial).parameters;
    SmallestMargins& smallest = found[i];
    smallest = {true, none, none, delay_margin(p, one.softest, one.stiffest), 1};
    for (const theory::FrozenLoop& each : loops_of(p, one.softest, one.stiffest, 0.0)) {
      smallest.stable = smallest.stable && theory::stability_of(each) == theory::LoopStability::stable;
      const theory::StabilityMargins margins = theory::stability_margins(each);
      smallest.gain = std::min(smallest.gain, decibels(margins.gain.value));
      smallest.phase = std::min(smallest.phase, degrees(margins.phase.value));
    }
  });
  SmallestMargins all{true, none, none, longest_delay, examined_};
  for (const SmallestMargins& one : found) {
    all.stable = all.stable && one.stable;
    all.gain = std::min(all.gain, one.gain);
    all.phase = std::min(all.phase, one.phase);
    all.delay = std::min(all.delay, one.delay);
  }
  return all;
}

}  // namespace zerocount::tuning
