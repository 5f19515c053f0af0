#pragma once

#include <string_view>

#include "experiments/parameters/phase_path.hpp"

/// The parameters of the table (parameter_table.hpp) by name: parameter::friction::k1. Code refers to a
/// parameter by its handle, so that its dotted path in a manifest stands once, and the compiler finds a wrong
/// name. `#` in a path stands for the index of an element of a list.
namespace zerocount::parameter {

/// A parameter's handle, by which code refers to it. It converts to the dotted path of the parameter in a
/// manifest, but no text converts to a handle.
struct Handle {
  std::string_view path;

  constexpr explicit Handle(std::string_view of) : path(of) {}
  constexpr operator std::string_view() const { return path; }  // NOLINT(google-explicit-constructor)
  friend constexpr bool operator==(const Handle& one, std::string_view path) { return one.path == path; }
  friend constexpr bool operator==(const Handle&, const Handle&) = default;
};

/// Handles of the control parameters that both the fine and the coarse phase of the control have.
template <parameters::Phase phase>
struct Control {
  static constexpr Handle kp{parameters::phase_path<phase, "kp">};
  static constexpr Handle ki{parameters::phase_path<phase, "ki">};
  static constexpr Handle kd{parameters::phase_path<phase, "kd">};
  static constexpr Handle encoder{parameters::phase_path<phase, "encoder">};
  static constexpr Handle structure{parameters::phase_path<phase, "structure">};
  struct cascade {
    static constexpr Handle kv{parameters::phase_path<phase, "cascade.kv">};
    static constexpr Handle kp{parameters::phase_path<phase, "cascade.kp">};
    static constexpr Handle ki{parameters::phase_path<phase, "cascade.ki">};
  };
  struct deadband {
    static constexpr Handle enter{parameters::phase_path<phase, "deadband.enter">};
    static constexpr Handle leave{parameters::phase_path<phase, "deadband.leave">};
  };
  static constexpr Handle integrator_zone{parameters::phase_path<phase, "integrator_zone">};
  static constexpr Handle integrator_leak{parameters::phase_path<phase, "integrator_leak">};
  static constexpr Handle derivative_cutoff{parameters::phase_path<phase, "derivative_cutoff">};
  struct feedforward {
    static constexpr Handle velocity{parameters::phase_path<phase, "feedforward.velocity">};
    static constexpr Handle acceleration{parameters::phase_path<phase, "feedforward.acceleration">};
    static constexpr Handle friction{parameters::phase_path<phase, "feedforward.friction">};
  };
  struct observer {
    static constexpr Handle bandwidth{parameters::phase_path<phase, "observer.bandwidth">};
    static constexpr Handle inertia{parameters::phase_path<phase, "observer.inertia">};
  };
  struct error_deadband {
    static constexpr Handle band{parameters::phase_path<phase, "error_deadband.band">};
    static constexpr Handle form{parameters::phase_path<phase, "error_deadband.form">};
  };
  struct hold {
    static constexpr Handle enter{parameters::phase_path<phase, "hold.enter">};
    static constexpr Handle leave{parameters::phase_path<phase, "hold.leave">};
    static constexpr Handle dwell{parameters::phase_path<phase, "hold.dwell">};
  };
  struct standstill {
    static constexpr Handle band{parameters::phase_path<phase, "standstill.band">};
    static constexpr Handle dwell{parameters::phase_path<phase, "standstill.dwell">};
    static constexpr Handle kp{parameters::phase_path<phase, "standstill.kp">};
    static constexpr Handle ki{parameters::phase_path<phase, "standstill.ki">};
    static constexpr Handle kd{parameters::phase_path<phase, "standstill.kd">};
  };
  struct filters {
    static constexpr Handle frequency{parameters::phase_path<phase, "filters.#.frequency">};
    static constexpr Handle damping{parameters::phase_path<phase, "filters.#.damping">};
    static constexpr Handle depth{parameters::phase_path<phase, "filters.#.depth">};
    static constexpr Handle ratio{parameters::phase_path<phase, "filters.#.ratio">};
    static constexpr Handle b{parameters::phase_path<phase, "filters.#.b">};
    static constexpr Handle a{parameters::phase_path<phase, "filters.#.a">};
  };
};

/// Handles of the parameters of one encoder's errors. `section` is the dotted path of their section in a
/// manifest.
template <parameters::Literal section>
struct EncoderErrors {
  static constexpr Handle eccentricity{parameters::joined<section, ".eccentricity">};
  static constexpr Handle eccentricity_angle{parameters::joined<section, ".eccentricity_angle">};
  static constexpr Handle interpolation{parameters::joined<section, ".interpolation">};
  static constexpr Handle interpolation_period{parameters::joined<section, ".interpolation_period">};
  static constexpr Handle noise{parameters::joined<section, ".noise">};
  static constexpr Handle noise_bandwidth{parameters::joined<section, ".noise_bandwidth">};
  static constexpr Handle missed{parameters::joined<section, ".missed">};
};

struct plant {
  static constexpr Handle inertia{"plant.inertia"};
  static constexpr Handle presliding_damping{"plant.presliding_damping"};
  static constexpr Handle sliding_damping{"plant.sliding_damping"};
  struct load {
    static constexpr Handle inertia{"plant.load.inertia"};
    static constexpr Handle stiffness{"plant.load.stiffness"};
    static constexpr Handle damping{"plant.load.damping"};
    static constexpr Handle encoder{"plant.load.encoder"};
    static constexpr Handle gap{"plant.load.gap"};
    static constexpr Handle damping_to_ground{"plant.load.damping_to_ground"};
    struct friction {
      static constexpr Handle model{"plant.load.friction.model"};
      static constexpr Handle breakaway{"plant.load.friction.breakaway"};
      static constexpr Handle coulomb_ratio{"plant.load.friction.coulomb_ratio"};
      static constexpr Handle stribeck_velocity{"plant.load.friction.stribeck_velocity"};
      static constexpr Handle sigma0{"plant.load.friction.sigma0"};
      static constexpr Handle sigma1{"plant.load.friction.sigma1"};
    };
    struct error {
      static constexpr Handle amplitude{"plant.load.error.#.amplitude"};
      static constexpr Handle periods{"plant.load.error.#.periods"};
      static constexpr Handle pitch{"plant.load.error.#.pitch"};
      static constexpr Handle phase{"plant.load.error.#.phase"};
    };
  };
};

struct friction {
  static constexpr Handle model{"friction.model"};
  static constexpr Handle k1{"friction.k1"};
  static constexpr Handle k2{"friction.k2"};
  static constexpr Handle beta{"friction.beta"};
  static constexpr Handle alpha{"friction.alpha"};
  static constexpr Handle lambda{"friction.lambda"};
  static constexpr Handle n{"friction.n"};
  static constexpr Handle breakaway{"friction.breakaway"};
  static constexpr Handle coulomb_ratio{"friction.coulomb_ratio"};
  static constexpr Handle stribeck_velocity{"friction.stribeck_velocity"};
  static constexpr Handle sigma0{"friction.sigma0"};
  static constexpr Handle sigma1{"friction.sigma1"};
  struct gms {
    static constexpr Handle attraction{"friction.gms.attraction"};
    static constexpr Handle stiffness{"friction.gms.stiffness"};
    static constexpr Handle weight{"friction.gms.weight"};
  };
  struct measured {
    static constexpr Handle initial_stiffness{"friction.measured.initial_stiffness"};
    static constexpr Handle secant_stiffness{"friction.measured.secant_stiffness"};
    static constexpr Handle secant_travel{"friction.measured.secant_travel"};
    static constexpr Handle final_stiffness{"friction.measured.final_stiffness"};
    static constexpr Handle breakaway{"friction.measured.breakaway"};
    static constexpr Handle breakaway_travel{"friction.measured.breakaway_travel"};
    struct creep {
      static constexpr Handle torque{"friction.measured.creep.torque"};
      static constexpr Handle extension{"friction.measured.creep.extension"};
      static constexpr Handle rate{"friction.measured.creep.rate"};
      static constexpr Handle exponent{"friction.measured.creep.exponent"};
    };
  };
};

struct encoder {
  static constexpr Handle fine{"encoder.fine"};
  static constexpr Handle coarse{"encoder.coarse"};
  static constexpr Handle resolution{"encoder.resolution"};
  static constexpr Handle coarse_resolution{"encoder.coarse_resolution"};
  struct load {
    static constexpr Handle counts_per_revolution{"encoder.load.counts_per_revolution"};
    static constexpr Handle resolution{"encoder.load.resolution"};
    struct fine_errors : EncoderErrors<"encoder.load.fine_errors"> {};
  };
  struct fine_errors : EncoderErrors<"encoder.fine_errors"> {};
  struct coarse_errors : EncoderErrors<"encoder.coarse_errors"> {};
};

struct dac {
  static constexpr Handle bits{"dac.bits"};
  static constexpr Handle resolution{"dac.resolution"};
  static constexpr Handle range{"dac.range"};
  static constexpr Handle offset{"dac.offset"};
  static constexpr Handle gain_error{"dac.gain_error"};
  static constexpr Handle nonlinearity{"dac.nonlinearity"};
  static constexpr Handle noise{"dac.noise"};
  static constexpr Handle sigma_delta{"dac.sigma_delta"};
};

struct amplifier {
  static constexpr Handle bandwidth{"amplifier.bandwidth"};
  static constexpr Handle limit{"amplifier.limit"};
};

struct controller : Control<parameters::Phase::fine> {
  static constexpr Handle sample_rate{"controller.sample_rate"};
  static constexpr Handle delay{"controller.delay"};
  static constexpr Handle anti_windup{"controller.anti_windup"};
  struct dither {
    static constexpr Handle amplitude{"controller.dither.amplitude"};
    static constexpr Handle frequency{"controller.dither.frequency"};
  };
  static constexpr Handle missed{"controller.missed"};
  static constexpr Handle jitter{"controller.jitter"};
  struct cascade : Control<parameters::Phase::fine>::cascade {
    static constexpr Handle feedforward{"controller.cascade.feedforward"};
    static constexpr Handle divider{"controller.cascade.divider"};
    static constexpr Handle latency{"controller.cascade.latency"};
    static constexpr Handle resolution{"controller.cascade.resolution"};
    static constexpr Handle limit{"controller.cascade.limit"};
    static constexpr Handle position{"controller.cascade.position"};
    static constexpr Handle velocity{"controller.cascade.velocity"};
  };
  static constexpr Handle derivative_window{"controller.derivative_window"};
  struct coarse : Control<parameters::Phase::coarse> {
    static constexpr Handle fine_within{"controller.coarse.fine_within"};
    static constexpr Handle fine_rate{"controller.coarse.fine_rate"};
    static constexpr Handle fine_dwell{"controller.coarse.fine_dwell"};
    static constexpr Handle coarse_beyond{"controller.coarse.coarse_beyond"};
  };
};

struct disturbance {
  static constexpr Handle torque{"disturbance.torque"};
  struct ripple {
    static constexpr Handle amplitude{"disturbance.ripple.#.amplitude"};
    static constexpr Handle periods{"disturbance.ripple.#.periods"};
    static constexpr Handle pitch{"disturbance.ripple.#.pitch"};
    static constexpr Handle phase{"disturbance.ripple.#.phase"};
  };
  struct vibration {
    static constexpr Handle amplitude{"disturbance.vibration.#.amplitude"};
    static constexpr Handle frequency{"disturbance.vibration.#.frequency"};
    static constexpr Handle phase{"disturbance.vibration.#.phase"};
  };
  struct load {
    static constexpr Handle torque{"disturbance.load.torque"};
    struct ripple {
      static constexpr Handle amplitude{"disturbance.load.ripple.#.amplitude"};
      static constexpr Handle periods{"disturbance.load.ripple.#.periods"};
      static constexpr Handle pitch{"disturbance.load.ripple.#.pitch"};
      static constexpr Handle phase{"disturbance.load.ripple.#.phase"};
    };
    struct vibration {
      static constexpr Handle amplitude{"disturbance.load.vibration.#.amplitude"};
      static constexpr Handle frequency{"disturbance.load.vibration.#.frequency"};
      static constexpr Handle phase{"disturbance.load.vibration.#.phase"};
    };
  };
};

struct command {
  static constexpr Handle targets{"command.targets"};
  struct torque {
    static constexpr Handle levels{"command.torque.levels"};
    static constexpr Handle rate{"command.torque.rate"};
    static constexpr Handle through{"command.torque.through"};
  };
  struct sequence {
    static constexpr Handle targets{"command.sequence.targets"};
    static constexpr Handle overrun{"command.sequence.overrun"};
  };
  static constexpr Handle hold{"command.hold"};
  struct profile {
    static constexpr Handle shape{"command.profile.shape"};
    static constexpr Handle velocity_limit{"command.profile.velocity_limit"};
    static constexpr Handle acceleration_limit{"command.profile.acceleration_limit"};
    static constexpr Handle jerk_limit{"command.profile.jerk_limit"};
    static constexpr Handle amplitude{"command.profile.amplitude"};
    static constexpr Handle frequency{"command.profile.frequency"};
  };
};

struct initial {
  static constexpr Handle encoder_phase{"initial.encoder_phase"};
  static constexpr Handle load_encoder_phase{"initial.load_encoder_phase"};
  static constexpr Handle position{"initial.position"};
  static constexpr Handle hardening{"initial.hardening"};
  static constexpr Handle preload{"initial.preload"};
  struct history {
    static constexpr Handle reversals{"initial.history.reversals"};
    static constexpr Handle torque{"initial.history.torque"};
  };
  static constexpr Handle velocity{"initial.velocity"};
  static constexpr Handle integral{"initial.integral"};
  static constexpr Handle mode{"initial.mode"};
  static constexpr Handle holding{"initial.holding"};
  static constexpr Handle gap{"initial.gap"};
};

struct verdict {
  static constexpr Handle dwell{"verdict.dwell"};
  static constexpr Handle window{"verdict.window"};
  static constexpr Handle stop{"verdict.stop"};
  static constexpr Handle limit{"verdict.limit"};
  static constexpr Handle motion{"verdict.motion"};
  static constexpr Handle rest_band{"verdict.rest_band"};
};

}  // namespace zerocount::parameter
