#include "runners/tuning/machine_runs/finer_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <variant>
#include <vector>

#include "core/numerics/sign.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::tuning {
namespace {

using trial::BandOutcome;
using trial::MoveOutcome;
using MeasureMember = decltype(layout::Measure{}.field.member);

/// Pointers to the members of MoveOutcome that are lengths in counts. Each member is listed once, although
/// two measures may share it.
const std::vector<MeasureMember>& lengths_in_counts() {
  static const std::vector<MeasureMember> all = [] {
    std::vector<MeasureMember> members;
    for (const layout::Measure& measure : layout::move_measures())
      if (measure.field.column.unit == std::string_view("count") &&
          std::ranges::find(members, measure.field.member) == members.end())
        members.push_back(measure.field.member);
    return members;
  }();
  return all;
}

void lengths_to_study_counts(MoveOutcome& move, std::int64_t counts) {
  for (const MeasureMember& any : lengths_in_counts()) {
    if (const auto* whole = std::get_if<std::int64_t MoveOutcome::*>(&any))
      move.*(*whole) = error_in_study_counts(move.*(*whole), counts);
    if (const auto* real = std::get_if<double MoveOutcome::*>(&any))
      move.*(*real) /= static_cast<double>(counts);
  }
}

std::int64_t finer_band(std::int64_t band, std::int64_t counts) {
  return counts * band + counts / 2;
}

/// Measures of a move within an error band of the study, found in a move that was measured in finer counts;
/// empty if this band was not measured.
/// @param band half-width of the band, counts of the study
/// @param counts finer counts in one count of the study
BandOutcome of_band(const MoveOutcome& finer, const trial::MoveTiming& timing, std::int64_t band,
                    std::int64_t counts) {
  const auto bands = timing.bands.values();
  const auto slot = std::ranges::find(bands, finer_band(band, counts));
  return slot == bands.end() ? BandOutcome{} : finer.bands[static_cast<std::size_t>(slot - bands.begin())];
}

/// Start of the final window of a move, s after the start of the move. The move's outcome depends on whether
/// the error has settled before this time.
double start_of_window(const trial::MoveTiming& timing) {
  return static_cast<double>(timing.samples - timing.window) * timing.sample_time;
}

/// Sets the measures of a move that depend on the error being zero, or at most one count of the study.
/// @param zero measures of the band 0 of the study
/// @param one measures of the band 1 of the study
void measure_by_counts(MoveOutcome& move, const trial::MoveTiming& timing, const BandOutcome& zero,
                       const BandOutcome& one) {
  const bool ended = move.stopped || move.outcome == trial::Outcome::nonfinite;
  move.arrived = !std::isnan(zero.entry_time);
  move.arrival_time = zero.entry_time;
  move.arrival = move.arrived ? std::llround(zero.entry_time / timing.sample_time) : -1;
  move.final_settling_time = zero.settling_time;
  move.jerk_count = move.arrived ? std::llround(zero.exits) : 0;
  move.zero_fraction = move.jerk_agreement = std::numeric_limits<double>::quiet_NaN();
  move.stable = move.arrived && one.settling_time <= zero.entry_time;
  if (ended) return;
  if (zero.settling_time <= start_of_window(timing)) {
    move.outcome = trial::Outcome::zero_count;
  } else if (one.settling_time <= start_of_window(timing)) {
    move.outcome = trial::Outcome::one_count;
  }
  if (move.outcome != trial::Outcome::oscillating)
    move.oscillation_amplitude = move.oscillation_period = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::int64_t error_in_study_counts(std::int64_t finer_error, std::int64_t counts) {
  const std::int64_t beyond = std::abs(finer_error) - counts / 2;
  return beyond <= 0 ? 0 : numerics::sign_of(finer_error) * ((beyond + counts - 1) / counts);
}

std::optional<trial::ErrorBands> finer_bands(const trial::ErrorBands& of_study, std::int64_t counts) {
  std::set<std::int64_t> bands{0, 1};
  bands.insert(of_study.values().begin(), of_study.values().end());
  trial::ErrorBands finer{.limits = {}, .count = bands.size()};
  if (bands.size() > finer.limits.size()) return std::nullopt;
  std::ranges::transform(bands, finer.limits.begin(),
                         [counts](std::int64_t band) { return finer_band(band, counts); });
  return finer;
}

bool is_known_in_study_units(std::string_view measure) {
  constexpr std::array<std::string_view, 2> unknown{"zero_fraction", "jerk_agreement"};
  return std::ranges::find(unknown, measure) == unknown.end();
}

MoveOutcome in_study_units(const MoveOutcome& finer, const FinerUnits& units,
                           const trial::ErrorBands& of_study, const trial::MoveTiming& timing) {
  MoveOutcome move = finer;
  if (units.counts != 1) {
    const auto band = [&](std::int64_t limit) { return of_band(finer, timing, limit, units.counts); };
    for (std::size_t slot = 0; slot < of_study.count; ++slot) move.bands[slot] = band(of_study.limits[slot]);
    lengths_to_study_counts(move, units.counts);
    measure_by_counts(move, timing, band(0), band(1));
  }
  if (move.arrival > 0) move.arrival = (move.arrival + units.samples - 1) / units.samples;
  move.encoder_disagreement = (move.encoder_disagreement + units.samples - 1) / units.samples;
  return move;
}

}  // namespace zerocount::tuning
