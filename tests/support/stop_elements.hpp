#pragma once

#include <cstddef>
#include <vector>

#include "core/friction/parameters.hpp"

namespace zerocount::testing {

/// The hysteretic spring by brute force: a Prandtl–Ishlinskii sum of elastic-plastic stop elements beside a
/// linear spring,
///
///   σ = k1·x + Σ wᵢ·eᵢ,   eᵢ ← clamp(eᵢ + dx, −rᵢ, rᵢ),
///
/// which needs neither reversal points nor closure rules. Matching the virgin curve ½f(2x) = k1·x + ∫
/// p(r)·min(x, r) dr gives the density p(r) = −d²/dr² ½f(2r) = 2βk2·exp(−2βr) of the thresholds r (rad), in N
/// m/rad². Source: Brokate & Sprekels, "Hysteresis and Phase Transitions", section 2.4.
///
/// Discretisation: N cells uniform in 1 − exp(−βr), each replaced by one element with the cell's stiffness wᵢ
/// = ∫p dr at the cell's centroid. The virgin curve is then exact at the cell edges and off by at most ε
/// inside, where ε = max wᵢ·(width of cell i)/4, and w_N/(2eβ) in the unbounded last cell: ε falls as N⁻².
class StopElements {
 public:
  StopElements(const friction::FrictionParameters& friction, std::size_t elements);

  /// Stretches the spring to the elongation x (rad), monotonically from its present elongation.
  void move_to(double x);

  double torque() const;  ///< torque σ of the spring at its present elongation, N m
  double energy() const;  ///< stored energy: ½k1·x² + Σ ½wᵢ·eᵢ², J

  /// Bound on the error of the torque (N m) after a history that leaves `depth` reversal points: ε on
  /// the virgin curve, and 2ε for every branch f(u) = 2·½f(2·u/2) since.
  double error_bound(std::size_t depth) const {
    return (1.0 + 2.0 * static_cast<double>(depth)) * virgin_error_;
  }

 private:
  struct Element {
    double threshold;   ///< elongation r at which the element slips, rad
    double stiffness;   ///< stiffness w of the element, N m/rad
    double elongation;  ///< present elastic elongation e of the element, rad
  };
  double k1_;
  double x_{0.0};
  double virgin_error_{0.0};
  std::vector<Element> elements_;
};

}  // namespace zerocount::testing
