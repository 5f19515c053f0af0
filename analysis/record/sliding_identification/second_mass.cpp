#include "analysis/record/sliding_identification/second_mass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Core>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/record/sliding_identification/added_column.hpp"
#include "analysis/record/sliding_identification/missing_torque.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

/// A window (piece of a record) of a fit, linearised about the fitted parameters and initial state.
struct LinearWindow {
  /// Derivatives of the residuals with respect to the initial position and velocity.
  Eigen::MatrixXd by_start;
  /// Derivatives of the residuals with respect to the free parameters, and the residuals in the last column,
  /// all after regression on `by_start`.
  Eigen::MatrixXd known;
  std::vector<double> interval;     ///< [interval] Sampling intervals, s.
  std::vector<double> per_inertia;  ///< [interval] Acceleration u/J by the drive torque, in encoder steps/s².
};

LinearWindow linear_window(const FittedWindow& fitted, const SlidingFit& fit) {
  const SlidingRecord& record = *fitted.record;
  const Window& window = *fitted.window;
  const WindowSlopes slopes = slopes_of(fitted, fit.point);
  LinearWindow linear{slopes.by_start, without(slopes.by_start, free_slopes(slopes, fit.free)), {}, {}};
  const double scale = std::exp(-fit.point[log_inertia]) / record.resolution;
  for (std::size_t k = window.first; k < window.last; ++k) {
    const double time = record.time[k + 1] - record.time[k];
    double torque = motion::course_after(record.torque[k], 0.5 * time).now - fit.point[offset_torque] -
                    window.direction * fit.point[coulomb_level] -
                    fit.point[viscous_damping] * record.velocity[k];
    for (std::size_t j = 0; j < position_terms && record.waves > 0; ++j)
      torque -= record.shape_between[k][j] * fit.point[static_cast<Eigen::Index>(position_amplitudes + j)];
    linear.interval.push_back(time);
    linear.per_inertia.push_back(scale * torque);
  }
  return linear;
}

/// Responses of an oscillator in a window, one column each: its deflection q from rest under the drive
/// torque, and two free oscillations.
/// @param pole complex pole of the oscillator, 1/s
Eigen::MatrixXd oscillations(const LinearWindow& window, std::complex<double> pole) {
  Eigen::MatrixXd columns(window.known.rows(), 3);
  std::complex<double> driven = -window.per_inertia.front() / pole;
  std::complex<double> own = 1.0;
  std::complex<double> growth;
  double interval = 0.0;
  for (Eigen::Index i = 0;; ++i) {
    columns.row(i) << driven.imag() / pole.imag(), own.real(), own.imag();
    if (i + 1 == columns.rows()) return columns;
    const auto k = static_cast<std::size_t>(i);
    if (window.interval[k] != interval) growth = std::exp((interval = window.interval[k]) * pole);
    driven = growth * driven + (growth - 1.0) / pole * window.per_inertia[k];
    own *= growth;
  }
}

Equations equations_of(const LinearWindow& window, std::complex<double> pole) {
  const Eigen::MatrixXd added = without(window.by_start, oscillations(window, pole));
  Eigen::MatrixXd columns(window.known.rows(), window.known.cols() + 1);
  columns << added.col(0), window.known;
  columns = without(added.rightCols(2), columns);
  const Eigen::MatrixXd products = numerics::transposed_product(columns, columns);
  const Eigen::Index size = products.cols() - 1;
  return {products.topLeftCorner(size, size), products.topRightCorner(size, 1), products(size, size)};
}

/// Fit of the amplitude A of a second mass's oscillation at one frequency (omega, rad/s).
struct Amplitude {
  double omega{0.0};
  AddedColumn column{};
};

Amplitude amplitude_at(const std::vector<LinearWindow>& windows, double omega, double damping) {
  const std::complex<double> pole = omega * std::complex(-damping, std::sqrt(1.0 - damping * damping));
  std::vector<Equations> parts;
  double samples = 0.0;
  for (const LinearWindow& window : windows) {
    parts.push_back(equations_of(window, pole));
    samples += static_cast<double>(window.known.rows());
  }
  constexpr double of_start = 4.0;
  const double freedom = samples - of_start * static_cast<double>(parts.size()) -
                         static_cast<double>(parts.front().right.size());
  return {omega, added_column(parts, freedom)};
}

/// Variance that independent residuals would need to give A its standard error: the larger one of their own
/// variance and that of the jackknife.
double variance_of(const AddedColumn& column) {
  return std::max({column.white, column.clustered, std::numeric_limits<double>::min()});
}

/// Smallest ratio of A to its standard error that is significant: chance exceeds it in one of 1000 records,
/// at any of 100 tried combinations of frequency and damping.
/// @param windows number of windows
double least_ratio(std::size_t windows) {
  constexpr double places = 100.0;
  constexpr double chance = 1e-3 / places;
  return statistics::student_t_quantile(std::max(2.0, static_cast<double>(windows) - 1.0),
                                        1.0 - 0.5 * chance);
}

std::vector<Amplitude> amplitudes_of(const std::vector<LinearWindow>& windows, double slowest,
                                     double fastest) {
  constexpr double step = 1.12;
  std::vector<Amplitude> amplitudes;
  for (double omega = slowest; omega < fastest; omega *= step)
    for (const double damping : {0.02, 0.08, 0.3})
      amplitudes.push_back(amplitude_at(windows, omega, damping));
  return amplitudes;
}

/// Frequency of the best fit, Hz, if only neighbouring frequencies explain nearly as much; 0 if others do
/// too.
double well_known_frequency(const std::vector<Amplitude>& amplitudes, const Amplitude& best) {
  double low = best.omega;
  double high = best.omega;
  for (const Amplitude& one : amplitudes) {
    constexpr double visible = 20.0;  // of χ² with one degree of freedom
    if (one.column.gain < best.column.gain - visible * variance_of(best.column)) continue;
    low = std::min(low, one.omega);
    high = std::max(high, one.omega);
  }
  constexpr double well_known = 1.3;
  const bool has_both_ends = low > amplitudes.front().omega && high < amplitudes.back().omega;
  return has_both_ends && high < well_known * low ? best.omega / (2.0 * std::numbers::pi) : 0.0;
}

std::optional<SecondMass> shown_by(const SlidingFit& fit) {
  std::vector<LinearWindow> windows;
  double longest = 0.0;  // s
  for (const FittedWindow& fitted : fit.windows) {
    const std::vector<double>& time = fitted.record->time;
    windows.push_back(linear_window(fitted, fit));
    longest = std::max(longest, time[fitted.window->last] - time[fitted.window->first]);
  }
  const SlidingRecord& first = *fit.windows.front().record;
  const double rate = static_cast<double>(first.time.size() - 1) / first.time.back();
  constexpr double rad_per_sample = 1.5;
  const std::vector<Amplitude> amplitudes =
      amplitudes_of(windows, 2.0 * std::numbers::pi / longest, rad_per_sample * rate);
  const auto best =
      std::ranges::max_element(amplitudes, {}, [](const Amplitude& one) { return one.column.gain; });
  constexpr double least_explained = 0.03;
  if (best == amplitudes.end() || best->column.explained < least_explained ||
      std::sqrt(best->column.gain / variance_of(best->column)) < least_ratio(windows.size()))
    return std::nullopt;
  const std::vector<MissingTorque> others = tried_torques(fit);
  if (others.front().visibility >= 1.0 && others.front().explained > best->column.explained)
    return std::nullopt;
  return SecondMass{best->column.explained, well_known_frequency(amplitudes, *best)};
}

}  // namespace

std::optional<SecondMass> visible_second_mass(const SlidingFit& fit, std::vector<SlidingRecord> records) {
  FreeParameters free = fit.free;
  std::vector<PositionWave> waves = fit.waves;
  // Short windows, which a second mass demands, may not have shown gravity.
  for (const PositionWave& usual : usual_waves(records.front())) {
    if (waves.size() == max_position_waves ||
        std::ranges::find(waves, usual.periods, &PositionWave::periods) != waves.end())
      continue;
    free[position_amplitudes + 2 * waves.size()] = true;
    free[position_amplitudes + 2 * waves.size() + 1] = usual.periods != 0.0;
    waves.push_back(usual);
  }
  set_position_waves(records, waves);
  constexpr std::size_t windows = 20;
  std::size_t samples = 0;
  for (const SlidingRecord& record : records)
    for (const Window& stroke : record.strokes) samples += samples_of(stroke);
  for (const std::size_t length : {std::clamp<std::size_t>(samples / windows, 128, 2048), 256UL, 128UL}) {
    for (SlidingRecord& record : records) cut_windows(record, length);
    try {
      if (const auto shown = shown_by(fit_sliding(records, fit.point, free, waves))) return shown;
    } catch (const Failure&) {
      continue;  // no motion in such windows fits
    }
  }
  return std::nullopt;
}

}  // namespace zerocount::sliding_identification
