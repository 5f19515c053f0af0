#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/theory/frozen_loop.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::theory {

/// Value of an open loop L at one frequency, for a Bode plot.
struct BodePoint {
  double frequency{0.0};  ///< Frequency, Hz.
  double magnitude{0.0};  ///< Magnitude 20·lg|L|, dB.
  double phase{0.0};      ///< Phase arg L without jumps of 360°, degrees.
};

inline constexpr std::size_t max_bode_points = 200;

/// Bode curve of an open loop L from `lowest` (Hz) to half of the sample rate, at most max_bode_points points
/// of it: those between which straight lines over the logarithm of the frequency show the curve best, and
/// those at the frequencies `kept` (Hz). Empty if L is 0 everywhere.
///
/// The phase begins between −300° and 60°, which has room for an integrator and a rotor without a spring, and
/// continues by the smaller turn between points that lie close enough for it. An undamped resonance turns it
/// by −180°, an undamped antiresonance by 180°: the limits of small damping.
std::vector<BodePoint> bode_curve(const FrozenLoop& loop, double lowest,
                                  const std::vector<double>& kept = {});

/// An axis of a stability map: a parameter and its range.
struct PlaneAxis {
  std::string parameter;  ///< Dotted path of the parameter.
  double low{0.0}, high{1.0};
  bool by_ratio{false};  ///< True if the axis is logarithmic.

  /// The value at a fraction (0 to 1) of the axis from `low` to `high`.
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

/// Curve in the plane of two parameters on which the integral gain ki equals the bound of one of the paper's
/// criteria.
struct CriterionCurve {
  std::string criterion;  ///< "(6)" or "(7)"
  /// True for the trial with the lowest bound of the design point; false for the trial with the highest.
  bool first{true};
  std::vector<CurvePoint> points;  ///< Points in order along the curve.
};

/// Curves in the plane of two parameters on which controller.ki equals the bound of (6) and of (7), for the
/// trials of the point with the lowest and the highest bound. Empty if the criteria do not apply or the
/// plane's axes are not parameters. Curves outside the plane are omitted. Below the first curve of (6) every
/// trial is stable by the paper; above the last curve of (7) every trial is unstable. At most 200 evenly
/// spaced trials are examined.
std::vector<CriterionCurve> criterion_curves(const study::Study& study, std::int64_t point,
                                             const CriterionPlane& plane);

}  // namespace zerocount::theory
