#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/presliding/starting_point.hpp"

namespace zerocount::fit {
namespace {

/// Torque against travel along one branch of a record (a part with monotonic torque), from its reversal
/// point.
struct Chord {
  std::vector<double> travel;  ///< [sample] Travel from the reversal point, rad.
  std::vector<double> torque;  ///< [sample] Torque from the reversal point, N m.
};

/// The torque–travel curve of a branch.
/// @param angle [sample] angle of the rotor without creep, rad
/// @param doubled whether the branch is the virgin curve sgn(x)·½·f(2|x|); doubling travel and torque then
/// gives the law f of other branches
Chord chord_of(const TestRecord& record, const LoadingBranch& branch, const Eigen::VectorXd& angle,
               bool doubled) {
  Chord chord;
  const double sign = branch.to > branch.from ? 1.0 : -1.0;
  const double factor = doubled ? 2.0 : 1.0;
  const double start = angle[static_cast<Eigen::Index>(branch.first)];
  for (std::size_t k = branch.first + 1; k <= branch.last; ++k) {
    // The angle at t_k is the response to the torque before t_k.
    chord.travel.push_back(factor * sign * (angle[static_cast<Eigen::Index>(k)] - start));
    chord.torque.push_back(factor * sign * (record.torque[k - 1].now - branch.from));
  }
  return chord;
}

struct Line {
  double slope{0.0};
  double intercept{0.0};
};

/// Least-squares line through those points of the chord whose travel is at least `from`.
Line line_through(const Chord& chord, double from) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < chord.travel.size(); ++i) {
    if (chord.travel[i] < from) continue;
    n += 1.0;
    x += chord.travel[i];
    y += chord.torque[i];
    xx += chord.travel[i] * chord.travel[i];
    xy += chord.travel[i] * chord.torque[i];
  }
  const double spread = n * xx - x * x;
  if (n < 3.0 || !(spread > 0.0)) return {};
  const double slope = (n * xy - x * y) / spread;
  return {slope, (y - slope * x) / n};
}

/// The travel at which the torque of the chord reaches the fraction `proportion` of the line's intercept,
/// rad; at least `least`.
double softening_travel(const Chord& chord, const Line& line, double proportion, double least) {
  for (std::size_t i = 0; i < chord.travel.size(); ++i) {
    if (chord.torque[i] - line.slope * chord.travel[i] >= proportion * line.intercept) {
      return std::max(chord.travel[i], least);
    }
  }
  return least;
}

/// Estimate of the spring if no record has a slow branch: from the softest step, or from the ratio of the
/// largest torque and angle, with assumed values of β and k2.
SpringEstimate secant_estimate(Records records) {
  constexpr double softened = 20.0;  // β times the travel
  constexpr double offset = 0.05;    // of the torque
  SpringEstimate estimate{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  const auto take = [&](double torque, double travel) {
    if (!(travel > 0.0) || torque / travel >= estimate.k1) return;
    estimate = {torque / travel, offset * torque, softened / travel};
  };
  for (std::size_t r = 0; r < records.size(); ++r) {
    for (const TorqueHold& hold : records[r].parts.holds) {
      if (hold.rings_down) take(std::abs(hold.torque - hold.from), first_overshoot(records[r], hold).travel);
    }
  }
  if (std::isfinite(estimate.k1)) return estimate;
  for (const TestRecord& record : records) {
    const Eigen::VectorXd angle = measured_angle(record);
    take(torque_range(record), angle.maxCoeff() - angle.minCoeff());
  }
  return estimate;
}

}  // namespace

SpringEstimate estimate_spring(Records records, const CreepEstimate& creep, double creep_torque) {
  std::vector<double> slopes, offsets, rates;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Eigen::VectorXd angle =
        measured_angle(records[r]) - creep_extension(records[r], creep, creep_torque);
    const bool virgin = records[r].start.preload == 0.0 && records[r].start.history.empty();
    for (std::size_t b = 0; b < records[r].parts.branches.size(); ++b) {
      const LoadingBranch& branch = records[r].parts.branches[b];
      if (!branch.slow) continue;
      const Chord chord = chord_of(records[r], branch, angle, virgin && b == 0);
      const double travel = chord.travel.back();
      const Line line = line_through(chord, 0.6 * travel);
      if (!(line.slope > 0.0) || !(travel > 0.0)) continue;
      slopes.push_back(line.slope);
      if (!(line.intercept > 0.0)) continue;
      offsets.push_back(line.intercept);
      constexpr double proportion = 0.632;  // 1 − 1/e
      rates.push_back(1.0 / softening_travel(chord, line, proportion, 0.5 * records[r].unit));
    }
  }
  if (slopes.empty()) return secant_estimate(records);
  SpringEstimate estimate;
  estimate.k1 = statistics::upper_median(slopes);
  estimate.offset =
      offsets.empty() ? 0.01 * estimate.k1 * records[0].unit : statistics::upper_median(offsets);
  estimate.beta = rates.empty() ? 1.0 / records[0].unit : statistics::upper_median(rates);
  return estimate;
}

}  // namespace zerocount::fit
