#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/numerics/dense.hpp"
#include "core/numerics/roots.hpp"
#include "core/theory/linear_loop.hpp"
#include "core/theory/margins.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

constexpr double half_turn = std::numbers::pi;
constexpr double lowest_angle = 1e-6 * half_turn;
constexpr double highest_angle = (1.0 - 1e-9) * half_turn;
constexpr double narrowest = 1e-9;  // distance from the unit circle below which a root lies on it

/// A real function of the angle ωT (rad) whose changes of sign are searched.
using Sought = std::function<double(double angle)>;

void make_increasing(std::vector<double>& angles) {
  std::erase_if(angles, [](double angle) { return !(angle >= lowest_angle && angle <= highest_angle); });
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
}

double distance_from_circle(Complex root) {
  return std::abs(std::log(std::abs(root)));
}

void add_around(Complex root, std::vector<double>& angles) {
  if (std::abs(root) < 0.2) return;
  const double centre = std::abs(std::arg(root));
  const double width = std::max(distance_from_circle(root), narrowest);
  for (const double part : {0.0, 0.1, 0.3, 0.6, 1.0, 1.7, 3.0, 6.0, 12.0}) {
    for (const double angle : {centre - part * width, centre + part * width}) angles.push_back(angle);
  }
}

/// The zeros z of the polynomial c₀ + c₁·z⁻¹ + c₂·z⁻² + …
Eigen::VectorXcd zeros_of(const std::vector<double>& c) {
  const auto first = std::ranges::find_if(c, [](double x) { return x != 0.0; });
  const Eigen::Index order = std::max<Eigen::Index>(c.end() - first, 1) - 1;
  if (order == 0) return {};
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  for (Eigen::Index i = 0; i < order; ++i) {
    companion(0, i) = -first[i + 1] / *first;
    if (i > 0) companion(i, i - 1) = 1.0;
  }
  return numerics::eigenvalues(companion);
}

/// Removes from `angles` those at which a root on the unit circle makes the response infinite, or 0/0.
void remove_at(const Eigen::VectorXcd& roots, std::vector<double>& angles) {
  for (const Complex root : roots) {
    if (distance_from_circle(root) > narrowest) continue;
    const double centre = std::abs(std::arg(root));
    std::erase_if(angles, [&](double angle) { return std::abs(angle - centre) < 0.05 * narrowest; });
  }
}

/// The angle between low and high at which f changes its sign, by bisection.
/// @param at_low value of f at `low`.
double sign_change(const Sought& f, double low, double high, double at_low) {
  const auto is_before = [&](double angle) { return (f(angle) > 0.0) == (at_low > 0.0); };
  const auto narrow = [](const numerics::Bracket& angle) {
    return !(angle.fails - angle.holds > 1e-12 * angle.fails);
  };
  const auto [before, after] = numerics::bisect({low, high}, is_before, narrow);
  return 0.5 * (before + after);
}

/// An angle between low and high at which f has the other sign than at both ends, where it has the sign of
/// `side`. The search minimises |f| by golden sections; NaN if it finds no such angle.
double other_side(const Sought& f, double low, double high, double side) {
  constexpr double section = 0.381966011250105;
  constexpr int steps = 40;
  const auto height = [&](double angle) { return side > 0.0 ? f(angle) : -f(angle); };
  double left = low + section * (high - low);
  double right = high - section * (high - low);
  double at_left = height(left);
  double at_right = height(right);
  for (int i = 0; i < steps; ++i) {
    if (at_left <= 0.0) return left;
    if (at_right <= 0.0) return right;
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = low + section * (high - low);
      at_left = height(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = high - section * (high - low);
      at_right = height(right);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The angles ωT (rad) at which `of_response`, a real function of the response, changes its sign.
std::vector<double> sign_changes(const SampledResponse& response, double (*of_response)(Complex)) {
  constexpr double near = 0.3;  // |f| below which it may change its sign and back between three angles
  const Sought f = [&](double angle) { return of_response(response.at(angle)); };
  const std::vector<double>& angles = response.angles;
  std::vector<double> found;
  std::vector<double> values;
  values.reserve(angles.size());
  for (const Complex value : response.values) values.push_back(of_response(value));
  for (std::size_t i = 1; i < angles.size(); ++i) {
    if ((values[i] > 0.0) != (values[i - 1] > 0.0)) {
      found.push_back(sign_change(f, angles[i - 1], angles[i], values[i - 1]));
      continue;
    }
    const bool is_last = i + 1 == angles.size();
    if (is_last || (values[i + 1] > 0.0) != (values[i] > 0.0) || !(std::abs(values[i]) < near)) continue;
    if (std::abs(values[i]) > std::abs(values[i - 1]) || std::abs(values[i]) > std::abs(values[i + 1]))
      continue;
    const double between = other_side(f, angles[i - 1], angles[i + 1], values[i]);
    if (std::isnan(between)) continue;
    found.push_back(sign_change(f, angles[i - 1], between, values[i - 1]));
    found.push_back(sign_change(f, between, angles[i + 1], -values[i + 1]));
  }
  return found;
}

std::vector<double> logarithmic_angles() {
  constexpr int points = 600;
  std::vector<double> angles;
  for (int i = 0; i <= points; ++i)
    angles.push_back(lowest_angle * std::pow(highest_angle / lowest_angle, double(i) / points));
  return angles;
}

}  // namespace

void add_angles_around(const Eigen::VectorXcd& roots, std::vector<double>& angles) {
  for (const Complex root : roots) add_around(root, angles);
  make_increasing(angles);
  remove_at(roots, angles);
}

std::vector<double> search_angles(const FrozenLoop& loop) {
  constexpr double max_turn = 0.3;  // of the phase by the delay, rad
  static const std::vector<double> of_any_loop = logarithmic_angles();
  std::vector<double> angles = of_any_loop;
  const double step = max_turn / (loop.plant.delay + 2);
  for (double angle = step; angle < half_turn; angle += step) angles.push_back(angle);
  std::vector<Eigen::VectorXcd> roots{numerics::eigenvalues(loop.plant.A)};
  for (const loop::LinearBlock& stage : loop.controller) {
    for (const loop::SignalPath& path : stage) {
      roots.push_back(zeros_of(path.transfer.a));
      roots.push_back(zeros_of(path.transfer.b));
    }
  }
  for (const Eigen::VectorXcd& each : roots) {
    for (const Complex root : each) add_around(root, angles);
  }
  make_increasing(angles);
  for (const Eigen::VectorXcd& each : roots) remove_at(each, angles);
  return angles;
}

SampledResponse sampled(Response response, std::vector<double> angles) {
  SampledResponse sampled{std::move(response), std::move(angles)};
  sampled.values.reserve(sampled.angles.size());
  for (const double angle : sampled.angles) sampled.values.push_back(sampled.at(angle));
  return sampled;
}

std::vector<double> gain_crossovers(const SampledResponse& response) {
  return sign_changes(response, [](Complex value) { return 0.5 * std::log(std::norm(value)); });
}

std::vector<double> phase_crossovers(const SampledResponse& response) {
  std::vector<double> found =
      sign_changes(response, [](Complex value) { return value.imag() / std::sqrt(std::norm(value)); });
  // Across a pole on the unit circle the response jumps from one side of the real axis to the other.
  std::erase_if(found, [&](double angle) {
    constexpr double apart = 1e-11;
    const Complex before = response.at(angle * (1.0 - apart));
    const Complex after = response.at(angle * (1.0 + apart));
    return !((before * std::conj(after)).real() > 0.0);
  });
  return found;
}

}  // namespace zerocount::theory
