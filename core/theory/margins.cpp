#include "core/theory/margins.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "core/numerics/dense.hpp"
#include "core/theory/linear_loop.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

constexpr double half_turn = std::numbers::pi;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Adds angles around that of the pole or zero z, spaced by its distance from the unit circle.
void add_angles_around(Complex z, std::vector<double>& angles) {
  if (std::abs(z) < 0.2) return;
  const double centre = std::abs(std::arg(z));
  const double width = std::max(std::abs(std::log(std::abs(z))), 1e-9);
  for (const double part : {0.0, 0.1, 0.3, 0.6, 1.0, 1.7, 3.0, 6.0, 12.0}) {
    for (const double angle : {centre - part * width, centre + part * width}) angles.push_back(angle);
  }
}

/// The zeros of c₀ + c₁·z⁻¹ + c₂·z⁻² + …
void add_angles_of(const std::vector<double>& c, std::vector<double>& angles) {
  const auto first = std::find_if(c.begin(), c.end(), [](double x) { return x != 0.0; });
  const Eigen::Index order = std::max<Eigen::Index>(c.end() - first, 1) - 1;
  if (order == 0) return;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  for (Eigen::Index i = 0; i < order; ++i) {
    companion(0, i) = -first[i + 1] / *first;
    if (i > 0) companion(i, i - 1) = 1.0;
  }
  for (const Complex z : numerics::eigenvalues(companion)) add_angles_around(z, angles);
}

/// The angle between low and high at which `sign` changes.
template <class Sign>
double crossing(double low, double high, Sign sign) {
  const bool at_low = sign(low);
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (sign(middle) == at_low ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<double> search_angles(const FrozenLoop& loop) {
  constexpr int points = 600;
  constexpr double lowest = 1e-6 * half_turn;
  constexpr double highest = (1.0 - 1e-9) * half_turn;
  std::vector<double> angles;
  for (int i = 0; i <= points; ++i) angles.push_back(lowest * std::pow(highest / lowest, double(i) / points));
  for (const Complex z : numerics::eigenvalues(loop.plant.A)) add_angles_around(z, angles);
  for (const loop::LinearBlock& stage : loop.controller) {
    for (const loop::SignalPath& path : stage) {
      add_angles_of(path.transfer.a, angles);
      add_angles_of(path.transfer.b, angles);
    }
  }
  std::erase_if(angles, [](double angle) { return !(angle >= lowest && angle <= highest); });
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

StabilityMargins stability_margins(const FrozenLoop& loop) {
  const auto loop_at = [&](double angle) { return open_loop(loop, angle); };
  const auto frequency = [&](double angle) { return angle / (2.0 * half_turn * loop.sample_time); };
  const auto amplifies = [&](double angle) { return std::abs(loop_at(angle)) > 1.0; };
  const auto leads = [&](double angle) { return loop_at(angle).imag() > 0.0; };

  StabilityMargins margins{{none, none}, {none, none}};
  const auto add_gain = [&](Complex value, double angle) {
    // At half the sample rate a gain of 0 may round to a small one.
    constexpr double rounding = 1e-12;
    if (!(value.real() < -rounding)) return;
    const double factor = 1.0 / std::abs(value);
    const bool nearer = std::abs(std::log(factor)) < std::abs(std::log(margins.gain.value));
    if (std::isnan(margins.gain.value) || nearer) margins.gain = {factor, frequency(angle)};
  };
  const auto add_phase = [&](double angle) {
    const double margin = std::arg(-loop_at(angle)) * 180.0 / half_turn;
    const bool nearer = std::abs(margin) < std::abs(margins.phase.value);
    if (std::isnan(margins.phase.value) || nearer) margins.phase = {margin, frequency(angle)};
  };

  const std::vector<double> angles = search_angles(loop);
  double last_angle = angles.front();
  Complex last = loop_at(last_angle);
  for (const double angle : angles) {
    const Complex now = loop_at(angle);
    if ((std::abs(now) > 1.0) != (std::abs(last) > 1.0)) add_phase(crossing(last_angle, angle, amplifies));
    if ((now.imag() > 0.0) != (last.imag() > 0.0)) {
      const double at = crossing(last_angle, angle, leads);
      add_gain(loop_at(at), at);
    }
    last_angle = angle;
    last = now;
  }
  // At half the sample rate L is a real number.
  add_gain(open_loop(Complex(-1.0), loop.plant, loop.controller), half_turn);
  return margins;
}

}  // namespace zerocount::theory
