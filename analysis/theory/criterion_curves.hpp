#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"

namespace zerocount::theory {

/// An axis of a stability map.
struct PlaneAxis {
  std::string parameter;  ///< dotted path
  double low{0.0}, high{1.0};
  bool by_ratio{false};  ///< logarithmic axis

  /// The value at a fraction of the axis from `low` to `high`.
  double at(double fraction) const {
    return by_ratio ? low * std::pow(high / low, fraction) : low + fraction * (high - low);
  }
};

struct CriterionPlane {
  PlaneAxis x, y;
};

struct CurvePoint {
  double x{0.0}, y{0.0};
};

/// Curve on which ki equals the bound of one of the paper's criteria.
struct CriterionCurve {
  std::string criterion;  ///< "(6)" or "(7)"
  bool first{true};       ///< for the trial with the lowest bound; otherwise for the trial with the highest
  std::vector<CurvePoint> points;  ///< along the curve
};

/// The curves on which controller.ki equals the bound of (6) and of (7), for the trials of the point with the
/// lowest and the highest bound. Empty if the criteria do not apply or the plane's axes are not parameters.
/// Curves outside the plane are omitted. Below the first curve of (6) every trial is stable by the paper;
/// above the last curve of (7) every trial is unstable. At most 200 evenly spaced trials are examined.
std::vector<CriterionCurve> criterion_curves(const study::Study& study, std::int64_t point,
                                             const CriterionPlane& plane);

}  // namespace zerocount::theory
