#include "experiments/study/study_trial.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/loop/reference.hpp"
#include "experiments/designs/designs.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/measured_machines.hpp"
#include "experiments/study/trial_draws.hpp"

namespace zerocount::study {
namespace {

// The trial from which it takes the random numbers used while it runs.
std::uint64_t numbers_within_trial(const Study& study, std::uint64_t index, const GivenDraws& given) {
  if (study.design != Design::saltelli || given.number) return index;
  const TrialFactors& factors = study.plan->factors;
  return designs::saltelli_source(index, factors.slots.size(), factor_count(factors));
}

// The range of the converter, where it is given, takes precedence over the resolution.
void set_resolution(const std::vector<double>& numbers, loop::DacParameters& dac) {
  static const std::size_t range = parameters::find_parameter(parameter::dac::range).value();
  if (numbers[range] > 0.0) dac.resolution = std::ldexp(numbers[range], 1 - dac.bits);
}

// A recorded reference without a hold of its own lasts until its last row and one sample of the controller.
void set_hold_of_record(const StudyPlan& plan, trial::TrialParameters& trial) {
  static const std::size_t hold = parameters::find_parameter(parameter::command::hold).value();
  if (trial.command.profile.record && !plan.given[hold])
    trial.command.hold =
        loop::record_duration(trial.command.profile.record->time, 1.0 / trial.controller.sample_rate);
}

/// Converts gains and targets of a trial to the units of the simulation, after all its numbers are set.
void complete(const Study& study, StudyTrial& trial) {
  complete_trial(study.units, trial.parameters);
  complete_targets(trial);
}

/// A trial whose parameters are being set, with memory for the numbers.
struct TrialInProgress {
  StudyTrial& trial;
  std::vector<double>& numbers;  ///< [slot] number of the trial for each slot (parameter in the plan)
  const StudyPlan& plan;

  void set(std::size_t slot, double number) {
    numbers[slot] = number;
    // Without a field are the targets and the overrun of a sequence, which determine those of the moves.
    if (const auto& set_field = plan.table.rows[slot].set) set_field(trial.parameters, number);
  }
};

/// Sets a parameter whose value is computed from other slots (parameters in the plan). The numbers of these
/// slots must be set.
void set_derived(const TrialDraws& draws, std::size_t point, std::uint32_t slot, TrialInProgress& t) {
  const DerivedValue& derived = t.plan.derived[value_at_point(t.plan, slot, point)->index];
  t.set(slot, derived_value(derived, [&](std::uint32_t source) { return t.numbers[source]; }));
  std::map<std::uint32_t, std::function<double(std::uint64_t)>> per_contact;  // by source
  for (const std::uint32_t source : derived.from) {
    const Value& value = *value_at_point(t.plan, source, point);
    if (is_drawn_per_contact(value))
      per_contact.emplace(source, value_per_contact(draws, source, value, point));
  }
  if (per_contact.empty()) return;
  t.trial.parameters.friction.per_contact.push_back(
      {t.plan.table.rows[slot].profiled, [derived, per_contact, numbers = t.numbers](std::uint64_t contact) {
         return derived_value(derived, [&](std::uint32_t source) {
           const auto drawn = per_contact.find(source);
           return drawn == per_contact.end() ? numbers[source] : drawn->second(contact);
         });
       }});
}

/// Refuses a trial with measured values that no machine can have. The checks of the manifest have not seen
/// this draw.
void require_machine(std::size_t point, const TrialInProgress& t) {
  for (const MeasuredSlots& measured : t.plan.measured) {
    const auto fault = fault_of_machine(t.plan, point, measured, [&](std::uint32_t slot) {
      return std::pair(t.numbers[slot], t.numbers[slot]);
    });
    if (fault)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: a drawn value is impossible for a machine: {}; expected {}",
                                t.plan.table.rows[fault->slots.front()].name, fault->what, fault->expected));
  }
}

/// Sets all values of a trial except friction parameters that vary along the axis.
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
    if (value_at_point(plan, slot, point)->kind == Value::Kind::derived) set_derived(draws, point, slot, t);
  }
  require_machine(point, t);
}

/// Makes the parameters of a trial with all numbers in the units of the manifest; see study_trial_as_given().
/// @param point point of the plan (a design point in a setting)
/// @param numbers memory for the numbers, [slot]
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
  set_hold_of_record(plan, trial.parameters);
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

}  // namespace zerocount::study
