#include "experiments/study/effects.hpp"

#include <algorithm>
#include <array>

#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/phase_path.hpp"

namespace zerocount::study {
namespace {

using F = StudyFeatures;
using R = random::TrialRandomness;
using parameters::joined;
using random::RandomKey;

bool has_history(const StudyPlan& plan) {
  constexpr std::array both{parameter::initial::history::reversals, parameter::initial::history::torque};
  return holds_somewhere(plan, both, [](const Ranges& of) {
    return std::ranges::all_of(of.all(), [](const ParameterRange& range) { return range.high > 0.0; });
  });
}

bool has_spectra(const StudyPlan& plan) {
  return !plan.common.disturbance.spectra.empty() || !plan.common.load_side.disturbance.spectra.empty();
}

/// The entries in the table of effects for the errors of one encoder.
/// @tparam Handles a parameter::EncoderErrors
/// @tparam streams beginning of the names of their random numbers, which never change
template <class Handles, parameters::Literal streams>
constexpr std::array<Effect, 4> errors_of(RandomKey R::*noise, RandomKey R::*missed) {
  constexpr const char* errors = "no other encoder errors";
  constexpr auto all = &F::encoder_errors;
  constexpr RandomKey R::*none = nullptr;
  return {{
      {Handles::noise,
       "no encoder noise",
       all,
       noise,
       joined<streams, ".noise/samples">,
       {},
       Handles::noise_bandwidth},
      {Handles::eccentricity, errors, all, none, {}, {}, Handles::eccentricity_angle, true},
      {Handles::interpolation, errors, all, none, {}, {}, Handles::interpolation_period, true},
      {Handles::missed, errors, all, missed, joined<streams, ".missed/samples">},
  }};
}

constexpr auto of_fine =
    errors_of<parameter::encoder::fine_errors, "encoder.fine_errors">(&R::fine_noise, &R::fine_missed);
constexpr auto of_coarse = errors_of<parameter::encoder::coarse_errors, "encoder.coarse_errors">(
    &R::coarse_noise, &R::coarse_missed);
constexpr auto of_load = errors_of<parameter::encoder::load::fine_errors, "encoder.load.fine_errors">(
    &R::other_noise, &R::other_missed);
constexpr const char* converter = "ideal converter";
constexpr const char* disturbance = "no disturbance";

constexpr std::array more{
    Effect{parameter::controller::delay, "no delay"},
    Effect{parameter::controller::jitter, "no jitter", nullptr, &R::jitter, "controller.jitter/samples"},
    Effect{parameter::controller::missed, {}, nullptr, &R::missed_samples, "controller.missed/samples"},
    Effect{parameter::amplifier::bandwidth, "ideal amplifier", &F::drive_torque},
    Effect{parameter::dac::offset, converter, &F::drive_torque},
    Effect{parameter::dac::gain_error, converter, &F::drive_torque},
    Effect{parameter::dac::nonlinearity, converter, &F::drive_torque},
    Effect{parameter::dac::noise, converter, &F::drive_torque, &R::dac_noise, "dac.noise/samples"},
    Effect{parameter::plant::load::inertia, "rigid", &F::load},
    Effect{"initial.history", {}, nullptr, &R::history, "initial.history/levels", has_history},
    Effect{parameter::disturbance::torque, disturbance},
    Effect{parameter::disturbance::ripple::amplitude, disturbance},
    Effect{parameter::disturbance::vibration::amplitude, disturbance},
    Effect{parameter::disturbance::load::torque, disturbance},
    Effect{parameter::disturbance::load::ripple::amplitude, disturbance},
    Effect{parameter::disturbance::load::vibration::amplitude, disturbance},
    Effect{"disturbance.vibration.#.spectrum", disturbance, nullptr, &R::spectrum,
           "disturbance.vibration/spectrum", has_spectra}};

/// Whether this row of the study's table of parameters is the parameter that switches the effect on.
bool is_of(const Effect& effect, const parameters::Parameter& row) {
  const bool of_element = effect.parameter.find('#') != std::string_view::npos;
  return parameters::has_value(row) && (of_element ? parameters::without_indices(row.name) == effect.parameter
                                                   : row.name == effect.parameter);
}

PremiseState state_of(const Effect& effect, const StudyPlan& plan) {
  if (acts(plan, effect)) return PremiseState::considered;
  for (std::size_t slot = 0; slot < plan.table.rows.size(); ++slot)
    if (plan.given[slot] && is_of(effect, plan.table.rows[slot])) return PremiseState::stated_none;
  return PremiseState::assumed;
}

bool is_of_the_control_loop(const Effect& effect) {
  return effect.parameter.starts_with("encoder.") || effect.parameter.starts_with("controller.");
}

}  // namespace

std::span<const Effect> effects() {
  static const std::vector<Effect> all = [] {
    std::vector<Effect> rows;
    for (const auto& of_encoder : {of_fine, of_coarse, of_load})
      rows.insert(rows.end(), of_encoder.begin(), of_encoder.end());
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
  }();
  return all;
}

bool can_be_nonzero(const ParameterRange& range) {
  return range.low != 0.0 || range.high != 0.0;
}

bool acts(const StudyPlan& plan, const Effect& effect) {
  if (effect.acts != nullptr) return effect.acts(plan);
  return std::ranges::any_of(plan.table.rows, [&](const parameters::Parameter& row) {
    return is_of(effect, row) && holds_somewhere(plan, row.name, can_be_nonzero);
  });
}

std::vector<Premise> premises_of(const StudyPlan& plan) {
  std::vector<Premise> premises;
  for (const Effect& effect : effects()) {
    if (effect.assumption.empty() || (plan.open_loop && is_of_the_control_loop(effect))) continue;
    auto premise = std::ranges::find(premises, effect.assumption, &Premise::assumption);
    if (premise == premises.end()) premise = premises.insert(premises.end(), {effect.assumption});
    premise->state = std::min(premise->state, state_of(effect, plan));
  }
  return premises;
}

}  // namespace zerocount::study
