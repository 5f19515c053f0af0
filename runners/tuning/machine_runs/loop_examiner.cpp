#include "runners/tuning/machine_runs/loop_examiner.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/theory/trial_loops.hpp"
#include "core/friction/law.hpp"
#include "core/friction/parameters.hpp"
#include "core/numerics/roots.hpp"
#include "core/theory/margins.hpp"
#include "core/trial/trial.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::tuning {
namespace {

/// Whether the study draws at random, in a setting (condition at an age), some input whose name satisfies
/// `fits`.
template <class Fits>
bool draws(const study::Study& study, std::int64_t setting, const Fits& fits) {
  const study::StudyPlan& plan = *study.plan;
  for (std::size_t column = 0; column < study.columns.inputs.size(); ++column) {
    if (!fits(study.columns.inputs[column].name)) continue;
    const study::Value& value =
        *study::value_at_point(plan, plan.inputs[column].slot, study::plan_point(plan, 0, setting));
    if (!plan.settings_axis || value.kind != study::Value::Kind::number) return true;
  }
  return false;
}

/// Replaces each machine by two copies in which `scale` multiplies a quantity by 1 − part and by 1 + part.
/// Does nothing if `part` is nothing or 0.
template <class Scale>
void spread_by(const std::optional<double>& part, std::vector<trial::TrialParameters>& machines,
               const Scale& scale) {
  if (part.value_or(0.0) == 0.0) return;
  std::vector<trial::TrialParameters> spread;
  spread.reserve(2 * machines.size());
  for (const trial::TrialParameters& machine : machines) {
    for (const double factor : {1.0 - *part, 1.0 + *part}) {
      spread.push_back(machine);
      scale(spread.back(), factor);
    }
  }
  machines = std::move(spread);
}

/// Spread of inertia, damping and torque constant that the study's margins ask for, without the quantities
/// that the study itself draws in a setting. Empty without margins.
/// @param setting index of the setting (condition at an age); 0 without settings
study::LoopSpread spread_of_undrawn(const study::Study& study, std::int64_t setting) {
  if (!study.tuning) return {std::nullopt, std::nullopt, std::nullopt};
  study::LoopSpread spread = study.tuning->margins.spread;
  const auto is_drawn = [&](std::initializer_list<std::string_view> names) {
    return draws(study, setting,
                 [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); });
  };
  if (is_drawn({parameter::plant::inertia, parameter::plant::load::inertia})) spread.inertia.reset();
  if (is_drawn({parameter::plant::presliding_damping, parameter::plant::sliding_damping}))
    spread.damping.reset();
  if (is_drawn({parameter::dac::gain_error})) spread.torque_constant.reset();
  return spread;
}

/// The machine at the corners of its spread (tolerance of inertia, damping and torque constant): each
/// combination of the lowest and highest values of the n spread quantities. These are 2ⁿ machines; without a
/// spread, the machine itself.
///
///     inertia: J and JL times 1 ± s;  damping: c and cs times 1 ± s;  torque constant: times 1 ± s
std::vector<trial::TrialParameters> corners_of(const trial::TrialParameters& machine,
                                               const study::LoopSpread& spread) {
  std::vector<trial::TrialParameters> machines{machine};
  spread_by(spread.inertia, machines, [](trial::TrialParameters& p, double factor) {
    p.plant.inertia *= factor;
    p.plant.load.inertia *= factor;
  });
  spread_by(spread.damping, machines, [](trial::TrialParameters& p, double factor) {
    p.plant.presliding_damping *= factor;
    p.plant.sliding_damping *= factor;
  });
  spread_by(spread.torque_constant, machines, [](trial::TrialParameters& p, double factor) {
    p.dac.gain_error = (1.0 + p.dac.gain_error) * factor - 1.0;
  });
  return machines;
}

/// Indices in corners_of() of the corners with usually the smallest margins: lowest damping with highest
/// torque constant, at both inertias.
std::vector<std::size_t> likely_worst_corners(const study::LoopSpread& spread) {
  const auto is_spread = [](const std::optional<double>& part) { return part.value_or(0.0) != 0.0; };
  const std::size_t torques = is_spread(spread.torque_constant) ? 2 : 1;
  const std::size_t dampings = is_spread(spread.damping) ? 2 : 1;
  const std::size_t highest_torque = torques - 1;
  if (!is_spread(spread.inertia)) return {highest_torque};
  return {highest_torque, dampings * torques + highest_torque};
}

constexpr std::int64_t max_unlike_machines = 100;
constexpr int stiffnesses = 4;             // from the softest to the stiffest
constexpr double lowest_mode_tried = 1.0;  // of a mode, Hz
constexpr double frequency_ratio = 1.05;   // of one mode that is tried and the next

struct Loops {
  std::vector<theory::TrialLoop> loops;
  /// Time for which a move holds its target, s. A loop that grows only slowly in this time counts as stable.
  double hold{0.0};
  bool before_sliding{false};
  bool sliding{false};
};

/// Linearised friction contacts of the machine. They are the contacts of the trial. For friction with a
/// spring, the contacts before sliding are replaced by several with stiffnesses from the softest to the
/// stiffest.
friction::LinearContacts contacts_of(const trial::TrialParameters& p, const ExaminedMachine& machine) {
  friction::LinearContacts contacts = theory::linear_contacts_of(p);
  if (!friction::has_spring(p.friction.model)) return contacts;
  std::erase_if(contacts, [](const friction::LinearContact& contact) { return !contact.slides; });
  const int count = machine.softest == machine.stiffest ? 1 : stiffnesses;
  for (int i = 0; i < count; ++i) {
    const double fraction = static_cast<double>(i) / (stiffnesses - 1);
    contacts.insert(
        contacts.begin() + i,
        {"before sliding", machine.softest * std::pow(machine.stiffest / machine.softest, fraction),
         p.plant.presliding_damping});
  }
  return contacts;
}

/// Linear control loops that a machine can have, one for each friction contact and state of the load.
/// @param of machine and the trial's parameters
/// @param more_delay added to the delay of the controller, samples
Loops loops_of(const Examination& of, double more_delay = 0.0) {
  trial::TrialParameters p = of.p;
  p.controller.delay += more_delay;
  friction::LinearContacts contacts = contacts_of(p, of.machine);
  Loops found;
  found.hold = p.command.hold;
  found.before_sliding = !std::ranges::all_of(contacts, &friction::LinearContact::slides);
  found.sliding = of.slides || !found.before_sliding;
  if (!found.sliding)
    std::erase_if(contacts, [](const friction::LinearContact& contact) { return contact.slides; });
  found.loops = theory::loops_about(contacts, p);
  return found;
}

bool is_unstable(const theory::TrialLoop& one, double hold) {
  return theory::stability_of(one.loop, hold) == theory::LoopStability::unstable;
}

bool none_unstable(const Loops& of) {
  return std::ranges::none_of(of.loops,
                              [&](const theory::TrialLoop& one) { return is_unstable(one, of.hold); });
}

double decibels(double factor) {
  return std::isnan(factor) ? std::numeric_limits<double>::infinity() : std::abs(20.0 * std::log10(factor));
}

double degrees(double phase) {
  return std::isnan(phase) ? std::numeric_limits<double>::infinity() : std::abs(phase);
}

bool is_wanted(const study::LoopMargins& margins) {
  return margins.gain || margins.phase || margins.delay || margins.sensitivity;
}

/// Fraction by which a margin falls short of the wanted one: 1 − found/wanted; 0 if the margin is kept.
double missing_part(double found, double wanted) {
  return wanted > 0.0 ? std::max(1.0 - found / wanted, 0.0) : 0.0;
}

/// Largest fraction by which a gain, phase or sensitivity margin of a loop falls short; 0 if the loop keeps
/// all wanted margins.
double missing_of(const theory::FrozenLoop& loop, const study::LoopMargins& margins) {
  double missing = 0.0;
  if (margins.gain || margins.phase) {
    const theory::StabilityMargins found = theory::stability_margins(loop);
    if (margins.gain) missing = missing_part(decibels(found.gain.value), *margins.gain);
    if (margins.phase) missing = std::max(missing, missing_part(degrees(found.phase.value), *margins.phase));
  }
  if (!margins.sensitivity) return missing;
  const double peak = theory::peak_sensitivity(loop).value;
  return std::max(missing, missing_part(1.0 / (peak - 1.0), 1.0 / (*margins.sensitivity - 1.0)));
}

bool keeps_margins(const Examination& machine, const study::LoopMargins& margins) {
  const Loops of = loops_of(machine);
  if (!none_unstable(of)) return false;
  for (const double fraction : {0.5, 1.0}) {
    if (margins.delay && !none_unstable(loops_of(machine, fraction * *margins.delay))) return false;
  }
  return parallel::holds_for_all(
      of.loops.size(), [&](std::size_t i) { return missing_of(of.loops[i].loop, margins) == 0.0; },
      "margins of a loop");
}

/// Positive number that increases with the growth of the fastest unstable loop; 0 if no loop is unstable.
double instability(const Loops& of) {
  double fastest = 0.0;
  for (const theory::TrialLoop& one : of.loops) {
    if (is_unstable(one, of.hold))
      fastest = std::max(fastest, std::log1p(theory::log_growth(one.loop, of.hold)));
  }
  return fastest;
}

double shortfall_of(const Examination& machine, const study::LoopMargins& margins) {
  const Loops of = loops_of(machine);
  if (const double fastest = instability(of); fastest > 0.0) return 1.0 + fastest;
  double missing = 0.0;
  for (const double fraction : {0.5, 1.0}) {
    if (!margins.delay) break;
    const double fastest = instability(loops_of(machine, fraction * *margins.delay));
    missing = std::max(missing, fastest / (1.0 + fastest));
  }
  for (const theory::TrialLoop& one : of.loops) missing = std::max(missing, missing_of(one.loop, margins));
  return missing;
}

/// Additional delay of the controller at which a loop becomes unstable, samples, to 0.01, and this loop. If
/// no loop becomes unstable: SmallestMargins::max_delay, and no loop.
std::pair<double, std::optional<theory::TrialLoop>> delay_margin(const Examination& machine) {
  std::optional<theory::TrialLoop> first_lost;
  const auto bears = [&](double more) {
    const Loops of = loops_of(machine, more);
    const auto lost = std::ranges::find_if(
        of.loops, [&](const theory::TrialLoop& one) { return is_unstable(one, of.hold); });
    if (lost != of.loops.end()) first_lost = *lost;
    return lost == of.loops.end();
  };
  double kept = 0.0;
  double lost = 0.25;
  if (!bears(0.0)) return {0.0, first_lost};
  while (bears(lost)) {
    kept = lost;
    lost += 0.25;
    if (kept >= SmallestMargins::max_delay) return {SmallestMargins::max_delay, std::nullopt};
  }
  const double margin = numerics::bisect({kept, lost}, bears, numerics::within(0.01)).holds;
  return {margin, first_lost};
}

/// Whether the machines differ, in a setting (condition at an age), only in quantities that change nothing
/// but the spring stiffness of their loops.
bool differ_in_stiffness_alone(const study::Study& study, std::int64_t setting,
                               friction::FrictionModel model) {
  if (!friction::has_spring(model) && friction::traits_of(model).has_presliding_motion) return false;
  return !draws(study, setting, [](std::string_view name) {
    return !name.starts_with("friction.") && !name.starts_with("initial.") && !name.starts_with("command.");
  });
}

void include(Smallest& smallest, const Smallest& one) {
  if (one.value < smallest.value) smallest = one;
}

void include_largest(Smallest& largest, const Smallest& one) {
  if (one.value > largest.value) largest = one;
}

SmallestMargins margins_of_machine(const Examination& machine) {
  const auto critical = [&](const theory::TrialLoop& one) {
    const bool has_spring = !one.slides && one.stiffness > 0.0;
    return CriticalLoop{one.name, has_spring ? std::optional(one.stiffness) : std::nullopt,
                        machine.machine.draw, machine.machine.setting};
  };
  const Loops of = loops_of(machine);
  SmallestMargins smallest;
  smallest.before_sliding = of.before_sliding;
  smallest.sliding = of.sliding;
  const auto [delay, lost] = delay_margin(machine);
  if (lost) include(smallest.delay, {delay, critical(*lost)});
  for (const theory::TrialLoop& each : of.loops) {
    smallest.stable = smallest.stable && !is_unstable(each, of.hold);
    const theory::StabilityMargins margins = theory::stability_margins(each.loop);
    include(smallest.gain, {decibels(margins.gain.value), critical(each)});
    include(smallest.phase, {degrees(margins.phase.value), critical(each)});
    include_largest(smallest.sensitivity, {theory::peak_sensitivity(each.loop).value, critical(each)});
    if (margins.crossover.frequency > smallest.crossover) smallest.crossover = margins.crossover.frequency;
  }
  return smallest;
}

/// Merges the margins `one` of further machines into `all`, the smallest margins so far.
void include(SmallestMargins& all, const SmallestMargins& one) {
  all.stable = all.stable && one.stable;
  include(all.gain, one.gain);
  include(all.phase, one.phase);
  include(all.delay, one.delay);
  include_largest(all.sensitivity, one.sensitivity);
  all.crossover = std::max(all.crossover, one.crossover);
  all.before_sliding = all.before_sliding || one.before_sliding;
  all.sliding = all.sliding || one.sliding;
}

}  // namespace

bool keeps(const SmallestMargins& margins, const study::LoopMargins& wanted) {
  return margins.stable && margins.gain.value >= wanted.gain.value_or(margins.gain.value) &&
         margins.phase.value >= wanted.phase.value_or(margins.phase.value) &&
         margins.delay.value >= wanted.delay.value_or(margins.delay.value) &&
         margins.sensitivity.value <= wanted.sensitivity.value_or(margins.sensitivity.value);
}

LoopExaminer::LoopExaminer(const study::Study& study, std::int64_t machines)
    : settings_(study.settings.listed()) {
  const trial::TrialParameters first = study::study_trial(study, 0, 0).parameters;
  if (theory::has_no_linear_loop(first)) return;
  const study::TrialIndices indices = study::trial_indices(study);
  std::vector<char> alike;  // [setting]
  for (std::int64_t setting = 0; setting < indices.settings.total(); ++setting)
    alike.push_back(differ_in_stiffness_alone(study, setting, first.friction.model) ? 1 : 0);
  examined_ = std::ranges::count(alike, 0) == 0 ? machines : std::min(machines, max_unlike_machines);
  std::vector<ExaminedMachine> all(static_cast<std::size_t>(examined_ * indices.settings.total()));
  parallel::for_each_index(all.size(), [&](std::size_t i) {
    const std::int64_t setting = static_cast<std::int64_t>(i) % indices.settings.total();
    const std::int64_t trial =
        indices.trial_of(static_cast<std::int64_t>(i) / indices.settings.total(), setting);
    const auto [softest, stiffest] = theory::stiffness_range(study::study_trial(study, 0, trial).parameters);
    const std::int64_t draw = static_cast<std::int64_t>(i) / indices.settings.total();
    all[i] = {trial, setting, draw, spread_of_undrawn(study, setting), softest, stiffest};
  });
  for (const ExaminedMachine& one : all) {
    const auto like_it = std::ranges::find(machines_, one.setting, &ExaminedMachine::setting);
    const bool is_alike = alike[static_cast<std::size_t>(one.setting)] != 0;
    if (!is_alike || like_it == machines_.end()) {
      machines_.push_back(one);
      if (is_alike) machines_.back().draw.reset();
    } else {
      like_it->softest = std::min(like_it->softest, one.softest);
      like_it->stiffest = std::max(like_it->stiffest, one.stiffest);
    }
  }
  // The softest and the stiffest in each setting.
  for (std::int64_t setting = 0; setting < indices.settings.total(); ++setting) {
    std::optional<std::size_t> softest, stiffest;
    for (std::size_t i = 0; i < machines_.size(); ++i) {
      if (machines_[i].setting != setting) continue;
      if (!softest || machines_[i].softest < machines_[*softest].softest) softest = i;
      if (!stiffest || machines_[i].stiffest > machines_[*stiffest].stiffest) stiffest = i;
    }
    add_critical(*softest);
    add_critical(*stiffest);
  }
}

void LoopExaminer::add_critical(std::size_t machine) {
  for (const std::size_t corner : likely_worst_corners(machines_[machine].spread)) {
    const Corner one{machine, corner};
    if (std::ranges::find(critical_, one) == critical_.end()) critical_.push_back(one);
  }
}

std::vector<LoopExaminer::Corner> LoopExaminer::examined_corners() const {
  std::vector<Corner> corners;
  for (std::size_t machine = 0; machine < machines_.size(); ++machine) {
    const study::LoopSpread& spread = machines_[machine].spread;
    if (machines_[machine].draw) {
      for (const std::size_t corner : likely_worst_corners(spread)) corners.push_back({machine, corner});
    } else {
      const std::size_t count = corners_of({}, spread).size();
      for (std::size_t corner = 0; corner < count; ++corner) corners.push_back({machine, corner});
    }
  }
  return corners;
}

Examination LoopExaminer::at(const Corner& corner, const study::Study& candidate, bool slides) const {
  const ExaminedMachine& machine = machines_[corner.machine];
  const trial::TrialParameters p = study::study_trial(candidate, 0, machine.trial).parameters;
  return {corners_of(p, machine.spread)[corner.corner], machine, slides};
}

bool LoopExaminer::may_keep(const study::Study& candidate, const study::LoopMargins& margins,
                            bool slides) const {
  if (!is_wanted(margins)) return true;
  return parallel::holds_for_all(
      critical_.size(),
      [&](std::size_t i) { return keeps_margins(at(critical_[i], candidate, slides), margins); },
      "margins of a machine");
}

double LoopExaminer::shortfall(const study::Study& candidate, const study::LoopMargins& margins,
                               bool slides) const {
  if (!is_wanted(margins)) return 0.0;
  std::vector<double> found(critical_.size());
  parallel::for_each_index(
      critical_.size(),
      [&](std::size_t i) { found[i] = shortfall_of(at(critical_[i], candidate, slides), margins); },
      "shortfall of a machine");
  return std::accumulate(found.begin(), found.end(), 0.0, [](double a, double b) { return std::max(a, b); });
}

bool LoopExaminer::keeps(const study::Study& candidate, const study::LoopMargins& margins, bool slides,
                         const std::stop_token& stop) {
  if (!is_wanted(margins)) return true;
  const std::vector<Corner> corners = examined_corners();
  std::vector<char> kept(corners.size(), 1);
  parallel::for_each_index(
      corners.size(),
      [&](std::size_t i) {
        if (stop.stop_requested()) throw trial::Interrupted{};
        kept[i] = keeps_margins(at(corners[i], candidate, slides), margins) ? 1 : 0;
      },
      "margins of machines");
  const auto broken = std::ranges::find(kept, 0);
  if (broken == kept.end()) return true;
  const Corner& first = corners[static_cast<std::size_t>(broken - kept.begin())];
  if (std::ranges::find(critical_, first) == critical_.end()) critical_.push_back(first);
  return false;
}

SmallestMargins LoopExaminer::margins_of(const study::Study& candidate, bool slides,
                                         const std::stop_token& stop) const {
  const std::vector<Corner> corners = examined_corners();
  std::vector<SmallestMargins> found(corners.size());
  parallel::for_each_index(
      corners.size(),
      [&](std::size_t i) {
        if (stop.stop_requested()) throw trial::Interrupted{};
        found[i] = margins_of_machine(at(corners[i], candidate, slides));
      },
      "margins of machines");
  SmallestMargins all;
  all.machines = examined_;
  if (!machines_.empty()) all.spread = machines_.front().spread;
  all.settings.resize(static_cast<std::size_t>(settings_), all);
  for (std::size_t i = 0; i < found.size(); ++i) {
    include(all, found[i]);
    if (settings_ > 0)
      include(all.settings[static_cast<std::size_t>(machines_[corners[i].machine].setting)], found[i]);
  }
  return all;
}

std::optional<double> LoopExaminer::lowest_mode(const study::Study& candidate, bool slides,
                                                const std::stop_token& stop) const {
  const auto bears = [&](double frequency) {
    if (stop.stop_requested()) throw trial::Interrupted{};
    return std::ranges::all_of(critical_, [&](const Corner& corner) {
      Examination one = at(corner, candidate, slides);
      one.p.plant = theory::with_load_mode(one.p.plant, frequency);
      return none_unstable(loops_of(one));
    });
  };
  if (is_blind()) return std::nullopt;
  const trial::TrialParameters first = study::study_trial(candidate, 0, machines_.front().trial).parameters;
  double borne = 0.5 * first.controller.sample_rate;
  if (motion::has_load(first.plant) || !bears(borne)) return std::nullopt;
  while (borne > lowest_mode_tried && bears(borne / frequency_ratio)) borne /= frequency_ratio;
  return borne;
}

}  // namespace zerocount::tuning
