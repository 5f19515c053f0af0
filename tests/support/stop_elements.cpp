#include "tests/support/stop_elements.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace zerocount::testing {

StopElements::StopElements(const friction::FrictionParameters& friction, std::size_t elements)
    : k1_(friction.k1) {
  const double beta = friction.beta;
  const double count = static_cast<double>(elements);
  for (std::size_t i = 0; i < elements; ++i) {
    // v = exp(−βr) at the cell's edges; stiffness beyond r is k2·v², its first moment k2·v²·(r + 1/(2β)).
    const double near = 1.0 - static_cast<double>(i) / count;
    const double far = 1.0 - static_cast<double>(i + 1) / count;
    const bool last = i + 1 == elements;
    const double r_near = -std::log(near) / beta;
    const double r_far = last ? 0.0 : -std::log(far) / beta;
    const double mean_excess = 0.5 / beta;
    const double stiffness = last ? friction.k2 * near * near : friction.k2 * (near - far) * (near + far);
    const double moment = friction.k2 * (near * near * (r_near + mean_excess) -
                                         (last ? 0.0 : far * far * (r_far + mean_excess)));
    elements_.push_back({moment / stiffness, stiffness, 0.0});
    const double error =
        last ? stiffness * mean_excess / std::numbers::e : stiffness * (r_far - r_near) / 4.0;
    virgin_error_ = std::max(virgin_error_, error);
  }
}

void StopElements::move_to(double x) {
  const double change = x - x_;
  for (Element& element : elements_)
    element.elongation = std::clamp(element.elongation + change, -element.threshold, element.threshold);
  x_ = x;
}

double StopElements::energy() const {
  double sum = 0.5 * k1_ * x_ * x_;
  for (const Element& element : elements_)
    sum += 0.5 * element.stiffness * element.elongation * element.elongation;
  return sum;
}

double StopElements::torque() const {
  double sum = k1_ * x_;
  for (const Element& element : elements_) sum += element.stiffness * element.elongation;
  return sum;
}

}  // namespace zerocount::testing
