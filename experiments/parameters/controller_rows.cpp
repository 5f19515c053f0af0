#include <iterator>
#include <utility>

#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "experiments/parameters/phase_path.hpp"

namespace zerocount::parameters {
namespace {

/// Dimension of the Sobol sequence for row i of the control blocks (filters, observer and so on) of one
/// phase. From i = 14 on, the coarse phase has a separate range of dimensions.
template <Phase phase>
constexpr std::size_t dimension(std::size_t i) {
  if (phase == Phase::fine) return beyond_moves(32 + i);
  return beyond_moves(i < 14 ? 64 + i : 17 + (i - 14));
}

// In the order of loop::LoopEncoder.
const std::vector<std::string_view> loop_encoders{parameter::plant::load::encoder, "motor", "load"};

/// The table rows of the parameters that choose the control structure of one phase. `Blocks` is a function
/// that returns the ControlBlocks of the phase in TrialParameters.
template <Phase phase, class Blocks>
std::vector<Parameter> structure_rows(Blocks /*blocks*/) {
  return {
      word_row(parameter::Control<phase>::structure, dimension<phase>(0),
               "control law: PID on the error, or a velocity loop inside a position loop", assumed,
               {"pid", "cascade"}, [](auto& p) { return &Blocks{}(p).structure; }),
      real_row(parameter::Control<phase>::cascade::kv, dimension<phase>(1), "1/s",
               "cascade: gain of the position loop, velocity command per error", assumed, gain_range,
               [](auto& p) { return &Blocks{}(p).cascade.kv; }),
      real_row(parameter::Control<phase>::cascade::kp, dimension<phase>(2), "N m s/rad",
               "cascade: proportional gain of the velocity loop", assumed, gain_range,
               [](auto& p) { return &Blocks{}(p).cascade.kp; }),
      idealised_by(no_integral, real_row(parameter::Control<phase>::cascade::ki, dimension<phase>(3),
                                         "N m/rad", "cascade: integral gain of the velocity loop", assumed,
                                         gain_range, [](auto& p) { return &Blocks{}(p).cascade.ki; })),
  };
}

/// The table rows of the other control blocks (filters, observer, feedforward and so on) of one phase of the
/// control.
template <Phase phase, class Blocks>
std::vector<Parameter> block_rows(Blocks /*blocks*/) {
  return {
      short_for(
          phase_path<phase, "deadband">,
          none_is(
              -1,
              ideal_at(
                  -1, "no dead band of the integral",
                  real_row(
                      parameter::Control<phase>::deadband::enter, dimension<phase>(4), "count",
                      "largest |error| at which the integral is frozen; none (-1 as a number): never frozen",
                      assumed, numerics::closed(0, max_count),
                      [](auto& p) { return &Blocks{}(p).deadband.enter; })))),
      none_is(
          -1,
          real_row(
              parameter::Control<phase>::deadband::leave, dimension<phase>(5), "count",
              "|error| above which the integral changes again; none (-1 as a number): the value of enter",
              assumed, numerics::closed(0, max_count), [](auto& p) { return &Blocks{}(p).deadband.leave; })),
      or_none(ideal_at(max_count, "no zone of the integral",
                       real_row(parameter::Control<phase>::integrator_zone, dimension<phase>(6), "count",
                                "largest |error| at which the integral changes; none: no limit", assumed,
                                numerics::closed(0, max_count))),
              [](auto& p) { return &Blocks{}(p).integrator_zone; }),
      or_none(ideal_at(max_count, "no leak of the integral",
                       real_row(parameter::Control<phase>::integrator_leak, dimension<phase>(7), "s",
                                "time constant of the decay of the integral; none: no decay", assumed,
                                numerics::Interval{.low = 0, .high = max_count, .high_included = true})),
              [](auto& p) { return &Blocks{}(p).integrator_leak; }),
      or_none(ideal_at(
                  max_count, "no derivative filter",
                  real_row(
                      parameter::Control<phase>::derivative_cutoff, dimension<phase>(8), "Hz",
                      "cutoff of the low-pass filter on the difference of successive counts; none: no filter",
                      assumed, numerics::Interval{.low = 0, .high = max_count, .high_included = true})),
              [](auto& p) { return &Blocks{}(p).derivative_cutoff; }),
      idealised_by(damping_feedforward,
                   real_row(parameter::Control<phase>::feedforward::velocity, dimension<phase>(9),
                            "N m s/rad", "$torque per velocity of the reference", assumed, gain_range,
                            [](auto& p) { return &Blocks{}(p).feedforward.velocity; })),
      idealised_by(inertia_feedforward,
                   real_row(parameter::Control<phase>::feedforward::acceleration, dimension<phase>(10),
                            "N m s^2/rad", "$torque per acceleration of the reference", assumed, gain_range,
                            [](auto& p) { return &Blocks{}(p).feedforward.acceleration; })),
      idealised_by(friction_feedforward,
                   real_row(parameter::Control<phase>::feedforward::friction, dimension<phase>(11), "N m",
                            "$torque in the direction in which the reference moves", assumed, gain_range,
                            [](auto& p) { return &Blocks{}(p).feedforward.friction; })),
      real_row(parameter::Control<phase>::observer::bandwidth, dimension<phase>(12), "Hz",
               "bandwidth of the disturbance observer; 0: no observer", assumed, numerics::at_least(0),
               [](auto& p) { return &Blocks{}(p).observer.bandwidth; }),
      real_row(parameter::Control<phase>::observer::inertia, dimension<phase>(13), "kg m^2",
               "inertia Jn in the model of the disturbance observer", "paper, section 4", numerics::above(0),
               [](auto& p) { return &Blocks{}(p).observer.inertia; }),
      none_is(-1, ideal_at(
                      -1, "no dead band of the error",
                      real_row(parameter::Control<phase>::error_deadband::band, dimension<phase>(14), "count",
                               "largest |error| that counts as 0 in the control law; none (-1): no dead zone",
                               assumed, numerics::closed(0, max_count),
                               [](auto& p) { return &Blocks{}(p).error_deadband.band; }))),
      word_row(parameter::Control<phase>::error_deadband::form, dimension<phase>(15),
               "beyond the dead zone: the error itself, or less by the band", assumed, {"zero", "subtract"},
               [](auto& p) { return &Blocks{}(p).error_deadband.form; }),
      none_is(-1, ideal_at(-1, "no hold of the integral",
                           real_row(parameter::Control<phase>::hold::enter, dimension<phase>(16), "count",
                                    "|error| within which the wanted $torque is held; none (-1): never held",
                                    assumed, numerics::closed(0, max_count),
                                    [](auto& p) { return &Blocks{}(p).hold.enter; }))),
      none_is(-1, real_row(parameter::Control<phase>::hold::leave, dimension<phase>(17), "count",
                           "|error| above which the hold ends; none (-1): the value of enter", assumed,
                           numerics::closed(0, max_count), [](auto& p) { return &Blocks{}(p).hold.leave; })),
      real_row(parameter::Control<phase>::hold::dwell, dimension<phase>(18), "s",
               "time within `enter` after which the hold begins, at least one sample", assumed,
               numerics::at_least(0), [](auto& p) { return &Blocks{}(p).hold.dwell; }),
      none_is(-1,
              ideal_at(-1, "no gains of standstill",
                       real_row(parameter::Control<phase>::standstill::band, dimension<phase>(19), "count",
                                "largest |error| at which the gains of standstill act; none (-1): never",
                                assumed, numerics::closed(0, max_count),
                                [](auto& p) { return &Blocks{}(p).standstill.band; }))),
      real_row(parameter::Control<phase>::standstill::dwell, dimension<phase>(20), "s",
               "time within the band after which they act, at least one sample", assumed,
               numerics::at_least(0), [](auto& p) { return &Blocks{}(p).standstill.dwell; }),
      in_si(real_row(parameter::Control<phase>::standstill::kp, dimension<phase>(21), "N m/count",
                     "proportional gain at standstill", assumed, gain_range,
                     [](auto& p) { return &Blocks{}(p).standstill.kp; }),
            "N m/rad", "proportional gain at standstill"),
      in_si(
          idealised_by(no_integral, real_row(parameter::Control<phase>::standstill::ki, dimension<phase>(22),
                                             "N m/count", "integral gain at standstill", assumed, gain_range,
                                             [](auto& p) { return &Blocks{}(p).standstill.ki; })),
          "N m/(rad s)", "integral gain at standstill"),
      in_si(real_row(parameter::Control<phase>::standstill::kd, dimension<phase>(23), "N m/count",
                     "gain on the difference of successive counts at standstill", assumed, gain_range,
                     [](auto& p) { return &Blocks{}(p).standstill.kd; }),
            "N m s/rad", "derivative gain at standstill"),
  };
}

/// The table rows of the control parameters that only the fine phase has, or a control without a coarse
/// phase.
std::vector<Parameter> rows_of_the_drive() {
  const numerics::Interval samples = numerics::closed(1, 1000);
  return {
      ideal_at(1, "the whole velocity of the reference in the velocity command",
               real_row(parameter::controller::cascade::feedforward, beyond_moves(279), "1",
                        "cascade: proportion of the reference's velocity in the velocity command", assumed,
                        gain_range, [](auto& p) { return &p.controller.blocks.cascade.feedforward; })),
      ideal_at(1, "a position loop at every sample",
               whole_row(parameter::controller::cascade::divider, beyond_moves(280), "sample",
                         "cascade: samples of the velocity loop in one of the position loop", assumed,
                         samples, [](auto& p) { return &p.controller.blocks.cascade.divider; })),
      ideal_at(
          0, "no latency of the velocity command",
          whole_row(parameter::controller::cascade::latency, beyond_moves(281), "sample",
                    "cascade: samples of the velocity loop after which a velocity command acts", assumed,
                    numerics::closed(0, 1000), [](auto& p) { return &p.controller.blocks.cascade.latency; })),
      none_is(0, ideal_at(0, "a velocity command without steps",
                          real_row(parameter::controller::cascade::resolution, beyond_moves(282), "rad/s",
                                   "cascade: step of the velocity command; none: not rounded", assumed,
                                   numerics::above(0),
                                   [](auto& p) { return &p.controller.blocks.cascade.resolution; }))),
      or_none(ideal_at(max_count, "no limit of the velocity command",
                       real_row(parameter::controller::cascade::limit, beyond_moves(283), "rad/s",
                                "cascade: largest velocity command, in both directions; none: no limit",
                                assumed, numerics::above(0))),
              [](auto& p) { return &p.controller.blocks.cascade.limit; }),
      word_row(parameter::controller::cascade::position, beyond_moves(304),
               "cascade: the mass whose encoder the position loop reads", assumed, loop_encoders,
               [](auto& p) { return &p.controller.blocks.cascade.position; }),
      word_row(parameter::controller::cascade::velocity, beyond_moves(305),
               "cascade: the mass whose encoder the velocity loop reads", assumed, loop_encoders,
               [](auto& p) { return &p.controller.blocks.cascade.velocity; }),
      ideal_at(1, "a derivative window of one sample",
               whole_row(parameter::controller::derivative_window, beyond_moves(278), "sample",
                         "samples between the counts whose difference, per sample, is the velocity", assumed,
                         samples, [](auto& p) { return &p.controller.blocks.derivative_window; })),
  };
}

std::vector<Parameter> rows_of_the_law() {
  constexpr std::string_view integral_alone = "paper, section 4 (integral control alone)";
  return {
      idealised_by(faster_sampling,
                   real_row(parameter::controller::sample_rate, 20, "Hz", "sampling rate of the loop",
                            "paper, section 4", numerics::above(0),
                            [](auto& p) { return &p.controller.sample_rate; })),
      in_si(real_row(parameter::controller::kp, 21, "N m/count", "proportional gain", integral_alone,
                     gain_range, [](auto& p) { return &p.controller.kp; }),
            "N m/rad", "proportional gain"),
      in_si(idealised_by(no_integral,
                         real_row(parameter::controller::ki, 22, "N m/count",
                                  "integral gain k_ID of the trapezoidal rule", "paper, section 4 (a)",
                                  gain_range, [](auto& p) { return &p.controller.ki; })),
            "N m/(rad s)", "integral gain"),
      in_si(
          real_row(parameter::controller::kd, 23, "N m/count", "gain on the difference of successive counts",
                   integral_alone, gain_range, [](auto& p) { return &p.controller.kd; }),
          "N m s/rad", "derivative gain"),
      ideal_at(0, "no delay",
               real_row(parameter::controller::delay, 24, "sample",
                        "samples between computing a $torque and applying it", assumed,
                        numerics::closed(0, 100), [](auto& p) { return &p.controller.delay; })),
      word_row(parameter::controller::anti_windup, 25,
               "clamp keeps the integral inside the converter's range", assumed, {"clamp", "none"},
               [](auto& p) { return &p.controller.anti_windup; }),
      word_row(parameter::controller::encoder, beyond_moves(1),
               "encoder that closes the loop; with a coarse phase, in the fine phase", "paper, section 4",
               {"fine", "coarse"}, [](auto& p) { return &p.controller.encoder; }),
      ideal_at(0, "no dither",
               real_row(parameter::controller::dither::amplitude, beyond_moves(56), "N m",
                        "amplitude of a square wave on the wanted $torque", assumed, numerics::at_least(0),
                        [](auto& p) { return &p.controller.dither.amplitude; })),
      real_row(parameter::controller::dither::frequency, beyond_moves(57), "Hz", "its frequency", assumed,
               numerics::above(0), [](auto& p) { return &p.controller.dither.frequency; }),
      ideal_at(0, "no missed samples",
               real_row(parameter::controller::missed, beyond_moves(58), "1",
                        "probability that the controller does not run at a sample", assumed,
                        numerics::half_open(0, 1), [](auto& p) { return &p.controller.missed; })),
      ideal_at(0, "no late samples",
               real_row(parameter::controller::jitter, beyond_moves(59), "s",
                        "each sample is late by a time drawn evenly between 0 and this", assumed,
                        numerics::at_least(0), [](auto& p) { return &p.controller.jitter; })),
  };
}

std::vector<Parameter> rows_of_the_coarse_phase() {
  return {
      in_si(real_row(parameter::controller::coarse::kp, 46, "N m/count",
                     "proportional gain of the coarse phase", assumed, gain_range,
                     [](auto& p) { return &p.controller.coarse.kp; }),
            "N m/rad", "proportional gain of the coarse phase"),
      in_si(idealised_by(no_integral, real_row(parameter::controller::coarse::ki, 47, "N m/count",
                                               "integral gain of the coarse phase", assumed, gain_range,
                                               [](auto& p) { return &p.controller.coarse.ki; })),
            "N m/(rad s)", "integral gain of the coarse phase"),
      in_si(real_row(parameter::controller::coarse::kd, 48, "N m/count",
                     "gain of the coarse phase on the difference of successive counts", assumed, gain_range,
                     [](auto& p) { return &p.controller.coarse.kd; }),
            "N m s/rad", "derivative gain of the coarse phase"),
      word_row(parameter::controller::coarse::encoder, beyond_moves(2),
               "encoder that closes the loop in the coarse phase", assumed, {"fine", "coarse"},
               [](auto& p) { return &p.controller.coarse.encoder; }),
      real_row(parameter::controller::coarse::fine_within, 49, "count",
               "largest |error| at which the fine phase is entered", assumed, numerics::closed(0, max_count),
               [](auto& p) { return &p.controller.coarse.fine_within; }),
      real_row(parameter::controller::coarse::fine_rate, 50, "count/sample",
               "largest change of the count per sample at which the fine phase is entered", assumed,
               numerics::at_least(0), [](auto& p) { return &p.controller.coarse.fine_rate; }),
      real_row(parameter::controller::coarse::fine_dwell, 51, "s",
               "time for which fine_within and fine_rate must hold before the fine phase is entered", assumed,
               numerics::at_least(0), [](auto& p) { return &p.controller.coarse.fine_dwell; }),
      or_none(real_row(parameter::controller::coarse::coarse_beyond, 52, "count",
                       "|error| above which the coarse phase is entered; none (or 1e12): no coarse phase",
                       assumed, numerics::closed(0, max_count)),
              [](auto& p) { return &p.controller.coarse.coarse_beyond; }),
  };
}

}  // namespace

std::vector<Parameter> controller_rows() {
  std::vector<Parameter> rows = rows_of_the_law();
  const auto add = [&rows](std::vector<Parameter> more) {
    std::move(more.begin(), more.end(), std::back_inserter(rows));
  };
  const auto fine = [](auto& p) -> auto& {
    return p.controller.blocks;
  };
  const auto coarse = [](auto& p) -> auto& {
    return p.controller.coarse.blocks;
  };
  add(structure_rows<Phase::fine>(fine));
  add(rows_of_the_drive());
  add(block_rows<Phase::fine>(fine));
  add(rows_of_the_coarse_phase());
  add(structure_rows<Phase::coarse>(coarse));
  add(block_rows<Phase::coarse>(coarse));
  return rows;
}

}  // namespace zerocount::parameters
