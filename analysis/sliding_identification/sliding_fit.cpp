#include "analysis/sliding_identification/sliding_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>
#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <fmt/format.h>

#include "analysis/record_fit/joint_fit.hpp"
#include "core/failure/failure.hpp"
#include "core/motion/torque_course.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {

namespace {

/// Mean torque over the interval from sample k to the next, nearly.
double torque_after(const SlidingRecord& record, std::size_t k) {
  return motion::course_after(record.torque[k], 0.5 * (record.time[k + 1] - record.time[k])).now;
}

}  // namespace

TorqueBalance torque_balance(const SlidingRecord& record, std::size_t k, double direction) {
  const std::size_t h = record.smoothing;
  const auto half = static_cast<double>(2 * h);
  const double acceleration =
      (record.velocity[k + h] - record.velocity[k - h]) / (record.time[k + h] - record.time[k - h]);
  double velocity = 0.5 * (record.velocity[k - h] + record.velocity[k + h]);
  for (std::size_t i = k - h + 1; i < k + h; ++i) velocity += record.velocity[i];
  double torque = 0.0;
  for (std::size_t i = 0; i < 4 * h; ++i) {
    const double from_middle = std::abs(static_cast<double>(i) + 0.5 - half);
    torque += (half - from_middle) * torque_after(record, k - 2 * h + i);
  }
  TorqueBalance balance{{acceleration, direction, velocity / half, 1.0, 0.0, 0.0}, torque / (half * half)};
  if (record.turns) {
    const double angle = 2.0 * std::numbers::pi * (record.origin + record.position[k]) / record.pitch;
    balance.terms.tail<2>() << std::sin(angle), std::cos(angle);
  }
  return balance;
}

namespace {

constexpr int most_periods = 1000;
constexpr Eigen::Index wave_terms = 2;  // sine and cosine

/// What the torque of a window may depend on.
struct WindowTerms {
  Eigen::VectorXd known;           ///< acceleration, direction, velocity, 1, and the terms of known waves
  std::array<double, 5> position;  ///< over its length
  double torque;                   ///< unexplained
};

/// Means over the window.
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

/// Sum of squares that a regression leaves, with or without one more wave.
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
    const double left = squares_left(with_usual, &waves[i]);
    if (!(left < to_beat)) continue;
    least = to_beat = left;
    found = waves[i];
  }
  const double ratio = (without - least) / 2.0 / (least / static_cast<double>(without_usual.size() - terms));
  return ratio > visible ? std::optional(found) : std::nullopt;
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

namespace {

constexpr double tiny = std::numeric_limits<double>::min();

std::vector<FittedWindow> windows_of(std::span<const SlidingRecord> records) {
  std::vector<FittedWindow> windows;
  for (const SlidingRecord& record : records) {
    for (const Window& window : record.windows) {
      windows.push_back({&record, &window, {record.position[window.first], record.velocity[window.first]}});
    }
  }
  return windows;
}

/// Moves the point and the windows' initial states to the least sum of squares. @returns the sum.
double solve(SlidingFit& fit) {
  ceres::Problem problem;
  for (FittedWindow& fitted : fit.windows) {
    problem.AddResidualBlock(window_residuals(*fitted.record, *fitted.window).release(), nullptr,
                             fit.point.data(), fitted.start.data());
  }
  std::vector<int> known;
  const int size = problem.ParameterBlockSize(fit.point.data());
  for (int j = 0; j < size; ++j) {
    if (!fit.free[static_cast<std::size_t>(j)]) known.push_back(j);
  }
  problem.SetManifold(fit.point.data(), new ceres::SubsetManifold(size, known));
  record_fit::SearchSetting search;
  search.max_steps = 60;
  search.tolerance = 1e-9;
  search.trust_region = 1e12;  // Gauss–Newton steps, damped where they fail
  search.many_blocks = true;
  const record_fit::SearchResult found = record_fit::search_least_squares(problem, search);
  if (!found.found) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the simulated motion cannot be fitted to the positions; expected torque and "
                    "position in the units that --column gives",
                    fit.windows.front().record->name));
  }
  return found.squares;
}

/// Contribution of a window, or of several, to the estimating equations, the initial states eliminated.
struct Score {
  SlidingMatrix information{SlidingMatrix::Zero()};
  SlidingPoint score{SlidingPoint::Zero()};

  void operator+=(const Score& other) {
    information += other.information;
    score += other.score;
  }
};

Score score_of(const FittedWindow& fitted, const SlidingPoint& point) {
  const auto residuals = window_residuals(*fitted.record, *fitted.window);
  Eigen::VectorXd residual(residuals->num_residuals());
  const Eigen::Index size = residuals->parameter_block_sizes().front();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> slopes(residual.size(), size);
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> by_start(residual.size(), 2);
  const std::array parameters{point.data(), fitted.start.data()};
  std::array jacobians{slopes.data(), by_start.data()};
  residuals->Evaluate(parameters.data(), residual.data(), jacobians.data());
  slopes -= numerics::product(by_start, numerics::least_squares(by_start, slopes));
  Score score;
  score.information.topLeftCorner(size, size) = numerics::transposed_product(slopes, slopes);
  score.score.head(size) = -slopes.transpose() * residual;
  return score;
}

/// Scale of each free parameter that makes them comparable: 1/√information; 0 for the others.
SlidingPoint scale_of(const Score& total, const FreeParameters& free) {
  SlidingPoint scale = total.information.diagonal().cwiseMax(tiny).cwiseSqrt().cwiseInverse();
  for (std::size_t j = 0; j < sliding_dimension; ++j) {
    if (!free[j]) scale[static_cast<Eigen::Index>(j)] = 0.0;
  }
  return scale;
}

SlidingMatrix scaled(const SlidingPoint& scale, const SlidingMatrix& matrix) {
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

/// Scaled variance of the fits without one cluster each: (G − 1)/G·Σδ_g·δ_gᵀ with δ_g = (B − B_g)⁻¹·s_g.
SlidingMatrix jackknife(const SlidingPoint& scale, const Score& total, const std::vector<Score>& clusters) {
  const auto groups = static_cast<double>(clusters.size());
  SlidingMatrix sum = SlidingMatrix::Zero();
  for (const Score& cluster : clusters) {
    const SlidingPoint change = numerics::least_squares(
        scaled(scale, total.information - cluster.information), scale.cwiseProduct(cluster.score));
    sum += change * change.transpose();
  }
  return (groups - 1.0) / groups * sum;
}

/// Enlarges a covariance to the larger variance of each parameter; correlations stay.
SlidingMatrix enlarged(const SlidingMatrix& covariance, const SlidingMatrix& other) {
  const SlidingPoint ratio = other.diagonal().cwiseQuotient(covariance.diagonal().cwiseMax(tiny));
  return scaled(ratio.cwiseMax(1.0).cwiseSqrt(), covariance);
}

}  // namespace

SlidingPoint starting_point(std::span<const SlidingRecord> records, bool both_directions) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(balance_terms, balance_terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(balance_terms);
  for (const SlidingRecord& record : records) {
    const std::size_t reach = balance_reach(record);
    for (const Window& stroke : record.strokes) {
      for (std::size_t k = stroke.first; k <= stroke.last; ++k) {
        if (k < reach || k + reach >= record.time.size()) continue;
        TorqueBalance balance = torque_balance(record, k, stroke.direction);
        if (!both_directions) balance.terms[offset_term] = 0.0;
        normal += balance.terms * balance.terms.transpose();
        right += balance.terms * balance.torque;
      }
    }
  }
  const Eigen::VectorXd found = numerics::least_squares(normal, right);
  if (!(found[0] > 0.0) && found[direction_term] > 0.0) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: shows no sliding: it accelerates against the {}, as on a spring; material "
                              "tests within the pre-sliding range are identified without --sliding",
                              records.front().name, parameters::text_on(records.front().axis, "$torque")));
  }
  if (!(found[0] > 0.0)) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: the axis accelerates against the torque; is one of them of the wrong sign? "
                    "--column turns it with the factor -1",
                    records.front().name));
  }
  SlidingPoint point = SlidingPoint::Zero();
  point.head<4>() << std::log(found[0]), found[1], found[2], found[3];
  return point;
}

SlidingFit fit_sliding(std::span<const SlidingRecord> records, const SlidingPoint& start,
                       const FreeParameters& free, const std::vector<PositionWave>& waves) {
  SlidingFit fit;
  fit.waves = waves;
  fit.point = start;
  fit.free = free;
  fit.windows = windows_of(records);
  const double squares = solve(fit);
  Score total;
  std::vector<Score> by_window;
  std::vector<Score> by_stroke;
  double unexplained = 0.0;
  for (const FittedWindow& fitted : fit.windows) {
    const Score score = score_of(fitted, fit.point);
    total += score;
    by_window.push_back(score);
    if (fitted.window->first == fitted.record->strokes[fitted.window->stroke].first) by_stroke.emplace_back();
    by_stroke.back() += score;
    // A step of this window's offset alone.
    fit.unexplained.push_back(score.score[offset_torque] /
                              std::max(score.information(offset_torque, offset_torque), tiny));
    unexplained += fit.unexplained.back() * fit.unexplained.back();
    fit.samples += samples_of(*fitted.window);
  }
  const auto windows = static_cast<double>(fit.windows.size());
  const auto samples = static_cast<double>(fit.samples);
  fit.misfit = std::sqrt(squares / samples);
  fit.unexplained_torque = std::sqrt(unexplained / windows);
  const SlidingPoint scale = scale_of(total, free);
  const auto parameters = static_cast<double>(std::count(free.begin(), free.end(), true));
  const double variance = squares / std::max(1.0, samples - 2.0 * windows - parameters);  // of a residual
  SlidingMatrix covariance = variance * numerics::pseudo_inverse(scaled(scale, total.information));
  covariance = enlarged(covariance, jackknife(scale, total, by_window));
  constexpr std::size_t min_strokes = 12;  // with fewer the variance between strokes is known too badly
  if (by_stroke.size() >= min_strokes) covariance = enlarged(covariance, jackknife(scale, total, by_stroke));
  fit.covariance = scaled(scale, covariance);
  return fit;
}

double stribeck_gain(const SlidingFit& fit, double velocity) {
  SlidingPoint point = fit.point;
  point[stribeck_excess] = 0.0;
  point[log_stribeck_velocity] = std::log(velocity);
  Score total;
  for (const FittedWindow& fitted : fit.windows) total += score_of(fitted, point);
  FreeParameters free = fit.free;
  free[stribeck_excess] = true;
  const SlidingPoint scale = scale_of(total, free);
  const SlidingPoint right = scale.cwiseProduct(total.score);
  const SlidingPoint step = numerics::least_squares(scaled(scale, total.information), right);
  return step[stribeck_excess] > 0.0 ? right.dot(step) : 0.0;
}

}  // namespace zerocount::sliding_identification
