#include "core/loop/controller/filter.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::loop {
namespace {

/// Coefficients of the polynomial c₀ + c₁·z⁻¹ + c₂·z⁻².
using Polynomial = std::array<double, 3>;

/// Warped natural frequency tan(ω0·T/2) of the roots of a polynomial in z⁻¹; empty if it has no roots other
/// than z = 0, 1 and −1.
std::optional<double> natural_frequency(const Polynomial& c) {
  const double low = std::abs(c[0] + c[1] + c[2]);
  const double high = std::abs(c[0] - c[1] + c[2]);
  const double rounding = 1e-9 * (std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]));
  const bool constant = c[1] == 0.0 && c[2] == 0.0;
  if (constant || low <= rounding || high <= rounding) return std::nullopt;
  return c[2] == 0.0 ? low / high : std::sqrt(low / high);
}

/// The polynomial with (a + z⁻¹)/(1 + a·z⁻¹) in place of z⁻¹, times the denominator's power `order`, 0 to 2.
Polynomial substituted(const Polynomial& c, double a, int order) {
  if (order == 0) return c;
  if (order == 1) return {c[0] + a * c[1], a * c[0] + c[1], 0.0};
  return {c[0] + a * c[1] + a * a * c[2], 2.0 * a * (c[0] + c[2]) + (1.0 + a * a) * c[1],
          a * a * c[0] + a * c[1] + c[2]};
}

/// Digital first-order filter for (n₁·p + n₀)/(d₁·p + 1), with p and w as in bilinear().
BiquadConstants<double> first_order(double n1, double n0, double d1, double w) {
  const double scale = d1 + w;
  return {(n1 + n0 * w) / scale, (n0 * w - n1) / scale, 0.0, (w - d1) / scale, 0.0};
}

}  // namespace

BiquadConstants<double> bilinear(double n2, double n1, double n0, double damping, double w) {
  const double scale = 1.0 + 2.0 * damping * w + w * w;
  return {(n2 + n1 * w + n0 * w * w) / scale, 2.0 * (n0 * w * w - n2) / scale,
          (n2 - n1 * w + n0 * w * w) / scale, 2.0 * (w * w - 1.0) / scale,
          (1.0 - 2.0 * damping * w + w * w) / scale};
}

BiquadConstants<double> discretised(const Filter& filter, double sample_rate) {
  const double w = numerics::tan(std::numbers::pi * filter.frequency / sample_rate);
  switch (filter.kind) {
    case FilterKind::lowpass:
      return bilinear(0.0, 0.0, 1.0, filter.damping, w);
    case FilterKind::notch:
      return bilinear(1.0, 2.0 * filter.damping * filter.depth, 1.0, filter.damping, w);
    case FilterKind::lead:
      return first_order(std::sqrt(filter.ratio), 1.0, 1.0 / std::sqrt(filter.ratio), w);
    case FilterKind::biquad:
      break;
  }
  return {filter.b[0], filter.b[1], filter.b[2], filter.a[0], filter.a[1]};
}

std::optional<Filter> resampled(const Filter& biquad, double ratio) {
  const Polynomial zeros = biquad.b;
  const Polynomial poles{1.0, biquad.a[0], biquad.a[1]};
  const std::optional<double> of_zeros = natural_frequency(zeros);
  const std::optional<double> of_poles = natural_frequency(poles);
  // w = tan(ω·T/2) becomes tan(ω·T/(2·ratio)), for small ω w/ratio.
  double stretch = ratio;
  if (of_zeros || of_poles) {
    const double w = std::sqrt(of_zeros.value_or(of_poles.value_or(0.0)) * of_poles.value_or(*of_zeros));
    stretch = w / numerics::tan(numerics::asin(w / std::sqrt(1.0 + w * w)) / ratio);
  }
  const double a = (1.0 - stretch) / (1.0 + stretch);
  const auto is_in_neither = [&](std::size_t power) { return zeros[power] == 0.0 && poles[power] == 0.0; };
  const int order = !is_in_neither(2) ? 2 : is_in_neither(1) ? 0 : 1;
  const Polynomial b = substituted(zeros, a, order);
  const Polynomial d = substituted(poles, a, order);
  const double at_half_the_rate = std::abs(poles[0] - poles[1] + poles[2]);
  if (at_half_the_rate < 1e-9 || d[0] == 0.0) return std::nullopt;
  Filter filter = biquad;
  filter.b = {b[0] / d[0], b[1] / d[0], b[2] / d[0]};
  filter.a = {d[1] / d[0], d[2] / d[0]};
  return filter;
}

Filters::Filters(const ControllerParameters& parameters, const ControlStart& /*start*/) {
  sections_.reserve(parameters.blocks.filters.size());
  for (const Filter& filter : parameters.blocks.filters) {
    sections_.push_back({discretised(filter, parameters.sample_rate)});
  }
}

double Filters::take_over(double torque) {
  for (auto section = sections_.rbegin(); section != sections_.rend(); ++section) {
    const auto& [b0, b1, b2, a1, a2] = section->constants;
    const double numerator = b0 + b1 + b2;
    const double denominator = 1.0 + a1 + a2;
    section->state = {0.0, 0.0};
    if (numerator == 0.0 || denominator == 0.0) continue;
    const double input = torque * denominator / numerator;
    section->state.s2 = b2 * input - a2 * torque;
    section->state.s1 = b1 * input - a1 * torque + section->state.s2;
    torque = input;
  }
  return torque;
}

LinearChain Filters::linear() const {
  LinearChain chain;
  for (const Section& section : sections_) {
    const auto& [b0, b1, b2, a1, a2] = section.constants;
    chain.push_back({{LoopSignal::torque, {{b0, b1, b2}, {1.0, a1, a2}}}});
  }
  return chain;
}

}  // namespace zerocount::loop
