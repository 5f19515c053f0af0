#include "runners/tuning/effects/idealisations.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/failure/failure.hpp"
#include "core/friction/friction_model.hpp"
#include "core/loop/controller/filter.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::tuning {
namespace {

using study::PointEdit;
using study::ValueLimits;

constexpr const char* not_tuned_again = "same gains, not tuned again";

bool can_differ_from_zero(const ValueLimits& limits) {
  return limits.low != 0.0 || limits.high != 0.0;
}

bool is_within(std::string_view name, std::string_view section) {
  return name.starts_with(section) && name.substr(section.size()).starts_with('.');
}

/// The encoders that close the loop, in any phase of any trial of the point.
struct LoopEncoders {
  bool fine{false};
  bool coarse{false};
};

LoopEncoders encoders_of(const PointEdit& at) {
  LoopEncoders encoders;
  const auto add = [&](std::string_view choice) {
    const ValueLimits limits = at.limits(choice);
    encoders.fine |= limits.low == static_cast<double>(loop::EncoderChoice::fine);
    encoders.coarse |= limits.high == static_cast<double>(loop::EncoderChoice::coarse);
  };
  add("controller.encoder");
  if (study::can_have_coarse_phase(at.limits("controller.coarse.coarse_beyond")))
    add("controller.coarse.encoder");
  return encoders;
}

/// Calls `visit(slot, row)` for each value of a trial.
template <class Visit>
void visit_values(const PointEdit& at, const Visit& visit) {
  const study::StudyTable& table = at.plan().table;
  for (const std::size_t slot : study::slots_in_table_order(table)) visit(slot, table.rows[slot]);
}

bool is_sampled_gain(const PointEdit& at, const parameters::Parameter& row) {
  return !row.si_unit.empty() && at.plan().units.gains == parameters::GainUnits::count;
}

// Creep.

bool has_creep(const PointEdit& at) {
  const auto model = static_cast<friction::FrictionModel>(static_cast<int>(at.limits("friction.model").low));
  return friction::has_creep(model) && at.limits("friction.alpha").high > 0.0;
}

void without_creep(PointEdit& at) {
  at.set("friction.alpha", 0.0);
}

// Converter. Its range and its non-linearity stay, the latter in codes.

void with_finer_converter(PointEdit& at) {
  constexpr std::int64_t more_bits = 4;
  constexpr double ratio = 1 << more_bits;
  at.add("dac.bits", more_bits);
  at.scale("dac.resolution", 1.0 / ratio);
  at.scale("dac.nonlinearity", ratio);
}

// Encoder. All lengths that the manifest gives in counts stay the same in rad or m, and so do gains per
// count. Counts of the control, the command and the verdict are those of the fine encoder, whichever closes
// the loop.

constexpr double counts_per_count = 4.0;

void refine(PointEdit& at, std::string_view per_revolution, std::string_view length,
            std::string_view errors) {
  const bool rotary = at.plan().units.axis == parameters::AxisKind::rotary;
  at.scale(rotary ? per_revolution : length, rotary ? counts_per_count : 1.0 / counts_per_count);
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (row.unit == "count" && is_within(row.name, errors)) at.scale(slot, counts_per_count);
  });
}

void keep_lengths_in_fine_counts(PointEdit& at) {
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    const bool of_an_encoder = is_within(row.name, "encoder") || row.name == "initial.encoder_phase";
    if ((row.unit == "count" && !of_an_encoder) || row.unit == "count/sample")
      at.scale(slot, counts_per_count);
    if (is_sampled_gain(at, row)) at.scale(slot, 1.0 / counts_per_count);
  });
  trial::ErrorBands& bands = at.plan().common.verdict.bands;
  for (std::size_t b = 0; b < bands.count; ++b) {
    constexpr auto whole = static_cast<std::int64_t>(counts_per_count);
    bands.limits[b] = whole * bands.limits[b] + whole / 2;  // (b + 1/2) counts to either side of the middle
  }
}

void with_finer_encoder(PointEdit& at) {
  const LoopEncoders encoders = encoders_of(at);
  if (encoders.coarse) refine(at, "encoder.coarse", "encoder.coarse_resolution", "encoder.coarse_errors");
  if (!encoders.fine) return;
  refine(at, "encoder.fine", "encoder.resolution", "encoder.fine_errors");
  keep_lengths_in_fine_counts(at);
}

// Sample rate. Times, rates and gains stay the same in s; what is given in samples, the delay, stays in
// samples.

constexpr double rate_ratio = 2.0;

/// The factor of a gain of the sampled law that stays the same in SI units.
double factor_at_new_rate(std::string_view si_unit) {
  if (si_unit.ends_with("/(rad s)")) return 1.0 / rate_ratio;
  return si_unit.ends_with(" s/rad") ? rate_ratio : 1.0;
}

void with_twice_the_rate(PointEdit& at) {
  at.scale("controller.sample_rate", rate_ratio);
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (row.unit == "count/sample") at.scale(slot, 1.0 / rate_ratio);
    if (is_sampled_gain(at, row)) at.scale(slot, factor_at_new_rate(row.si_unit));
  });
}

/// Coefficients belong to a sample rate.
void resample_biquads(trial::TrialParameters& p) {
  for (std::vector<loop::Filter>* filters :
       {&p.controller.blocks.filters, &p.controller.coarse.blocks.filters}) {
    for (loop::Filter& filter : *filters) {
      if (filter.kind != loop::FilterKind::biquad) continue;
      const std::optional<loop::Filter> resampled = loop::resampled(filter, rate_ratio);
      if (!resampled)
        throw Failure(ExitCode::bad_input,
                      "a biquad with a pole at half the sample rate is of no other sample rate");
      filter = *resampled;
    }
  }
}

// Delay and lag.

bool has_delay(const PointEdit& at) {
  return at.limits("controller.delay").high > 0.0 || at.limits("amplifier.bandwidth").high > 0.0;
}

void without_delay(PointEdit& at) {
  at.set("controller.delay", 0.0);
  at.set("amplifier.bandwidth", 0.0);
}

// Noise. That of the fine encoder acts in any case, because the error is measured with it.

constexpr std::string_view coarse_noise = "encoder.coarse_errors.noise";

bool has_noise(const PointEdit& at) {
  return at.limits("encoder.fine_errors.noise").high > 0.0 || at.limits("dac.noise").high > 0.0 ||
         (encoders_of(at).coarse && at.limits(coarse_noise).high > 0.0);
}

void without_noise(PointEdit& at) {
  at.set("encoder.fine_errors.noise", 0.0);
  at.set(coarse_noise, 0.0);
  at.set("dac.noise", 0.0);
}

// Disturbance. Its terms are in lists, so each trial loses what it has drawn.

bool has_disturbance(const PointEdit& at) {
  bool found = !at.plan().common.disturbance.spectra.empty();
  visit_values(at, [&](std::size_t, const parameters::Parameter& row) {
    const bool amplitude = is_within(row.name, "disturbance") && row.name.ends_with(".amplitude");
    if (amplitude || row.name == "disturbance.torque") found |= can_differ_from_zero(at.limits(row.name));
  });
  return found;
}

/// A load goes together with what holds it at the start: the integral against it, up to the largest load of
/// the study, a contact that carries it, and a preload of its size.
Change without_disturbance(const ValueLimits& load) {
  return [load](trial::TrialParameters& p) {
    double& integral = p.initial.integral;
    integral = integral > 0.0 ? std::max(0.0, integral - std::max(0.0, -load.low))
                              : std::min(0.0, integral + std::max(0.0, load.high));
    constexpr double rounding = 1e-9;
    const double torque = std::abs(p.disturbance.torque);
    if (torque > 0.0 && std::abs(std::abs(p.initial.preload) - torque) <= rounding * torque)
      p.initial.preload = 0.0;
    p.initial.holding = false;
    p.disturbance = {};
  };
}

// Clock of the controller.

bool has_irregular_clock(const PointEdit& at) {
  return at.limits("controller.missed").high > 0.0 || at.limits("controller.jitter").high > 0.0;
}

void with_a_regular_clock(PointEdit& at) {
  at.set("controller.missed", 0.0);
  at.set("controller.jitter", 0.0);
}

}  // namespace

std::vector<Effect> idealisations_of(const study::Study& study, std::int64_t point) {
  const PointEdit at(study, point);
  const std::string belongs =
      study.plan->plugin ? "the parameters of a plugin belong to its sample rate and encoder" : "";
  std::vector<Effect> all;
  if (has_creep(at)) all.push_back({.name = "creep off", .edit = without_creep});
  all.push_back({.name = "a converter 16 times finer", .edit = with_finer_converter});
  all.push_back({.name = "an encoder 4 times finer",
                 .note = not_tuned_again,
                 .refusal = belongs,
                 .edit = with_finer_encoder});
  all.push_back({.name = "twice the sample rate",
                 .note = not_tuned_again,
                 .refusal = belongs,
                 .edit = with_twice_the_rate,
                 .change = resample_biquads});
  if (has_delay(at))
    all.push_back({.name = "no delay, no amplifier lag", .note = not_tuned_again, .edit = without_delay});
  if (has_noise(at)) all.push_back({.name = "no noise", .edit = without_noise});
  if (has_disturbance(at))
    all.push_back({.name = "no disturbance", .change = without_disturbance(at.limits("disturbance.torque"))});
  if (has_irregular_clock(at))
    all.push_back({.name = "no missed or late samples", .edit = with_a_regular_clock});
  return all;
}

}  // namespace zerocount::tuning
