#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
namespace {

constexpr std::string_view no_disc = "the key left out: only an encoder disc has an eccentricity";

constexpr std::string_view eccentricity = "amplitude of the error that repeats once per revolution";
constexpr std::string_view eccentricity_angle = "rotor angle at which that error rises through zero";
constexpr std::string_view interpolation =
    "amplitude of the error that repeats once per signal period, in counts of this encoder";
constexpr std::string_view interpolation_period = "signal period, in counts of this encoder";
constexpr std::string_view noise =
    "standard deviation of the reading before rounding, in counts of this encoder";
constexpr std::string_view noise_bandwidth =
    "bandwidth (-3 dB) of this noise; none: drawn anew at each sample";
constexpr std::string_view missed = "probability that the encoder misses a count that it passes";

}  // namespace

// m. A longer count is a number in another unit.
constexpr numerics::Interval length_of_count{.low = 0, .high = 0.1, .high_included = true};

std::vector<Parameter> encoder_rows() {
  return {
      only_on(AxisKind::rotary, "encoder.resolution, m per count",
              idealised_by(finer_encoder, whole_row("encoder.fine", 16, "count/rev",
                                                    "counts per revolution of the fine encoder",
                                                    "paper, section 2", numerics::closed(1, max_count),
                                                    [](auto& p) { return &p.encoder.fine; }))),
      only_on(AxisKind::rotary, "encoder.coarse_resolution, m per count",
              idealised_by(finer_encoder, whole_row("encoder.coarse", 17, "count/rev",
                                                    "counts per revolution of the coarse encoder",
                                                    "paper, section 2", numerics::closed(1, max_count),
                                                    [](auto& p) { return &p.encoder.coarse; }))),
      only_on(AxisKind::linear, "encoder.fine, counts per revolution",
              without_default(idealised_by(
                  finer_encoder, real_row("encoder.resolution", beyond_moves(7), "m/count",
                                          "length of a count of the fine encoder", "required",
                                          length_of_count, [](auto& p) { return &p.encoder.fine_length; })))),
      only_on(AxisKind::linear, "encoder.coarse, counts per revolution",
              without_default(idealised_by(
                  finer_encoder,
                  real_row("encoder.coarse_resolution", beyond_moves(8), "m/count",
                           "length of a count of the coarse encoder; default: that of the fine one",
                           "required", length_of_count, [](auto& p) { return &p.encoder.coarse_length; })))),

      only_on(AxisKind::rotary, no_disc,
              ideal_at(0, "no eccentricity",
                       real_row("encoder.fine_errors.eccentricity", 29, "rad", eccentricity, assumed,
                                numerics::at_least(0),
                                [](auto& p) { return &p.encoder.fine_errors.eccentricity; }))),
      only_on(AxisKind::rotary, no_disc,
              real_row("encoder.fine_errors.eccentricity_angle", 30, "rad", eccentricity_angle, assumed,
                       numerics::all_numbers(),
                       [](auto& p) { return &p.encoder.fine_errors.eccentricity_angle; })),
      ideal_at(0, "no interpolation error",
               real_row("encoder.fine_errors.interpolation", 31, "count", interpolation, assumed,
                        numerics::at_least(0), [](auto& p) { return &p.encoder.fine_errors.interpolation; })),
      real_row("encoder.fine_errors.interpolation_period", 32, "count", interpolation_period, assumed,
               numerics::above(0), [](auto& p) { return &p.encoder.fine_errors.interpolation_period; }),
      ideal_at(0, "no encoder noise",
               real_row("encoder.fine_errors.noise", 33, "count", noise, assumed, numerics::at_least(0),
                        [](auto& p) { return &p.encoder.fine_errors.noise; })),
      or_none(real_row("encoder.fine_errors.noise_bandwidth", beyond_moves(28), "Hz", noise_bandwidth,
                       assumed, numerics::Interval{.low = 0, .high = max_count, .high_included = true}),
              [](auto& p) { return &p.encoder.fine_errors.noise_bandwidth; }),
      ideal_at(0, "no missed counts",
               real_row("encoder.fine_errors.missed", 34, "1", missed, assumed, numerics::closed(0, 1),
                        [](auto& p) { return &p.encoder.fine_errors.missed; })),

      only_on(AxisKind::rotary, no_disc,
              ideal_at(0, "no eccentricity of the coarse encoder",
                       real_row("encoder.coarse_errors.eccentricity", 35, "rad", eccentricity, assumed,
                                numerics::at_least(0),
                                [](auto& p) { return &p.encoder.coarse_errors.eccentricity; }))),
      only_on(AxisKind::rotary, no_disc,
              real_row("encoder.coarse_errors.eccentricity_angle", 36, "rad", eccentricity_angle, assumed,
                       numerics::all_numbers(),
                       [](auto& p) { return &p.encoder.coarse_errors.eccentricity_angle; })),
      ideal_at(
          0, "no interpolation error of the coarse encoder",
          real_row("encoder.coarse_errors.interpolation", 37, "count", interpolation, assumed,
                   numerics::at_least(0), [](auto& p) { return &p.encoder.coarse_errors.interpolation; })),
      real_row("encoder.coarse_errors.interpolation_period", 38, "count", interpolation_period, assumed,
               numerics::above(0), [](auto& p) { return &p.encoder.coarse_errors.interpolation_period; }),
      ideal_at(0, "no noise of the coarse encoder",
               real_row("encoder.coarse_errors.noise", 39, "count", noise, assumed, numerics::at_least(0),
                        [](auto& p) { return &p.encoder.coarse_errors.noise; })),
      or_none(real_row("encoder.coarse_errors.noise_bandwidth", beyond_moves(29), "Hz", noise_bandwidth,
                       assumed, numerics::Interval{.low = 0, .high = max_count, .high_included = true}),
              [](auto& p) { return &p.encoder.coarse_errors.noise_bandwidth; }),
      ideal_at(0, "no missed counts of the coarse encoder",
               real_row("encoder.coarse_errors.missed", 40, "1", missed, assumed, numerics::closed(0, 1),
                        [](auto& p) { return &p.encoder.coarse_errors.missed; })),
  };
}

std::vector<Parameter> drive_rows() {
  return {
      idealised_by(
          finer_converter,
          whole_row("dac.bits", 18, "bit", "word length of the digital-to-analogue converter",
                    "paper, section 2", numerics::closed(1, 32), [](auto& p) { return &p.dac.bits; })),
      idealised_by(
          finer_converter,
          real_row("dac.resolution", 19, "N m", "$torque of one code of the digital-to-analogue converter",
                   "paper, section 4", numerics::above(0), [](auto& p) { return &p.dac.resolution; })),
      none_by_default(
          0, idealised_by(wider_torque_range,
                          real_row("dac.range", beyond_moves(16), "N m",
                                   "largest $torque of the converter, in both directions, in place of its "
                                   "resolution, which is range / 2^(bits - 1); none: dac.resolution counts",
                                   assumed, numerics::above(0)))),
      ideal_at(0, "no converter offset",
               real_row("dac.offset", 41, "N m", "offset added to the $torque of every code", assumed,
                        numerics::all_numbers(), [](auto& p) { return &p.dac.offset; })),
      ideal_at(0, "no converter gain error",
               real_row("dac.gain_error", 42, "1", "relative error of the resolution", assumed,
                        numerics::above(-1), [](auto& p) { return &p.dac.gain_error; })),
      ideal_at(0, "no converter non-linearity",
               real_row("dac.nonlinearity", 43, "code",
                        "integral non-linearity: largest deviation from the straight line between the ends",
                        assumed, numerics::all_numbers(), [](auto& p) { return &p.dac.nonlinearity; })),
      ideal_at(
          0, "no converter noise",
          real_row("dac.noise", 44, "N m", "standard deviation of the $torque noise, drawn at each sample",
                   assumed, numerics::at_least(0), [](auto& p) { return &p.dac.noise; })),
      bool_row("dac.sigma_delta", beyond_moves(27),
               "whether the rounding error of a sample is added to the next $torque", assumed,
               [](auto& p) { return &p.dac.sigma_delta; }),

      ideal_at(0, "no amplifier lag",
               real_row("amplifier.bandwidth", 45, "Hz",
                        "bandwidth (-3 dB) of the amplifier's first-order response; 0: ideal amplifier",
                        assumed, numerics::at_least(0), [](auto& p) { return &p.amplifier.bandwidth; })),
      or_none(
          idealised_by(wider_torque_range,
                       real_row("amplifier.limit", beyond_moves(284), "N m",
                                "largest $torque wanted of the amplifier, in both directions; none: no limit",
                                assumed, numerics::above(0))),
          [](auto& p) { return &p.dac.limit; }),
  };
}

}  // namespace zerocount::parameters
