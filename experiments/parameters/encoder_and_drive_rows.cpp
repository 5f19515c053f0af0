#include <array>

#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "experiments/parameters/phase_path.hpp"

namespace zerocount::parameters {
namespace {

constexpr std::string_view no_disc = "the key left out: only an encoder disc has an eccentricity";

/// The table rows of the errors of one encoder. `Errors` is a function that returns its EncoderErrors in
/// TrialParameters.
/// @param dimensions dimensions of the Sobol sequence, in the order of the rows
/// @param noiseless name of the ideal without noise
/// @tparam Handles handles of the parameters, a parameter::EncoderErrors
/// @tparam whose suffix that names the encoder in the names of the other ideals
template <class Handles, Literal whose, class Errors>
std::vector<Parameter> error_rows(const std::array<std::size_t, 7>& dimensions, std::string_view noiseless,
                                  Errors /*errors*/) {
  const auto [eccentricity, angle, interpolation, period, noise, bandwidth, missed] = dimensions;
  return {
      only_on(AxisKind::rotary, no_disc,
              ideal_at(0, joined<"no eccentricity", whose>,
                       real_row(Handles::eccentricity, eccentricity, "rad",
                                "amplitude of the error that repeats once per revolution", assumed,
                                numerics::at_least(0), [](auto& p) { return &Errors{}(p).eccentricity; }))),
      only_on(AxisKind::rotary, no_disc,
              real_row(Handles::eccentricity_angle, angle, "rad",
                       "rotor angle at which that error rises through zero", assumed, numerics::all_numbers(),
                       [](auto& p) { return &Errors{}(p).eccentricity_angle; })),
      ideal_at(
          0, joined<"no interpolation error", whose>,
          real_row(Handles::interpolation, interpolation, "count",
                   "amplitude of the error that repeats once per signal period, in counts of this encoder",
                   assumed, numerics::at_least(0), [](auto& p) { return &Errors{}(p).interpolation; })),
      real_row(Handles::interpolation_period, period, "count", "signal period, in counts of this encoder",
               assumed, numerics::above(0), [](auto& p) { return &Errors{}(p).interpolation_period; }),
      ideal_at(0, noiseless,
               real_row(Handles::noise, noise, "count",
                        "standard deviation of the reading before rounding, in counts of this encoder",
                        assumed, numerics::at_least(0), [](auto& p) { return &Errors{}(p).noise; })),
      or_none(real_row(Handles::noise_bandwidth, bandwidth, "Hz",
                       "bandwidth (-3 dB) of this noise; none: drawn anew at each sample", assumed,
                       numerics::Interval{.low = 0, .high = max_count, .high_included = true}),
              [](auto& p) { return &Errors{}(p).noise_bandwidth; }),
      ideal_at(
          0, joined<"no missed counts", whose>,
          real_row(Handles::missed, missed, "1", "probability that the encoder misses a count that it passes",
                   assumed, numerics::closed(0, 1), [](auto& p) { return &Errors{}(p).missed; })),
  };
}

}  // namespace

// m. A longer count is a number in another unit.
constexpr numerics::Interval length_of_count{.low = 0, .high = 0.1, .high_included = true};

std::vector<Parameter> encoder_rows() {
  std::vector<Parameter> rows{
      only_on(AxisKind::rotary, "encoder.resolution, m per count",
              idealised_by(finer_encoder, whole_row(parameter::encoder::fine, 16, "count/rev",
                                                    "counts per revolution of the fine encoder",
                                                    "paper, section 2", numerics::closed(1, max_count),
                                                    [](auto& p) { return &p.encoder.fine; }))),
      only_on(AxisKind::rotary, "encoder.coarse_resolution, m per count",
              idealised_by(finer_encoder, whole_row(parameter::encoder::coarse, 17, "count/rev",
                                                    "counts per revolution of the coarse encoder",
                                                    "paper, section 2", numerics::closed(1, max_count),
                                                    [](auto& p) { return &p.encoder.coarse; }))),
      only_on(AxisKind::linear, "encoder.fine, counts per revolution",
              without_default(idealised_by(
                  finer_encoder, real_row(parameter::encoder::resolution, beyond_moves(7), "m/count",
                                          "length of a count of the fine encoder", "required",
                                          length_of_count, [](auto& p) { return &p.encoder.fine_length; })))),
      only_on(AxisKind::linear, "encoder.coarse, counts per revolution",
              without_default(idealised_by(
                  finer_encoder,
                  real_row(parameter::encoder::coarse_resolution, beyond_moves(8), "m/count",
                           "length of a count of the coarse encoder; default: that of the fine one",
                           "required", length_of_count, [](auto& p) { return &p.encoder.coarse_length; })))),
      none_is(
          0,
          only_on(
              AxisKind::rotary, "encoder.load.resolution, m per count",
              idealised_by(
                  finer_encoder,
                  whole_row(
                      parameter::encoder::load::counts_per_revolution, beyond_moves(295), "count/rev",
                      "counts per revolution of an encoder on the second mass, beside the fine one, which then reads the motor; "
                      "none: no such encoder",
                      assumed, numerics::closed(1, max_count),
                      [](auto& p) { return &p.encoder.other.counts; })))),
      none_is(
          0,
          only_on(
              AxisKind::linear, parameter::encoder::load::counts_per_revolution,
              idealised_by(
                  finer_encoder,
                  real_row(
                      parameter::encoder::load::resolution, beyond_moves(296), "m/count",
                      "length of a count of an encoder on the second mass, beside the fine one, which then reads the motor; none: no such encoder",
                      assumed, length_of_count, [](auto& p) { return &p.encoder.other.length; })))),
  };
  for (const std::vector<Parameter>& errors :
       {error_rows<parameter::encoder::fine_errors, "">(
            {29, 30, 31, 32, 33, beyond_moves(28), 34}, "no encoder noise",
            [](auto& p) -> auto& { return p.encoder.fine_errors; }),
        error_rows<parameter::encoder::coarse_errors, " of the coarse encoder">(
            {35, 36, 37, 38, 39, beyond_moves(29), 40}, "no noise of the coarse encoder",
            [](auto& p) -> auto& { return p.encoder.coarse_errors; }),
        error_rows<parameter::encoder::load::fine_errors, " of the load's encoder">(
            {beyond_moves(297), beyond_moves(298), beyond_moves(299), beyond_moves(300), beyond_moves(301),
             beyond_moves(302), beyond_moves(303)},
            "no noise of the load's encoder", [](auto& p) -> auto& { return p.encoder.other.errors; })})
    rows.insert(rows.end(), errors.begin(), errors.end());
  return rows;
}

std::vector<Parameter> drive_rows() {
  return {
      idealised_by(
          finer_converter,
          whole_row(parameter::dac::bits, 18, "bit", "word length of the digital-to-analogue converter",
                    "paper, section 2", numerics::closed(1, 32), [](auto& p) { return &p.dac.bits; })),
      idealised_by(finer_converter,
                   real_row(parameter::dac::resolution, 19, "N m",
                            "$torque of one code of the digital-to-analogue converter", "paper, section 4",
                            numerics::above(0), [](auto& p) { return &p.dac.resolution; })),
      none_by_default(
          0,
          idealised_by(
              wider_torque_range,
              real_row(
                  parameter::dac::range, beyond_moves(16), "N m",
                  "largest $torque of the converter, in both directions, in place of its resolution, which is range / 2^(bits - 1); "
                  "none: dac.resolution counts",
                  assumed, numerics::above(0)))),
      ideal_at(0, "no converter offset",
               real_row(parameter::dac::offset, 41, "N m", "offset added to the $torque of every code",
                        assumed, numerics::all_numbers(), [](auto& p) { return &p.dac.offset; })),
      ideal_at(0, "no converter gain error",
               real_row(parameter::dac::gain_error, 42, "1", "relative error of the resolution", assumed,
                        numerics::above(-1), [](auto& p) { return &p.dac.gain_error; })),
      ideal_at(0, "no converter non-linearity",
               real_row(parameter::dac::nonlinearity, 43, "code",
                        "integral non-linearity: largest deviation from the straight line between the ends",
                        assumed, numerics::all_numbers(), [](auto& p) { return &p.dac.nonlinearity; })),
      ideal_at(0, "no converter noise",
               real_row(parameter::dac::noise, 44, "N m",
                        "standard deviation of the $torque noise, drawn at each sample", assumed,
                        numerics::at_least(0), [](auto& p) { return &p.dac.noise; })),
      bool_row(parameter::dac::sigma_delta, beyond_moves(27),
               "whether the rounding error of a sample is added to the next $torque", assumed,
               [](auto& p) { return &p.dac.sigma_delta; }),

      ideal_at(0, "no amplifier lag",
               real_row(parameter::amplifier::bandwidth, 45, "Hz",
                        "bandwidth (-3 dB) of the amplifier's first-order response; 0: ideal amplifier",
                        assumed, numerics::at_least(0), [](auto& p) { return &p.amplifier.bandwidth; })),
      or_none(
          idealised_by(wider_torque_range,
                       real_row(parameter::amplifier::limit, beyond_moves(284), "N m",
                                "largest $torque wanted of the amplifier, in both directions; none: no limit",
                                assumed, numerics::above(0))),
          [](auto& p) { return &p.dac.limit; }),
  };
}

}  // namespace zerocount::parameters
