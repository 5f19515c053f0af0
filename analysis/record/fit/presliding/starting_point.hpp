#pragma once

#include <limits>
#include <span>
#include <vector>

#include "analysis/record/fit/presliding/contact.hpp"
#include "analysis/record/fit/record.hpp"

namespace zerocount::fit {

/// [sample] The measured angle, rad; if the readings are counts, the middle of the count.
Eigen::VectorXd measured_angle(const TestRecord& record);

/// Creep law estimated from the holds (parts of the records with constant torque).
struct CreepEstimate {
  double alpha{0.0};     ///< Creep rate α, 1/s.
  double exponent{2.0};  ///< Exponent n of the creep law.
  /// Creep limit σ0ⁿ/λ, rad: extension at which creep ends under the torque scale σ0; 0 if there is no
  /// visible creep.
  double limit{0.0};
};

/// Fits the creep law to the holds (constant torque) by least squares, over a grid of the rate α and the
/// exponent n. At constant torque only creep moves the rotor, and the law is linear in its limit. Without
/// visible creep α is three divided by the duration of the longest record.
/// @param creep_torque torque scale σ0, N m
CreepEstimate estimate_creep(Records records, double creep_torque);

/// [sample] Creep extension xp of the contact, rad, if the spring torque always equals the applied torque.
/// @param creep_torque torque scale σ0 of the creep limit, N m
Eigen::VectorXd creep_extension(const TestRecord& record, const CreepEstimate& creep, double creep_torque);

/// Spring parameters of the contact, estimated from the slow branches (parts of the records with slow
/// monotonic torque).
struct SpringEstimate {
  double k1{0.0};      ///< Tangent stiffness k1 long after a reversal, N m/rad.
  double offset{0.0};  ///< Torque offset k2/β of the curve after a reversal, N m.
  double beta{0.0};    ///< Rate β at which the stiffness falls from k1 + k2 to k1 after a reversal, 1/rad.
};

/// Estimates the spring as the median over the slow branches. k1 is the slope of the last 40 % of the travel,
/// k2/β the intercept of that line at the reversal, and 1/β the travel after which 63 % of the intercept are
/// reached.
/// @param creep creep that is subtracted from the travel first
/// @param creep_torque torque scale σ0 of the creep, N m
SpringEstimate estimate_spring(Records records, const CreepEstimate& creep, double creep_torque);

/// Shape of the first oscillation after a step of the torque.
struct FirstOvershoot {
  /// Number of samples from the step to the first peak. If the rotor creeps without a peak: to the end.
  std::size_t peak{0};
  std::size_t rise{0};  ///< Number of samples from the step to 63 % of the travel.
  /// Travel from the start to the settled position in the direction of the step, rad.
  double travel{0.0};
  double overshoot{0.0};  ///< Overshoot as a fraction of the travel.
};

FirstOvershoot first_overshoot(const TestRecord& record, const TorqueHold& ring_down);

/// Inertia J and damping c, estimated from the first oscillation after the largest step of the torque, for a
/// linear spring of the stiffness that the step shows, at least k1.
motion::PlantParameters estimate_ring_down(Records records, double k1);

/// Starting points of the joint fit, the best one first. The creep and the spring come from estimate_creep()
/// and estimate_spring(); β, J and c from a coarse grid search around the estimates (sum of squares over all
/// readings). If there are slow parts, the spring and its creep come from the law without inertia and damping
/// (see fit_slow_parts()). With visible creep both results are returned.
/// @param creep_torque torque scale σ0, N m
/// @param known values of the coordinates that are not `free`
std::vector<Point> starting_points(Records records, double creep_torque, const Point& known,
                                   const FreeCoordinates& free);

/// Other starting points for the fit: springs with much larger or smaller β and with other values of k2/β,
/// each with its best J and c of the grid.
/// @param start the starting point used so far
std::vector<Point> starts_with_other_softening(Records records, const Point& start, double creep_torque);

/// Other starting points for the fit: springs estimated for little, some and much creep instead of the creep
/// of the holds, each with other softening. Reason: the holds of a closed loop are short and show the motion
/// of the loop rather than creep.
/// @param start the starting point used so far
std::vector<Point> starts_with_other_creep(Records records, const Point& start, double creep_torque);

/// A change of a point, to be added to it.
/// @param changes pairs of a coordinate and the amount added to it; the other coordinates do not change
Point change_of(std::initializer_list<std::pair<Coordinate, double>> changes);

/// Changes of a point that multiply the inertia J and the damping c, for each pair of a factor in `inertias`
/// and a factor in `dampings`.
std::vector<Point> inertia_changes(std::initializer_list<double> inertias,
                                   std::initializer_list<double> dampings);

/// Result of a fit to the slow parts of records: the point, and its sum of squares.
struct SlowFit {
  Point point;
  /// Sum of squared residuals, in squared units of the readings; infinite without a fit.
  double squares{std::numeric_limits<double>::infinity()};
};

/// Whether the fit of the slow parts also fits the creep law, or keeps the creep law of the starting point.
enum class SlowCreep { kept, fitted };

/// Fits the law without inertia and damping to the slow branches and the later halves of holds by least
/// squares: the spring and its creep, for a spring that always carries the applied torque. The fit takes a
/// fraction of a second. Its minimum does not depend on inertia and damping, on which such parts have little
/// information. First the spring is fitted, from the nine best of `starts` with nine values of β each; then
/// all six coordinates, from the two best results. At most about a thousand samples of each record are used,
/// evenly chosen.
/// @param free coordinates that may change
/// @returns the first start with the fitted coordinates; it itself and infinity if there are no slow
/// branches.
SlowFit fit_slow_parts(Records records, std::span<const Point> starts, double creep_torque,
                       const FreeCoordinates& free, SlowCreep creep);

}  // namespace zerocount::fit
