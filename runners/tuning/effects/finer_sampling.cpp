#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/loop/controller/filter.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"
#include "experiments/study/goal.hpp"
#include "runners/tuning/effects/idealisations.hpp"

// A finer encoder and a higher sample rate.

namespace zerocount::tuning {
namespace {

using study::ParameterRange;
using study::PointEdit;

// Encoder. All lengths that the manifest gives in counts stay the same in rad or m, and so do gains per
// count. Counts of the control, the command and the verdict are those of the fine encoder, whichever closes
// the loop. The verdict is told in counts of the study (FinerUnits), so that the goal stays as it is.

constexpr std::int64_t counts_per_count = 4;
constexpr double finer = counts_per_count;
constexpr double half_a_count = finer / 2.0;

void refine(PointEdit& at, std::string_view per_revolution, std::string_view length,
            std::string_view errors) {
  const bool rotary = at.plan().units.axis == parameters::AxisKind::rotary;
  at.scale(rotary ? per_revolution : length, rotary ? finer : 1.0 / finer);
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (row.unit == "count" && is_within(row.name, errors)) at.scale(slot, finer);
  });
}

void refine_fine_encoder(PointEdit& at) {
  refine(at, parameter::encoder::fine, parameter::encoder::resolution, "encoder.fine_errors");
}

/// Whether the parameter is in counts, or counts per sample, of the encoder by which the control, the command
/// and the verdict count. Not included: errors of an encoder, which are in its own counts; the encoder's
/// phase, which is a fraction of a count; the band of rest, for which rest_in_finer_counts() sets the value.
bool is_in_fine_counts(const parameters::Parameter& row) {
  const bool of_an_encoder = is_within(row.name, "encoder") ||
                             row.name == parameter::initial::encoder_phase ||
                             row.name == parameter::initial::load_encoder_phase;
  return (row.unit == "count" && !of_an_encoder && row.name != parameter::verdict::rest_band) ||
         row.unit == "count/sample";
}

/// Scaling of a parameter in counts that keeps its length on the axis when the counts become finer. A zone of
/// the control within b counts keeps the length b; one within zero counts keeps ± half a count of the study.
study::Scaling same_length(const parameters::Parameter& row) {
  if (is_within(row.name, "controller")) return {.factor = finer, .least = half_a_count};
  return {.factor = finer};
}

void keep_lengths_in_fine_counts(PointEdit& at) {
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (is_in_fine_counts(row)) at.scale(slot, same_length(row));
    if (is_sampled_gain(at, row)) at.scale(slot, 1.0 / finer);
  });
  trial::ErrorBands& bands = at.plan().common.verdict.bands;
  bands = finer_bands(bands, counts_per_count).value_or(bands);
}

void rest_in_finer_counts(trial::TrialParameters& p) {
  p.verdict.rest_band = finer * std::floor(p.verdict.rest_band) + half_a_count;
}

/// Why the moves of a trial with finer encoder counts cannot be judged in the study's counts; empty if they
/// can.
std::string refusal_of_finer_counts(const study::Study& study) {
  if (!finer_bands(study.features.bands, counts_per_count))
    return fmt::format("with zero counts and one count there would be more than {} error bands",
                       trial::max_error_bands);
  for (const study::Goal& goal : study.goals) {
    for (const study::GoalLimit& limit : goal.limits)
      if (!is_known_in_study_units(limit.measure))
        return fmt::format("a limit of {} depends on the encoder's own zero counts", limit.measure);
  }
  return "";
}

/// Adds to an effect with a finer encoder: the finer units, the matching band of rest, and the reason if its
/// moves cannot be judged in the study's counts.
void judge_in_study_counts(const study::Study& study, Effect& effect) {
  effect.finer.counts = counts_per_count;
  effect.change = rest_in_finer_counts;
  if (effect.refusal.empty()) effect.refusal = refusal_of_finer_counts(study);
}

Effect with_finer_encoder(const IdealisedPoint& point, const study::Study& study) {
  const LoopEncoders encoders = encoders_of(point.at);
  Effect effect{.name = std::string(parameters::finer_encoder),
                .note = not_tuned_again,
                .refusal = point.fixed_rate_and_counts,
                .edit = [encoders](PointEdit& at) {
                  if (encoders.coarse)
                    refine(at, parameter::encoder::coarse, parameter::encoder::coarse_resolution,
                           "encoder.coarse_errors");
                  if (!encoders.fine) return;
                  refine_fine_encoder(at);
                  keep_lengths_in_fine_counts(at);
                }};
  if (encoders.fine) judge_in_study_counts(study, effect);
  return effect;
}

/// Effect with a finer encoder on one mass only, for an axis with an encoder on each mass. "Counts" are those
/// of the encoder that closes the position loop.
/// @param mass the mass whose encoder becomes finer
/// @param closing the mass whose encoder closes the position loop
Effect with_finer_encoder_of(motion::EncoderPlace mass, motion::EncoderPlace closing,
                             const IdealisedPoint& point, const study::Study& study) {
  Effect effect{.name = fmt::format("{} on the {}", parameters::finer_encoder, study::mass_text(mass)),
                .note = not_tuned_again,
                .refusal = point.fixed_rate_and_counts,
                .edit = [mass, closing](PointEdit& at) {
                  if (mass == motion::EncoderPlace::motor) {
                    refine_fine_encoder(at);
                  } else {
                    refine(at, parameter::encoder::load::counts_per_revolution,
                           parameter::encoder::load::resolution, "encoder.load.fine_errors");
                  }
                  if (mass == closing) keep_lengths_in_fine_counts(at);
                }};
  if (mass == closing) judge_in_study_counts(study, effect);
  return effect;
}

// Sample rate. Times, rates and gains stay the same in s, and so do samples that have a row of their own: of
// the derivative's window, and of the position loop and the bus of a cascade. The delay of the controller
// stays in samples, because it is that of its computing.

constexpr std::int64_t samples_per_sample = 2;
constexpr double rate_ratio = samples_per_sample;

/// Factor by which a gain of the sampled control law changes at the new sample rate, so that it keeps its
/// value in SI units.
/// @param si_unit SI unit of the gain
double factor_at_new_rate(std::string_view si_unit) {
  if (si_unit.ends_with("/(rad s)")) return 1.0 / rate_ratio;
  return si_unit.ends_with(" s/rad") ? rate_ratio : 1.0;
}

void with_twice_the_rate(PointEdit& at) {
  at.scale(parameter::controller::sample_rate, rate_ratio);
  visit_values(at, [&](std::size_t slot, const parameters::Parameter& row) {
    if (row.unit == "count/sample") at.scale(slot, 1.0 / rate_ratio);
    if (row.unit == "sample" && row.name != parameter::controller::delay)
      at.scale(slot, {.factor = rate_ratio, .off = row.ideal ? row.ideal->value : std::nullopt});
    if (is_sampled_gain(at, row)) at.scale(slot, factor_at_new_rate(row.si_unit));
  });
}

/// Converts the coefficients of biquad filters, which are valid for one sample rate only, to the new sample
/// rate.
void resample_biquads(trial::TrialParameters& p) {
  for (std::vector<loop::Filter>* filters :
       {&p.controller.blocks.filters, &p.controller.coarse.blocks.filters}) {
    for (loop::Filter& filter : *filters) {
      if (filter.kind != loop::FilterKind::biquad) continue;
      const std::optional<loop::Filter> resampled = loop::resampled(filter, rate_ratio);
      if (!resampled)
        throw Failure(
            ExitCode::bad_input,
            "a biquad with a pole at half the sample rate cannot be converted to another sample rate");
      filter = *resampled;
    }
  }
}

}  // namespace

LoopEncoders encoders_of(const PointEdit& at) {
  LoopEncoders encoders;
  const auto add = [&](std::string_view choice) {
    const ParameterRange range = at.limits(choice);
    encoders.fine |= range.low == static_cast<double>(loop::EncoderChoice::fine);
    encoders.coarse |= range.high == static_cast<double>(loop::EncoderChoice::coarse);
  };
  add(parameter::controller::encoder);
  if (study::can_have_coarse_phase(at.limits(parameter::controller::coarse::coarse_beyond)))
    add(parameter::controller::coarse::encoder);
  return encoders;
}

void add_finer_encoders(const IdealisedPoint& point, const study::Study& study, std::vector<Effect>& all) {
  using enum motion::EncoderPlace;
  const study::StudyPlan& plan = point.at.plan();
  const std::vector<ParameterRange> ranges =
      study::ranges_at(plan, study::slots_named(plan.table, study::two_encoders), point.at.points().front());
  const study::Ranges of(study::two_encoders, ranges);
  if (!study::has_two_encoders(of)) return all.push_back(with_finer_encoder(point, study));
  const motion::EncoderPlace closing = study::closes_at_load(of) ? load : motor;
  for (const motion::EncoderPlace mass : {motor, load})
    all.push_back(with_finer_encoder_of(mass, closing, point, study));
}

void add_faster_sampling(const IdealisedPoint& point, std::vector<Effect>& all) {
  all.push_back({.name = std::string(parameters::faster_sampling),
                 .note = not_tuned_again,
                 .refusal = point.fixed_rate_and_counts,
                 .edit = with_twice_the_rate,
                 .change = resample_biquads,
                 .finer = {.samples = samples_per_sample}});
}

}  // namespace zerocount::tuning
