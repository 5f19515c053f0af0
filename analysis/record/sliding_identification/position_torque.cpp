#include "analysis/record/sliding_identification/position_torque.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>
#include <fmt/format.h>

#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr int most_periods = 1000;
constexpr Eigen::Index wave_terms = 2;  // sine and cosine

/// Means over a window (a piece of a record) of the quantities on which its torque may depend.
struct WindowTerms {
  /// Regressors that the law already has: acceleration, direction, velocity, 1, and the terms of the waves
  /// already fitted.
  Eigen::VectorXd known;
  std::array<double, 5> position;  ///< Five positions spread over the window, rad or m.
  double torque;                   ///< Mean torque that the law leaves unexplained in the window, N m or N.
};

/// Means over the window of sin(κ·x) and cos(κ·x) of a position-dependent torque; for a torque proportional
/// to the position, the mean position.
Eigen::VectorXd wave_means(const WindowTerms& window, const PositionWave& wave) {
  Eigen::VectorXd means = Eigen::VectorXd::Zero(wave_terms);
  for (const double x : window.position) {
    const PositionShape shape = shape_at(x, {&wave, 1});
    for (Eigen::Index j = 0; j < wave_terms; ++j)
      means[j] += shape[static_cast<std::size_t>(j)] / static_cast<double>(window.position.size());
  }
  return means;
}

std::vector<WindowTerms> windows_of(const SlidingFit& fit, std::span<const PositionWave> known) {
  std::vector<WindowTerms> found;
  for (std::size_t i = 0; i < fit.windows.size(); ++i) {
    const SlidingRecord& record = *fit.windows[i].record;
    const Window& window = *fit.windows[i].window;
    const double time = record.time[window.last] - record.time[window.first];
    WindowTerms& terms = found.emplace_back();
    const std::size_t parts = terms.position.size() - 1;
    for (std::size_t part = 0; part <= parts; ++part) {
      const std::size_t k = window.first + part * (window.last - window.first) / parts;
      terms.position[part] = record.origin + record.position[k];
    }
    terms.torque = fit.unexplained[i];
    constexpr Eigen::Index of_law = 4;
    terms.known.resize(of_law + wave_terms * std::ssize(known));
    terms.known.head(of_law) << (record.velocity[window.last] - record.velocity[window.first]) / time,
        window.direction, (record.position[window.last] - record.position[window.first]) / time, 1.0;
    for (std::size_t j = 0; j < known.size(); ++j)
      terms.known.segment(of_law + wave_terms * static_cast<Eigen::Index>(j), wave_terms) =
          wave_means(terms, known[j]);
  }
  return found;
}

/// Position half-way between sample k and the next, by the cubic through four samples; at the ends of the
/// record the mean of the two samples. Same unit as `position`.
double position_between(const std::vector<double>& position, std::size_t k) {
  if (k == 0 || k + 2 >= position.size()) return 0.5 * (position[k] + position[k + 1]);
  return (9.0 * (position[k] + position[k + 1]) - position[k - 1] - position[k + 2]) / 16.0;
}

/// Residual sum of squares of the regression of the windows' torques on known terms.
/// @param wave wave that is added to the terms; null: none
double squares_left(const std::vector<WindowTerms>& windows, const PositionWave* wave) {
  const Eigen::Index known = windows.front().known.size();
  const Eigen::Index all = known + (wave == nullptr ? 0 : wave_terms);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(all, all);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(all);
  Eigen::VectorXd terms(all);
  double squares = 0.0;
  for (const WindowTerms& window : windows) {
    terms.head(known) = window.known;
    if (wave != nullptr) terms.tail(wave_terms) = wave_means(window, *wave);
    normal += terms * terms.transpose();
    right += terms * window.torque;
    squares += window.torque * window.torque;
  }
  const Eigen::VectorXd found = numerics::least_squares(normal, right);
  return squares - found.dot(right);
}

PositionWave wave_of(double periods, double pitch) {
  return {periods, 2.0 * std::numbers::pi * periods / pitch};
}

/// The position-dependent torques (waves) to try, except those already in the fit; the usual ones come first.
std::vector<PositionWave> candidates(const SlidingFit& fit) {
  const SlidingRecord& record = *fit.windows.front().record;
  std::vector<PositionWave> waves = usual_waves(record);
  for (int periods = record.axis == parameters::AxisKind::linear ? 1 : 2;
       record.pitch > 0.0 && periods <= most_periods; ++periods)
    waves.push_back(wave_of(periods, record.pitch));
  std::erase_if(waves, [&](const PositionWave& wave) {
    return std::ranges::find(fit.waves, wave.periods, &PositionWave::periods) != fit.waves.end();
  });
  return waves;
}

}  // namespace

std::vector<PositionWave> usual_waves(const SlidingRecord& record) {
  if (record.axis == parameters::AxisKind::linear) return {PositionWave{}};
  return {wave_of(1.0, record.pitch)};
}

PositionShape shape_at(double x, std::span<const PositionWave> waves) {
  PositionShape shape{};
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const bool linear = waves[i].periods == 0.0;
    shape[2 * i] = linear ? x : std::sin(waves[i].wave_number * x);
    shape[2 * i + 1] = linear ? 0.0 : std::cos(waves[i].wave_number * x);
  }
  return shape;
}

void set_position_waves(std::vector<SlidingRecord>& records, std::span<const PositionWave> waves) {
  for (SlidingRecord& record : records) {
    record.waves = waves.size();
    record.shape.clear();
    record.shape_between.clear();
    if (waves.empty()) continue;
    for (const double position : record.position)
      record.shape.push_back(shape_at(record.origin + position, waves));
    for (std::size_t k = 0; k + 1 < record.position.size(); ++k)
      record.shape_between.push_back(shape_at(record.origin + position_between(record.position, k), waves));
  }
}

std::optional<PositionWave> strongest_wave(const SlidingFit& fit) {
  constexpr std::size_t spare = 10;  // windows beyond the terms of the regression
  constexpr double visible = 10.0;   // F of the wave; neighbouring windows are alike, so is_shown() decides
  const std::vector<PositionWave> waves = candidates(fit);
  std::vector<PositionWave> known = fit.waves;
  const std::vector<WindowTerms> without_usual = windows_of(fit, known);
  const std::size_t terms = static_cast<std::size_t>(without_usual.front().known.size()) + 2 * wave_terms;
  if (waves.empty() || without_usual.size() < terms + spare) return std::nullopt;
  const double without = squares_left(without_usual, nullptr);
  // Beside the usual wave, because another one may have to make up for it.
  const bool has_usual = waves.front().periods > 1.0;
  if (!has_usual) known.push_back(waves.front());
  const std::vector<WindowTerms> with_usual = windows_of(fit, known);
  PositionWave found = waves.front();
  double least = squares_left(without_usual, &waves.front());
  constexpr double better = 1.2;  // over a part of a revolution, waves of few periods look alike
  double to_beat = has_usual ? least : least / better;
  for (std::size_t i = 1; i < waves.size(); ++i) {
    const double squares = squares_left(with_usual, &waves[i]);
    if (!(squares < to_beat)) continue;
    least = to_beat = squares;
    found = waves[i];
  }
  const double ratio = (without - least) / 2.0 / (least / static_cast<double>(without_usual.size() - terms));
  return ratio > visible ? std::optional(found) : std::nullopt;
}

double visibility_of(const SlidingFit& fit, std::size_t wave) {
  const auto first = static_cast<Eigen::Index>(position_amplitudes + 2 * wave);
  const double periods = fit.waves[wave].periods;
  const Eigen::VectorXd amplitude = fit.point.segment(first, 2);
  const Eigen::MatrixXd covariance = fit.covariance.block(first, first, 2, 2);
  if (periods == 0.0) return std::abs(amplitude[0]) / (min_excess_ratio * std::sqrt(covariance(0, 0)));
  const Eigen::VectorXd weighted = numerics::least_squares(covariance, amplitude);
  // Hotelling's T² of two amplitudes, with the freedom ν of a jackknife over windows: P(T² > t) = (1 +
  // t/ν)^(−(ν−1)/2), by chance once in 1000 records, among all periods that are tried together.
  const double chance = 1e-3 / (periods == 1.0 ? 1.0 : most_periods);
  const double freedom = std::max(2.0, static_cast<double>(fit.windows.size()) - 1.0);
  return amplitude.dot(weighted) / (freedom * (std::pow(chance, -2.0 / (freedom - 1.0)) - 1.0));
}

std::optional<PositionWave> alike_wave(const SlidingFit& fit, std::size_t wave) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const FittedWindow& fitted : fit.windows) {
    for (const std::size_t k : {fitted.window->first, fitted.window->last}) {
      low = std::min(low, fitted.record->origin + fitted.record->position[k]);
      high = std::max(high, fitted.record->origin + fitted.record->position[k]);
    }
  }
  for (std::size_t i = 0; i < fit.waves.size(); ++i) {
    const double apart = std::abs(fit.waves[i].wave_number - fit.waves[wave].wave_number) * (high - low);
    if (i != wave && apart < 2.0 * std::numbers::pi) return fit.waves[i];
  }
  return std::nullopt;
}

std::string name_of(const PositionWave& wave) {
  return wave.periods == 0.0 ? "slope" : fmt::format("ripple.{:g}", wave.periods);
}

}  // namespace zerocount::sliding_identification
