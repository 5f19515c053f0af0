#include "core/loop/filter.hpp"

#include <cmath>
#include <numbers>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::loop {
namespace {

/// (n₁·p + n₀)/(d₁·p + 1), p and w as in bilinear.
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

bool is_stable(const BiquadConstants<double>& filter) {
  return std::abs(filter.a2) < 1.0 && std::abs(filter.a1) < 1.0 + filter.a2;
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
