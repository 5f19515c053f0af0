#include "analysis/sliding_identification/sliding_identification.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include <fmt/format.h>

#include "analysis/sliding_identification/sliding_fit.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr double max_unexplained = 0.1;  // of the torque; the records of a real machine leave 0.035

bool moves_along(std::span<const SlidingRecord> records, double direction) {
  return std::ranges::any_of(records, [&](const SlidingRecord& record) {
    return std::ranges::any_of(record.strokes,
                               [&](const Window& stroke) { return stroke.direction == direction; });
  });
}

double torque_rms(std::span<const SlidingRecord> records) {
  double squares = 0.0;
  std::size_t samples = 0;
  for (const SlidingRecord& record : records) {
    for (const Window& stroke : record.strokes) {
      samples += samples_of(stroke);
      for (std::size_t k = stroke.first; k <= stroke.last; ++k)
        squares += record.torque[k].now * record.torque[k].now;
    }
  }
  return std::sqrt(squares / static_cast<double>(samples));
}

/// The Stribeck velocity that explains most: of 12 between the slowest velocity and half of the fastest, in
/// equal ratios. Nothing if none explains what independent residuals hardly do by chance.
std::optional<double> visible_stribeck_velocity(std::span<const SlidingRecord> records,
                                                const SlidingFit& without) {
  double slowest = records.front().min_velocity;
  double fastest = 0.0;
  for (const SlidingRecord& record : records) {
    slowest = std::min(slowest, record.min_velocity);
    fastest = std::max(fastest, record.max_velocity);
  }
  const double ratio = std::max(0.5 * fastest / slowest, 1.0);
  constexpr int candidates = 12;
  double best = min_excess_ratio * min_excess_ratio * without.misfit * without.misfit;
  std::optional<double> found;
  for (int i = 0; i < candidates; ++i) {
    const double velocity = slowest * std::pow(ratio, (i + 0.5) / candidates);
    const double gain = stribeck_gain(without, velocity);
    if (!(gain > best)) continue;
    best = gain;
    found = velocity;
  }
  return found;
}

FreeParameters parameters_without_stribeck(std::span<const SlidingRecord> records,
                                           const std::vector<PositionWave>& waves) {
  FreeParameters free{};
  free[log_inertia] = free[coulomb_level] = free[viscous_damping] = true;
  free[offset_torque] = moves_along(records, 1.0) && moves_along(records, -1.0);
  for (std::size_t i = 0; i < waves.size(); ++i) {
    free[position_amplitudes + 2 * i] = true;
    free[position_amplitudes + 2 * i + 1] = waves[i].periods != 0.0;
  }
  return free;
}

/// The fit, with the Stribeck curve if the records show one.
SlidingFit best_fit(std::span<const SlidingRecord> records, const std::vector<PositionWave>& waves) {
  FreeParameters free = parameters_without_stribeck(records, waves);
  SlidingFit without = fit_sliding(records, starting_point(records, free[offset_torque]), free, waves);
  const std::optional<double> velocity = visible_stribeck_velocity(records, without);
  if (!velocity) return without;
  free[stribeck_excess] = free[log_stribeck_velocity] = true;
  SlidingPoint start = without.point;
  start[stribeck_excess] = 0.1 * std::abs(start[coulomb_level]);
  start[log_stribeck_velocity] = std::log(*velocity);
  try {
    SlidingFit fit = fit_sliding(records, start, free, waves);
    const SlidingPoint error = fit.covariance.diagonal().cwiseSqrt();
    const bool shown = fit.point[stribeck_excess] >= min_excess_ratio * error[stribeck_excess] &&
                       error[log_stribeck_velocity] < 0.5 * fit::max_half_width(true);
    return shown ? fit : without;
  } catch (const Failure&) {
    return without;
  }
}

/// The fit in windows that are as long as the law explains to a step of the readings.
SlidingFit fit_in_windows(std::vector<SlidingRecord>& records, const std::vector<PositionWave>& waves) {
  set_position_waves(records, waves);
  for (SlidingRecord& record : records) cut_windows(record, max_window_samples);
  SlidingFit fit = best_fit(records, waves);
  for (std::size_t samples = max_window_samples / 4; fit.misfit > 1.0 && samples >= min_window_samples;
       samples /= 4) {
    for (SlidingRecord& record : records) cut_windows(record, samples);
    fit = best_fit(records, waves);
  }
  return fit;
}

/// The waves of the fit that are shown.
std::vector<PositionWave> shown_waves(const SlidingFit& fit) {
  std::vector<PositionWave> waves;
  for (std::size_t i = 0; i < fit.waves.size(); ++i)
    if (is_shown(fit, i)) waves.push_back(fit.waves[i]);
  return waves;
}

/// The fit with the torques of the position that the records show, one after the other. One that stood for
/// another goes when that one is found.
SlidingFit fit_with_position(std::vector<SlidingRecord>& records) {
  SlidingFit fit = fit_in_windows(records, {});
  constexpr std::size_t rounds = 2 * max_position_waves;
  for (std::size_t round = 0; round < rounds && fit.waves.size() < max_position_waves; ++round) {
    const std::optional<PositionWave> wave = strongest_wave(fit);
    if (!wave) break;
    std::vector<PositionWave> waves = fit.waves;
    waves.push_back(*wave);
    set_position_waves(records, waves);
    const FreeParameters free = parameters_without_stribeck(records, waves);
    const SlidingFit tried = fit_sliding(records, fit.point, free, waves);
    if (!is_shown(tried, waves.size() - 1)) {
      set_position_waves(records, fit.waves);
      break;
    }
    std::ranges::sort(waves, {}, &PositionWave::periods);
    fit = fit_in_windows(records, waves);
    if (const auto shown = shown_waves(fit); shown.size() < waves.size())
      fit = fit_in_windows(records, shown);
  }
  return fit;
}

void set_correlation(const SlidingFit& fit, SlidingIdentification& result) {
  std::vector<std::string> names{"inertia", "coulomb_level", "sliding_damping",
                                 "offset",  "excess",        "stribeck_velocity"};
  for (const PositionWave& wave : fit.waves)
    for (const char* part : {".sine", ".cosine"}) names.push_back(name_of(wave) + part);
  const SlidingPoint error = fit.covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    if (!fit.free[static_cast<std::size_t>(i)]) continue;
    result.correlated.push_back(names[static_cast<std::size_t>(i)]);
    std::vector<double>& row = result.correlation.emplace_back();
    for (Eigen::Index j = 0; j < error.size(); ++j) {
      if (fit.free[static_cast<std::size_t>(j)]) row.push_back(fit.covariance(i, j) / (error[i] * error[j]));
    }
  }
}

void refuse_unexplained(const SlidingIdentification& result) {
  if (result.unexplained_torque <= max_unexplained * result.torque) return;
  const SlidingRecord& record = result.records.front();
  fit::refuse(
      record.axis, record.name,
      fmt::format("inertia and sliding friction do not explain the motion: they leave {:.3g} of {:.3g} "
                  "$Nm (root mean square). Are the units right, is there another mass or a spring, was "
                  "the torque limited, does the axis move long before it slides? --exclude leaves parts "
                  "out.",
                  result.unexplained_torque, result.torque));
}

}  // namespace

std::string reason_of_distrust(const SlidingIdentification& identification) {
  if (std::ranges::none_of(identification.parameters, fit::is_estimated))
    return "no parameter is identifiable from these records";
  const auto position = std::ranges::find(identification.forces, "position", &RepeatingForce::with);
  constexpr double tolerated = 0.1;
  if (position == identification.forces.end() || position->predicted < tolerated) return "";
  return fmt::format(
      "the position explains {:.0f} % of the {:.3g} {} (of {:.3g}) that the law leaves unexplained",
      100.0 * position->predicted, identification.unexplained_torque,
      parameters::unit_on(identification.axis, "N m"), identification.torque);
}

SlidingIdentification identify_sliding(std::vector<SlidingRecord> records) {
  const SlidingFit fit = fit_with_position(records);
  SlidingIdentification result;
  result.axis = records.front().axis;
  result.parameters = estimates_of(fit, result.axis);
  result.waves = fit.waves;
  result.misfit = fit.misfit;
  result.unexplained_torque = fit.unexplained_torque;
  result.torque = torque_rms(records);
  set_correlation(fit, result);
  result.runs = free_runs(fit);
  result.forces = repeating_forces(fit);
  result.reversal = reversal_friction(fit);
  result.records = std::move(records);
  refuse_unexplained(result);
  result.fragment = sliding_fragment(result);
  return result;
}

}  // namespace zerocount::sliding_identification
