#include "core/friction/law.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/study/effects.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/point_limits.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {
namespace {

bool can_be_positive(const ParameterRange& range) {
  return range.high > 0.0;
}
bool has_zero(const ParameterRange& range) {
  return range.can_be_zero;
}

bool is_shape(const ParameterRange& range, loop::ReferenceShape shape) {
  return range.low == static_cast<double>(shape);
}
bool is_sine(const ParameterRange& shape) {
  return is_shape(shape, loop::ReferenceShape::sine);
}
bool moves_for_ever(const ParameterRange& shape) {
  return is_sine(shape) || is_shape(shape, loop::ReferenceShape::record);
}
bool has_an_end(const ParameterRange& shape) {
  return !moves_for_ever(shape);
}
bool is_travel(const ParameterRange& shape) {
  return is_shape(shape, loop::ReferenceShape::trapezoidal) || is_shape(shape, loop::ReferenceShape::s_curve);
}

// Friction that holds the rotor without any travel causes hunting with integral control.
bool causes_hunting(const ParameterRange& model) {
  const friction::LawTraits& law =
      friction::traits_of(static_cast<friction::FrictionModel>(static_cast<int>(model.low)));
  return !law.has_presliding_motion && law.breakaway == friction::Breakaway::of_hook;
}

// A pure delay of the closed loop does not count: the motor torque is the commanded one of an earlier sample.
bool has_delayed_torque(const StudyPlan& plan) {
  const auto is_exact = [](const ParameterRange& through) {
    return through.high == static_cast<double>(trial::TorquePath::exact);
  };
  return plan.open_loop && (holds_somewhere(plan, parameter::command::torque::through, is_exact) ||
                            holds_somewhere(plan, parameter::controller::delay, can_be_positive));
}

bool is_spread(Design design) {
  switch (design) {
    case Design::latin_hypercube:
    case Design::sobol:
      return true;
    case Design::monte_carlo:
    case Design::saltelli:
      break;
  }
  return false;
}

}  // namespace

StudyFeatures find_features(const StudyPlan& plan, const Study& study) {
  const bool closed_loop = !plan.open_loop;
  StudyFeatures features;
  features.axis = plan.units.axis;
  features.open_loop = plan.open_loop;
  features.travel = closed_loop && holds_somewhere(plan, parameter::command::profile::shape, is_travel);
  features.phases = closed_loop && holds_somewhere(plan, parameter::controller::coarse::coarse_beyond,
                                                   can_have_coarse_phase);
  features.drive_torque = has_delayed_torque(plan);
  for (const Effect& effect : effects())
    if (effect.feature != nullptr && !(features.*effect.feature))
      features.*effect.feature = acts(plan, effect);
  features.motor_closes = closed_loop && closes_somewhere(plan, motion::EncoderPlace::motor);
  features.load_closes = closed_loop && closes_somewhere(plan, motion::EncoderPlace::load);
  const auto closes_at = [&](bool load) {
    return features.load && holds_somewhere(plan, two_encoders, [&](const Ranges& of) {
             return has_two_encoders(of) && closes_at_load(of) == load;
           });
  };
  features.load_count = closes_at(false);
  features.motor_count = closes_at(true);
  features.own_controller = plan.plugin != nullptr;
  const bool follows =
      closed_loop && holds_somewhere(plan, parameter::command::profile::shape, moves_for_ever);
  features.final_error = features.own_controller || features.travel || follows || features.phases ||
                         holds_somewhere(plan, parameter::controller::ki, has_zero) ||
                         holds_somewhere(plan, parameter::controller::deadband::enter, can_be_positive) ||
                         holds_somewhere(plan, parameter::friction::model, causes_hunting);
  features.stopping = closed_loop && holds_somewhere(plan, parameter::verdict::stop, can_be_positive);
  features.motion = closed_loop && holds_somewhere(plan, parameter::verdict::motion, can_be_positive);
  features.following = features.motion && (features.travel || follows);
  features.steps = features.motion && holds_somewhere(plan, parameter::command::profile::shape, has_an_end);
  features.reversals = features.motion && holds_somewhere(plan, parameter::command::profile::shape, is_sine);
  features.dependent_trials = study.design == Design::saltelli;
  features.bands = plan.common.verdict.bands;
  features.tolerances = plan.common.verdict.tolerances;
  features.position_error = plan.common.verdict.position_error;
  features.load_error = plan.common.verdict.other_mass == motion::EncoderPlace::load;
  features.motor_error = plan.common.verdict.other_mass == motion::EncoderPlace::motor;
  features.machines = study.machines > 0 && closed_loop;
  features.spread_trials = is_spread(study.design);
  return features;
}

}  // namespace zerocount::study
