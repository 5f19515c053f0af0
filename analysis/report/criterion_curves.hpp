#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"

namespace zerocount {

/// Two axes of the plane in which the criteria are drawn.
struct CriterionPlane {
  std::string x, y;  ///< dotted paths of parameters
  double x_low{0.0}, x_high{1.0};
  double y_low{0.0}, y_high{1.0};
  bool x_by_ratio{false}, y_by_ratio{false};  ///< spaced evenly in the logarithm
};

struct CurvePoint {
  double x{0.0}, y{0.0};
};

/// Where one of the paper's criteria is just met.
struct CriterionCurve {
  std::string criterion;  ///< "(6)" or "(7)"
  bool first{true};       ///< of the trial that meets it first; otherwise of the one that meets it last
  std::vector<CurvePoint> points;  ///< along the curve
};

/// The curves on which controller.ki is at the bound of (6) and of (7), for the trial of the point that meets
/// it first and for the one that meets it last. Empty where the criteria do not apply or the plane's axes are
/// not parameters; a curve that does not pass through the plane is left out.
///
/// Below the first curve of (6) every trial is stable by the paper, above the last one of (7) none is. At
/// most 200 trials are looked at, an even spread.
std::vector<CriterionCurve> criterion_curves(const Study& study, std::int64_t point,
                                             const CriterionPlane& plane);

}  // namespace zerocount
