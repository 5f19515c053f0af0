#include "experiments/study/trial_draws.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/designs/designs.hpp"

namespace zerocount::study {
namespace {

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
  const auto count = static_cast<std::uint64_t>(draw_count(study, level));
  switch (level) {
    case DrawLevel::study:
      return design_uniform(design, randomness, 0, 0, count);
    case DrawLevel::world:
      return design_uniform(Design::latin_hypercube, randomness, 0, draws.world, count);
    case DrawLevel::machine:
      return design_uniform(design, randomness, 0, draws.machine, count);
    case DrawLevel::trial:
    case DrawLevel::contact:
      break;
  }
  return design_uniform(study.design, randomness, draws.stream, source_trial(draws, slot), count);
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

/// The quantile of a distribution of the plan at the probability u in (0, 1).
/// @param distribution index in the plan's distributions
double drawn_quantile(const TrialDraws& draws, std::size_t distribution, double u) {
  const distributions::Distribution& of_plan = draws.plan().distributions[distribution];
  if (draws.quantiles == nullptr) return distributions::quantile(of_plan, u);
  std::optional<distributions::QuantileFunction>& kept = (*draws.quantiles)[distribution];
  if (!kept) kept.emplace(of_plan);
  return (*kept)(u);
}

/// Factor by which a value is multiplied at the age of a point of the plan; 1 if it does not change with age.
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

/// The value of a slot (a parameter in the plan) at the age of the point: `number` times `factor`.
/// @throws Failure (bad_input) if it is outside the range of the parameter; the checks of the manifest have
///        not seen this draw
double at_age(const TrialDraws& draws, std::uint32_t slot, std::size_t point, double number, double factor) {
  const StudyPlan& plan = draws.plan();
  const parameters::Parameter& parameter = plan.table.rows[slot];
  const numerics::Interval& range = parameter.range;
  if (numerics::contains(range, number * factor)) return number * factor;
  throw Failure(
      ExitCode::bad_input,
      fmt::format("{}: {:.6g} at age 0 is {:.6g} at {}; expected {}", parameter.name, number, number * factor,
                  age_text(draws.study.settings.ages, age_at(plan, point)), numerics::range_text(range)));
}

std::int64_t rotor_of(const TrialDraws& draws, const Value& profile) {
  if (profile.level != DrawLevel::machine) return 0;
  return draws.given.rotor.value_or(static_cast<std::int64_t>(draws.index) % draws.study.machines);
}

const GivenProfile* given_profile(const TrialDraws& draws, std::uint32_t slot) {
  const auto given = draws.given.profiles.find(slot);
  return given == draws.given.profiles.end() ? nullptr : &given->second;
}

/// The friction parameter of the slot along the axis at age 0, for a trial that begins at the position
/// `start`.
std::shared_ptr<const friction::Profile> profile_of(const TrialDraws& draws, std::uint32_t slot,
                                                    const Value& value, double start) {
  const Rotors& rotors = *draws.plan().profiles[value.index];
  const GivenProfile* const given = given_profile(draws, slot);
  if (given == nullptr) return rotors.rotor(rotor_of(draws, value));
  return std::make_shared<const friction::Profile>(
      rotors.rotor_with(rotor_of(draws, value), given->mean, given->field, given->position.value_or(start)));
}

}  // namespace

TrialDraws draws_of(const Study& study, std::int64_t point, std::int64_t draw, const GivenDraws& given) {
  const auto trial = static_cast<std::uint64_t>(given.number.value_or(draw));
  const auto machines = static_cast<std::uint64_t>(study.machines);
  const auto place_in = [&study](Grouping grouping, std::uint64_t unit) {
    return place_in_groups(study.design, study.plan->sobol_places[grouping], unit,
                           static_cast<std::uint64_t>(group_count(study, grouping)));
  };
  return {study,
          trial,
          place_in(machines > 0 ? Grouping::machine : Grouping::world, trial),
          machines > 0 ? place_in(Grouping::world, trial % machines) : 0,
          study.worlds > 0 ? static_cast<std::uint64_t>(given.world.value_or(draw % study.worlds)) : 0,
          study.independent_points ? static_cast<std::uint32_t>(point) + 1 : 0,
          given};
}

TrialPlace place_of(const Study& study, std::int64_t point, std::int64_t index) {
  check_exists(study, point, index);
  const TrialIndices indices = trial_indices(study);
  return {plan_point(*study.plan, point, indices.setting_of(index)), indices.draw_of(index)};
}

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

double drawn_number(const TrialDraws& draws, std::uint32_t slot, const Value& value, std::size_t point) {
  const double number = value.kind == Value::Kind::distribution
                            ? drawn_quantile(draws, value.index, uniform_of(draws, slot, value.level))
                            : value.number;
  return value.aging ? at_age(draws, slot, point, number, age_factor_of(draws, value, point)) : number;
}

double number_at(const TrialDraws& draws, std::uint32_t slot, std::size_t point) {
  const Value& value = *value_at_point(draws.plan(), slot, point);
  return value.kind == Value::Kind::derived
             ? derived_value(draws.plan().derived[value.index],
                             [&](std::uint32_t source) { return number_at(draws, source, point); })
             : drawn_number(draws, slot, value, point);
}

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

double profile_mean(const TrialDraws& draws, std::uint32_t slot, std::size_t point) {
  const Value& value = *value_at_point(draws.plan(), slot, point);
  if (value.kind != Value::Kind::profile) return std::numeric_limits<double>::quiet_NaN();
  const GivenProfile* const given = given_profile(draws, slot);
  const Rotors& rotors = *draws.plan().profiles[value.index];
  return age_factor_of(draws, value, point) * (given != nullptr && given->mean
                                                   ? rotors.mean_at(*given->mean)
                                                   : rotors.mean(rotor_of(draws, value)));
}

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

}  // namespace zerocount::study
