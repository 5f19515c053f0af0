#include "runners/tuning/additions.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>

#include "runners/tuning/limits.hpp"

namespace zerocount::tuning {
namespace {

constexpr double added_noise = 0.1;  // counts rms
constexpr double added_delay = 1.0;  // samples
constexpr double load_part = 0.5;    // of the inertia
constexpr double load_damping = 0.01;
constexpr double allowed_loss = 0.01;      // of the rate, by a mode that is borne
constexpr double lowest_frequency = 10.0;  // Hz
constexpr double precision = 1.05;         // of the frequency

/// Adds noise to the encoder that closes the loop.
void add_noise(trial::TrialParameters& p) {
  const bool coarse = p.controller.encoder == loop::EncoderChoice::coarse;
  double& noise = (coarse ? p.encoder.coarse_errors : p.encoder.fine_errors).noise;
  noise = std::hypot(noise, added_noise);
}

void add_delay(trial::TrialParameters& p) {
  p.controller.delay += added_delay;
}

/// The motor and the load swing against each other at `frequency` (Hz).
Change add_mode(double frequency) {
  return [frequency](trial::TrialParameters& p) {
    const double inertia = p.plant.inertia;
    const double swinging = load_part * (1.0 - load_part) * inertia;  // of both masses against each other
    const double rate = 2.0 * std::numbers::pi * frequency;
    p.plant.inertia = (1.0 - load_part) * inertia;
    p.plant.load = {.inertia = load_part * inertia,
                    .stiffness = swinging * rate * rate,
                    .damping = 2.0 * load_damping * swinging * rate};
  };
}

/// The rate with a change of what each trial has drawn.
using RateWith = std::function<double(const Change&)>;

/// The lowest mode that is borne, and a row of it.
Addition lowest_mode(const RateWith& rate_with, double rate, double sample_rate) {
  const auto is_borne = [&](double rate_of_mode) { return rate_of_mode >= rate - allowed_loss; };
  double borne = 0.5 * sample_rate;
  double rate_at_borne = rate_with(add_mode(borne));
  const auto effect = [](double frequency) { return fmt::format("a load mode at {:.3g} Hz", frequency); };
  if (!is_borne(rate_at_borne))
    return {effect(borne), rate_at_borne, "half the sample rate; modes of higher frequency are not tried"};
  double missed = borne;
  double rate_at_missed = rate_at_borne;
  const auto try_at = [&](double frequency) {
    const double found = rate_with(add_mode(frequency));
    (is_borne(found) ? borne : missed) = frequency;
    (is_borne(found) ? rate_at_borne : rate_at_missed) = found;
    return is_borne(found);
  };
  while (try_at(0.5 * borne)) {
    if (0.5 * borne < lowest_frequency)
      return {effect(borne), rate_at_borne, "no mode above it that was tried costs more than 1 %"};
  }
  while (borne > precision * missed) try_at(std::sqrt(borne * missed));
  return {effect(borne), rate_at_borne,
          fmt::format(
              "the lowest that costs at most 1 %: half of the inertia, 1 % damping; {:.3g} % at {:.3g} Hz",
              100.0 * rate_at_missed, missed)};
}

}  // namespace

std::vector<Addition> additions_to(const study::Study& study, const trials::Replicates& units, double rate,
                                   const trials::Effort& effort) {
  const RateWith rate_with = [&](const Change& change) {
    return estimate_on(study, units, units.count, &change, effort).rate;
  };
  const trial::TrialParameters first = study::study_trial(study, units.point, 0).parameters;
  std::vector<Addition> additions{
      {fmt::format("encoder noise of {} counts rms", added_noise), rate_with(add_noise)},
      {"one sample of delay", rate_with(add_delay)}};
  if (!motion::has_load(first.plant))
    additions.push_back(lowest_mode(rate_with, rate, first.controller.sample_rate));
  return additions;
}

}  // namespace zerocount::tuning
