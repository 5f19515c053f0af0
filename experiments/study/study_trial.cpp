#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <span>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/designs/saltelli.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/machine_inputs.hpp"
#include "experiments/study/measured_machines.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/trial_drawer.hpp"

namespace zerocount::study {
namespace {

using QuantileFunctions = std::vector<std::optional<distributions::QuantileFunction>>;

// The coordinates of a trial's random numbers.
struct TrialDraws {
  const Study& study;
  std::uint64_t index;   ///< of the trial among those of its condition (TrialTurns::draw_of)
  std::uint64_t place;   ///< index of its point in the design
  std::uint64_t rig;     ///< index of its rig in the design, as `place`; 0 without rigs
  std::uint64_t world;   ///< 0 without worlds
  std::uint32_t stream;  ///< of values drawn per trial, not per rig
  const GivenDraws& given;
  QuantileFunctions* quantiles{nullptr};  ///< [distribution of the plan]; null: none are kept

  const StudyPlan& plan() const { return *study.plan; }
};

/// @param draw TrialTurns::draw_of the trial
TrialDraws draws_of(const Study& study, std::int64_t point, std::int64_t draw, const GivenDraws& given) {
  const auto trial = static_cast<std::uint64_t>(given.number.value_or(draw));
  const auto rigs = static_cast<std::uint64_t>(study.rigs);
  const auto worlds = static_cast<std::uint64_t>(study.worlds);
  const std::uint64_t rig = rigs > 0 ? trial % rigs : 0;
  const StudyPlan& plan = *study.plan;
  return {study,
          trial,
          rigs > 0 ? place_in_groups(study.design, plan.sobol_places, trial, rigs)
                   : place_in_groups(study.design, plan.sobol_places_of_worlds, trial, worlds),
          rigs > 0 ? place_in_groups(study.design, plan.sobol_places_of_worlds, rig, worlds) : 0,
          worlds > 0 ? static_cast<std::uint64_t>(given.world.value_or(draw % study.worlds)) : 0,
          study.independent_points ? static_cast<std::uint32_t>(point) + 1 : 0,
          given};
}

// The trial from which this trial takes the number of a slot.
std::uint64_t source_trial(const TrialDraws& draws, std::uint32_t slot) {
  if (draws.study.design != Design::saltelli) return draws.place;
  return designs::saltelli_source(draws.index, draws.plan().factor_of[slot],
                                  factor_count(draws.plan().factors));
}

double drawn_uniform(const TrialDraws& draws, std::uint32_t slot, DrawLevel level) {
  const Study& study = draws.study;
  const SlotRandomness& randomness = draws.plan().randomness[slot];
  const Design design = randomness.no_directions ? Design::latin_hypercube : study.design;
  switch (level) {
    case DrawLevel::study:
      return design_uniform(design, randomness, 0, 0, 1);
    case DrawLevel::world:
      return design_uniform(Design::latin_hypercube, randomness, 0, draws.world,
                            static_cast<std::uint64_t>(study.worlds));
    case DrawLevel::rig:
      return design_uniform(design, randomness, 0, draws.rig, static_cast<std::uint64_t>(study.rigs));
    case DrawLevel::trial:
    case DrawLevel::contact:
      break;
  }
  return design_uniform(study.design, randomness, draws.stream, source_trial(draws, slot),
                        static_cast<std::uint64_t>(draw_count(study)));
}

/// The uniform number of a drawn value, with the copula of the study.
double uniform_of(const TrialDraws& draws, std::uint32_t slot, DrawLevel level) {
  const auto given = draws.given.uniforms.find(slot);
  if (given != draws.given.uniforms.end()) return given->second;
  const std::optional<GaussianCopula>& copula = draws.plan().copula;
  if (!copula) return drawn_uniform(draws, slot, level);
  const auto member = std::find(copula->slots.begin(), copula->slots.end(), slot);
  if (member == copula->slots.end()) return drawn_uniform(draws, slot, level);
  return copula_uniform(*copula, static_cast<std::size_t>(member - copula->slots.begin()),
                        [&](std::size_t j) { return drawn_uniform(draws, copula->slots[j], copula->level); });
}

/// By which the value of a slot at a point of the plan is multiplied at the point's age.
double age_factor_of(const TrialDraws& draws, const Value& value, std::size_t point) {
  if (!value.aging) return 1.0;
  const StudyPlan& plan = draws.plan();
  const Aging& aging = plan.agings[*value.aging];
  const Value& rate = *value_at_point(plan, aging.rate, point);
  return factor_at_age(aging,
                       rate.kind == Value::Kind::number
                           ? rate.number
                           : distributions::quantile(plan.distributions[rate.index],
                                                     uniform_of(draws, aging.rate, rate.level)),
                       age_at(plan, point));
}

/// The number at the age of the point. Refuses one that has left its range: a draw that no check has seen.
double at_age(const TrialDraws& draws, std::uint32_t slot, std::size_t point, double number, double factor) {
  const StudyPlan& plan = draws.plan();
  const parameters::Parameter& parameter = plan.table.rows[slot];
  const numerics::Interval& range = parameter.range;
  if (numerics::contains(range, number * factor)) return number * factor;
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: {:.6g} at age 0 is {:.6g} at {}; expected {}", parameter.name, number, number * factor,
                  age_text(draws.study.ages, age_at(plan, point)), numerics::range_text(range)));
}

/// The value of a slot that is drawn at each contact, by the contact's number.
std::function<double(std::uint64_t contact)> value_per_contact(const TrialDraws& draws, std::uint32_t slot,
                                                               const Value& value, std::size_t point) {
  const std::uint64_t trial =
      draws.study.design == Design::saltelli && !draws.given.number ? source_trial(draws, slot) : draws.index;
  const random::RandomStream stream{.key = draws.plan().randomness[slot].contacts, .stream = draws.stream};
  const std::shared_ptr<const StudyPlan> plan = draws.study.plan;  // the trial may outlive the study
  return [plan, stream, trial, index = value.index,
          factor = age_factor_of(draws, value, point)](std::uint64_t contact) {
    return factor * distributions::quantile(plan->distributions[index],
                                            friction::contact_uniform(stream, trial, contact));
  };
}

std::int64_t rotor_of(const TrialDraws& draws, const Value& profile) {
  if (profile.level != DrawLevel::rig) return 0;
  return draws.given.rotor.value_or(static_cast<std::int64_t>(draws.index) % draws.study.rigs);
}

const GivenProfile* given_profile(const TrialDraws& draws, std::uint32_t slot) {
  const auto given = draws.given.profiles.find(slot);
  return given == draws.given.profiles.end() ? nullptr : &given->second;
}

double profile_mean(const TrialDraws& draws, std::uint32_t slot, std::size_t point) {
  const Value& value = *value_at_point(draws.plan(), slot, point);
  if (value.kind != Value::Kind::profile) return std::numeric_limits<double>::quiet_NaN();
  const GivenProfile* const given = given_profile(draws, slot);
  const Rotors& rotors = *draws.plan().profiles[value.index];
  return age_factor_of(draws, value, point) * (given != nullptr && given->mean
                                                   ? rotors.mean_at(*given->mean)
                                                   : rotors.mean(rotor_of(draws, value)));
}

/// The profile of a trial that begins at this position, at age 0.
std::shared_ptr<const friction::Profile> profile_of(const TrialDraws& draws, std::uint32_t slot,
                                                    const Value& value, double start) {
  const Rotors& rotors = *draws.plan().profiles[value.index];
  const GivenProfile* const given = given_profile(draws, slot);
  if (given == nullptr) return rotors.rotor(rotor_of(draws, value));
  return std::make_shared<const friction::Profile>(
      rotors.rotor_with(rotor_of(draws, value), given->mean, given->field, given->position.value_or(start)));
}

/// The profile at the age of the point: the law multiplies all of it.
std::shared_ptr<const friction::Profile> profile_at_age(const TrialDraws& draws, std::uint32_t slot,
                                                        std::size_t point, double start) {
  const Value& value = *value_at_point(draws.plan(), slot, point);
  std::shared_ptr<const friction::Profile> profile = profile_of(draws, slot, value, start);
  const double factor = age_factor_of(draws, value, point);
  if (factor == 1.0) return profile;
  auto aged = std::make_shared<const friction::Profile>(friction::scaled(*profile, factor));
  const parameters::Parameter& parameter = draws.plan().table.rows[slot];
  if (factor > 0.0 && numerics::contains(parameter.range, distributions::limits(*aged)))
    return aged;  // a fast sufficient test
  const friction::ValueRange values = friction::range_over_revolution(*profile);
  at_age(draws, slot, point, values.low, factor);
  at_age(draws, slot, point, values.high, factor);
  return aged;
}

// The trial from which it takes the random numbers used while it runs.
std::uint64_t numbers_within_trial(const Study& study, std::uint64_t index, const GivenDraws& given) {
  if (study.design != Design::saltelli || given.number) return index;
  const TrialFactors& factors = study.plan->factors;
  return designs::saltelli_source(index, factors.slots.size(), factor_count(factors));
}

// Target of a move in the manifest's unit.
double listed_target(const Study& study, const std::vector<double>& numbers, std::size_t move) {
  static const std::size_t overrun = parameters::find_parameter("command.sequence.overrun").value();
  const std::span<const double> targets = std::span(numbers).subspan(study.plan->list.first);
  if (!study.plan->sequence) return targets[move];
  return sequence_position(study.sequence[move], targets, numbers[overrun]);
}

// Sets the targets of a sequence, and the positions of targets in SI units.
void set_targets(const Study& study, const std::vector<double>& numbers, StudyTrial& trial) {
  std::vector<std::int64_t>& targets = trial.parameters.command.targets;
  const bool si = study.units.targets == parameters::TargetUnits::si;
  if (!si && !study.plan->sequence) return;
  for (std::size_t move = 0; move < targets.size(); ++move) {
    const double target = listed_target(study, numbers, move);
    if (si) {
      trial.target_positions.push_back(target);
    } else {
      targets[move] = static_cast<std::int64_t>(target);
    }
  }
}

// The range of the converter, where it is given, takes precedence over the resolution.
void set_resolution(const std::vector<double>& numbers, loop::DacParameters& dac) {
  static const std::size_t range = parameters::find_parameter("dac.range").value();
  if (numbers[range] > 0.0) dac.resolution = std::ldexp(numbers[range], 1 - dac.bits);
}

// Targets in SI units become the nearest counts of the fine encoder.
void round_targets(StudyTrial& trial) {
  const double count = loop::fine_resolution(trial.parameters.encoder);
  for (std::size_t move = 0; move < trial.target_positions.size(); ++move)
    trial.parameters.command.targets[move] = std::llrint(trial.target_positions[move] / count);
  if (trial.parameters.verdict.position_error)
    trial.parameters.command.exact_targets = trial.target_positions;
}

/// Completes a trial of which all numbers are set.
void complete(const Study& study, StudyTrial& trial) {
  complete_trial(study.units, trial.parameters);
  round_targets(trial);
}

void check_exists(const Study& study, std::int64_t point, std::int64_t index) {
  if (point < 0 || point >= point_count(study)) {
    throw Failure(ExitCode::bad_input, fmt::format("study {} has no design point {}; expected 0 to {}",
                                                   study.name, point, point_count(study) - 1));
  }
  if (index < 0 || index >= study.trials) {
    throw Failure(ExitCode::bad_input, fmt::format("study {} has no trial {}; expected 0 to {}", study.name,
                                                   index, study.trials - 1));
  }
}

/// The value of a distribution of the plan.
double drawn_quantile(const TrialDraws& draws, std::size_t distribution, double u) {
  const distributions::Distribution& of_plan = draws.plan().distributions[distribution];
  if (draws.quantiles == nullptr) return distributions::quantile(of_plan, u);
  std::optional<distributions::QuantileFunction>& kept = (*draws.quantiles)[distribution];
  if (!kept) kept.emplace(of_plan);
  return (*kept)(u);
}

/// A number, or that of a distribution, at the age of the point.
double drawn_number(const TrialDraws& draws, std::uint32_t slot, const Value& value, std::size_t point) {
  const double number = value.kind == Value::Kind::distribution
                            ? drawn_quantile(draws, value.index, uniform_of(draws, slot, value.level))
                            : value.number;
  return value.aging ? at_age(draws, slot, point, number, age_factor_of(draws, value, point)) : number;
}

/// The value of the slot at a point of the plan, which is not a profile.
double number_at(const TrialDraws& draws, std::uint32_t slot, std::size_t point) {
  const Value& value = *value_at_point(draws.plan(), slot, point);
  return value.kind == Value::Kind::following
             ? following_value(draws.plan().following[value.index],
                               [&](std::uint32_t source) { return number_at(draws, source, point); })
             : drawn_number(draws, slot, value, point);
}

/// The inputs that all trials of one rig (or world) share, of its first trial, which has its index.
std::vector<double> inputs_of(const Study& study, std::string_view unit, std::int64_t index,
                              std::int64_t count, const std::vector<InputSource>& sources) {
  if (index < 0 || index >= count) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("study {} has no {} {}; expected 0 to {}", study.name, unit, index, count - 1));
  }
  const StudyPlan& plan = *study.plan;
  const GivenDraws none;
  const TrialDraws draws = draws_of(study, 0, index, none);
  std::vector<double> inputs;
  inputs.reserve(sources.size());
  for (const InputSource& source : sources) {
    const std::size_t place = plan_point(plan, 0, source.condition.value_or(0));
    inputs.push_back(source.profile_mean ? profile_mean(draws, source.slot, place)
                                         : number_at(draws, source.slot, place));
  }
  return inputs;
}

/// A trial by its place: a point of the plan, and its draw.
struct TrialPlace {
  std::size_t point;
  std::int64_t draw;
};

TrialPlace place_of(const Study& study, std::int64_t point, std::int64_t index) {
  check_exists(study, point, index);
  const TrialTurns turns = turns_of(study);
  return {plan_point(*study.plan, point, turns.condition_of(index)), turns.draw_of(index)};
}

/// A trial whose parameters are being set.
struct TrialInProgress {
  StudyTrial& trial;
  std::vector<double>& numbers;  ///< [slot]
  const StudyPlan& plan;

  void set(std::size_t slot, double number) {
    numbers[slot] = number;
    // Without a field are the targets and the overrun of a sequence, which determine those of the moves.
    if (const auto& set_field = plan.table.rows[slot].set) set_field(trial.parameters, number);
  }
};

/// Sets the value that follows from those of other slots, which are set.
void set_following(const TrialDraws& draws, std::size_t point, std::uint32_t slot, TrialInProgress& t) {
  const FollowingValue& following = t.plan.following[value_at_point(t.plan, slot, point)->index];
  t.set(slot, following_value(following, [&](std::uint32_t source) { return t.numbers[source]; }));
  std::map<std::uint32_t, std::function<double(std::uint64_t)>> per_contact;  // by source
  for (const std::uint32_t source : following.from) {
    const Value& value = *value_at_point(t.plan, source, point);
    if (is_drawn_per_contact(value))
      per_contact.emplace(source, value_per_contact(draws, source, value, point));
  }
  if (per_contact.empty()) return;
  t.trial.parameters.friction.per_contact.push_back(
      {t.plan.table.rows[slot].profiled,
       [following, per_contact, numbers = t.numbers](std::uint64_t contact) {
         return following_value(following, [&](std::uint32_t source) {
           const auto drawn = per_contact.find(source);
           return drawn == per_contact.end() ? numbers[source] : drawn->second(contact);
         });
       }});
}

/// Refuses measured values that are those of no machine: a draw that no check has seen.
void require_machine(std::size_t point, const TrialInProgress& t) {
  for (const MeasuredSlots& measured : t.plan.measured) {
    const auto fault = fault_of_machine(t.plan, point, measured, [&](std::uint32_t slot) {
      return std::pair(t.numbers[slot], t.numbers[slot]);
    });
    if (fault)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: a draw is that of no machine: {}; expected {}",
                                t.plan.table.rows[fault->slots.front()].name, fault->what, fault->expected));
  }
}

/// Sets all values but those of profiles.
void begin_trial(const TrialDraws& draws, std::size_t point, TrialInProgress& t) {
  const StudyPlan& plan = t.plan;
  t.trial.parameters = plan.common;
  t.trial.inputs.clear();
  t.trial.target_positions.clear();
  t.numbers = plan.numbers;
  t.trial.parameters.randomness.trial = numbers_within_trial(draws.study, draws.index, draws.given);
  t.trial.parameters.randomness.stream = draws.stream;
  for (const std::uint32_t slot : plan.input_slots) {
    const Value& value = *value_at_point(plan, slot, point);
    if (value.kind != Value::Kind::number && value.kind != Value::Kind::distribution) continue;
    t.set(slot, drawn_number(draws, slot, value, point));
    if (is_drawn_per_contact(value) && plan.table.rows[slot].profiled != nullptr)
      t.trial.parameters.friction.per_contact.push_back(
          {plan.table.rows[slot].profiled, value_per_contact(draws, slot, value, point)});
  }
  for (const std::uint32_t slot : plan.input_slots) {
    if (value_at_point(plan, slot, point)->kind == Value::Kind::following)
      set_following(draws, point, slot, t);
  }
  require_machine(point, t);
}

/// See study_trial_as_given(). @param point of the plan @param numbers memory for them, [slot]
void make_trial(const TrialDraws& draws, std::size_t point, StudyTrial& trial, std::vector<double>& numbers) {
  const StudyPlan& plan = draws.plan();
  TrialInProgress t{trial, numbers, plan};
  begin_trial(draws, point, t);
  // Profiles come last, because they depend on the start position.
  for (const std::uint32_t slot : plan.input_slots) {
    const Value& value = *value_at_point(plan, slot, point);
    if (value.kind != Value::Kind::profile) continue;
    const std::shared_ptr<const friction::Profile> profile =
        profile_at_age(draws, slot, point, trial.parameters.initial.position);
    t.set(slot, friction::value_at(*profile, trial.parameters.initial.position));
    trial.parameters.friction.profiled.push_back({plan.table.rows[slot].profiled, profile});
  }
  set_targets(draws.study, t.numbers, trial);
  set_resolution(t.numbers, trial.parameters.dac);
  trial.inputs.reserve(plan.inputs.size());
  for (const InputSource& source : plan.inputs) {
    trial.inputs.push_back(source.profile_mean ? profile_mean(draws, source.slot, point)
                                               : t.numbers[source.slot]);
  }
}

}  // namespace

StudyTrial study_trial_as_given(const Study& study, std::int64_t point, std::int64_t index,
                                const GivenDraws& given) {
  const TrialPlace place = place_of(study, point, index);
  StudyTrial trial;
  std::vector<double> numbers;
  make_trial(draws_of(study, point, place.draw, given), place.point, trial, numbers);
  return trial;
}

StudyTrial commanded_trial(const Study& study, std::int64_t point, std::int64_t index) {
  const TrialPlace place = place_of(study, point, index);
  const GivenDraws none;
  StudyTrial trial;
  std::vector<double> numbers;
  TrialInProgress t{trial, numbers, *study.plan};
  begin_trial(draws_of(study, point, place.draw, none), place.point, t);
  set_resolution(numbers, trial.parameters.dac);
  set_targets(study, numbers, trial);
  complete(study, trial);
  return trial;
}

StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index) {
  return study_trial(study, point, index, {});
}

StudyTrial study_trial(const Study& study, std::int64_t point, std::int64_t index, const GivenDraws& given) {
  StudyTrial trial = study_trial_as_given(study, point, index, given);
  complete(study, trial);
  return trial;
}

TrialDrawer::TrialDrawer(const Study& study) : study_(study) {}

void TrialDrawer::draw(std::int64_t point, std::int64_t index, StudyTrial& trial) {
  if (plan_ != study_.plan) {
    plan_ = study_.plan;
    quantiles_.clear();
  }
  quantiles_.resize(plan_->distributions.size());
  const TrialPlace place = place_of(study_, point, index);
  const GivenDraws none;
  TrialDraws draws = draws_of(study_, point, place.draw, none);
  draws.quantiles = &quantiles_;
  make_trial(draws, place.point, trial, numbers_);
  complete(study_, trial);
}

std::vector<double> drawn_numbers(const Study& study, std::int64_t point, std::int64_t index,
                                  std::span<const std::uint32_t> slots, const GivenDraws& given) {
  const TrialPlace place = place_of(study, point, index);
  const TrialDraws draws = draws_of(study, point, place.draw, given);
  std::vector<double> numbers;
  numbers.reserve(slots.size());
  for (const std::uint32_t slot : slots)
    numbers.push_back(
        drawn_number(draws, slot, *value_at_point(draws.plan(), slot, place.point), place.point));
  return numbers;
}

std::vector<double> drawn_quantiles(const Study& study, std::int64_t point, std::int64_t index,
                                    const std::vector<MachineInput>& inputs) {
  const TrialPlace place = place_of(study, point, index);
  const GivenDraws none;
  const TrialDraws draws = draws_of(study, point, place.draw, none);
  std::vector<double> quantiles;
  for (const MachineInput& input : inputs) {
    const std::uint32_t slot = input.slots.front();
    const Value& value = *value_at_point(*study.plan, slot, place.point);
    quantiles.push_back(uniform_of(draws, slot, value.level));
  }
  return quantiles;
}

std::vector<double> rig_inputs(const Study& study, std::int64_t rig) {
  return inputs_of(study, "rig", rig, study.rigs, study.plan->rig_inputs);
}

std::vector<double> world_inputs(const Study& study, std::int64_t world) {
  return inputs_of(study, "world", world, study.worlds, study.plan->world_inputs);
}

std::vector<WorldValues> world_values(const Study& study, std::int64_t point) {
  std::vector<WorldValues> found;
  if (study.worlds == 0) return found;
  const StudyPlan& plan = *study.plan;
  const GivenDraws none;
  for (const std::uint32_t slot : plan.input_slots) {
    const Value& value = *value_at_point(plan, slot, plan_point(plan, point));
    if (value.kind != Value::Kind::distribution || value.level != DrawLevel::world) continue;
    const parameters::Parameter& parameter = plan.table.rows[slot];
    WorldValues& values = found.emplace_back(
        WorldValues{std::string(parameter.name), parameters::unit_of(parameter, plan.units), {}});
    for (std::int64_t world = 0; world < study.worlds; ++world) {
      values.values.push_back(
          distributions::quantile(plan.distributions[value.index],
                                  uniform_of(draws_of(study, point, world, none), slot, value.level)));
    }
  }
  return found;
}

}  // namespace zerocount::study
