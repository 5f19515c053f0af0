#include "analysis/sliding_identification/position_torque.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <fmt/format.h>

#include "analysis/sliding_identification/sliding_fit.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr int most_periods = 1000;
constexpr Eigen::Index law_terms = 4;   // acceleration, direction, velocity and 1
constexpr Eigen::Index wave_terms = 2;  // sine and cosine

/// What the torque of a window may depend on.
struct WindowTerms {
  Eigen::Vector<double, law_terms> law;
  std::array<double, 5> position;  ///< over its length
  double torque;                   ///< unexplained
};

std::vector<WindowTerms> windows_of(const SlidingFit& fit) {
  std::vector<WindowTerms> found;
  for (std::size_t i = 0; i < fit.windows.size(); ++i) {
    const SlidingRecord& record = *fit.windows[i].record;
    const Window& window = *fit.windows[i].window;
    const double time = record.time[window.last] - record.time[window.first];
    WindowTerms& terms = found.emplace_back();
    terms.law << (record.velocity[window.last] - record.velocity[window.first]) / time, window.direction,
        (record.position[window.last] - record.position[window.first]) / time, 1.0;
    const std::size_t parts = terms.position.size() - 1;
    for (std::size_t part = 0; part <= parts; ++part) {
      const std::size_t k = window.first + part * (window.last - window.first) / parts;
      terms.position[part] = record.origin + record.position[k];
    }
    terms.torque = fit.unexplained[i];
  }
  return found;
}

Eigen::VectorXd terms_with(const WindowTerms& window, const PositionWave* wave) {
  Eigen::VectorXd terms = Eigen::VectorXd::Zero(law_terms + wave_terms);
  terms.head<law_terms>() = window.law;
  if (wave == nullptr) return terms;
  for (const double x : window.position) {
    const PositionShape shape = shape_at(x, {wave, 1});
    for (Eigen::Index j = 0; j < wave_terms; ++j)
      terms[law_terms + j] +=
          shape[static_cast<std::size_t>(j)] / static_cast<double>(window.position.size());
  }
  return terms;
}

/// Sum of squares that a regression leaves, with or without the wave.
double squares_left(const std::vector<WindowTerms>& windows, const PositionWave* wave) {
  constexpr Eigen::Index all = law_terms + wave_terms;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(all, all);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(all);
  double squares = 0.0;
  for (const WindowTerms& window : windows) {
    const Eigen::VectorXd terms = terms_with(window, wave);
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

/// The waves to try, a usual one first.
std::vector<PositionWave> candidates(const SlidingFit& fit) {
  const SlidingRecord& record = *fit.windows.front().record;
  std::vector<PositionWave> waves;
  if (record.axis == parameters::AxisKind::linear) waves.push_back({});
  for (int periods = 1; record.pitch > 0.0 && periods <= most_periods; ++periods)
    waves.push_back(wave_of(periods, record.pitch));
  std::erase_if(waves, [&](const PositionWave& wave) {
    return std::ranges::find(fit.waves, wave.periods, &PositionWave::periods) != fit.waves.end();
  });
  return waves;
}

}  // namespace

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
    if (waves.empty()) continue;
    for (const double position : record.position)
      record.shape.push_back(shape_at(record.origin + position, waves));
  }
}

std::optional<PositionWave> strongest_wave(const SlidingFit& fit) {
  constexpr std::size_t spare = 10;  // windows beyond the terms of the regression
  constexpr double visible = 10.0;   // F of the wave; neighbouring windows are alike, so is_shown() decides
  const std::vector<WindowTerms> windows = windows_of(fit);
  constexpr auto terms = static_cast<std::size_t>(law_terms + wave_terms);
  if (windows.size() < terms + spare) return std::nullopt;
  const double without = squares_left(windows, nullptr);
  std::optional<PositionWave> found;
  double least = without;
  double of_usual = without;  // the wave that comes first
  const std::vector<PositionWave> waves = candidates(fit);
  for (const PositionWave& wave : waves) {
    const double left = squares_left(windows, &wave);
    if (&wave == &waves.front()) of_usual = left;
    if (!(left < least)) continue;
    least = left;
    found = wave;
  }
  constexpr double alike = 1.2;  // over a part of a revolution, waves of few periods look alike
  if (found && of_usual < alike * least) {
    found = waves.front();
    least = of_usual;
  }
  const double ratio = (without - least) / 2.0 / (least / static_cast<double>(windows.size() - terms));
  return ratio > visible ? found : std::nullopt;
}

bool is_shown(const SlidingFit& fit, std::size_t wave) {
  const auto first = static_cast<Eigen::Index>(position_amplitudes + 2 * wave);
  const double periods = fit.waves[wave].periods;
  const Eigen::VectorXd amplitude = fit.point.segment(first, 2);
  const Eigen::MatrixXd covariance = fit.covariance.block(first, first, 2, 2);
  if (periods == 0.0) return std::abs(amplitude[0]) >= min_excess_ratio * std::sqrt(covariance(0, 0));
  const Eigen::VectorXd weighted = numerics::least_squares(covariance, amplitude);
  // χ² of two amplitudes: 1 in 1000 by chance, and as rare among all periods that are tried.
  const double usual = 13.8;
  const double of_many = usual + 2.0 * std::log(most_periods);
  return amplitude.dot(weighted) >= (periods == 1.0 ? usual : of_many);
}

std::string name_of(const PositionWave& wave) {
  return wave.periods == 0.0 ? "slope" : fmt::format("ripple.{:g}", wave.periods);
}

}  // namespace zerocount::sliding_identification
