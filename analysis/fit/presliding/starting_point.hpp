#pragma once

#include <limits>
#include <span>
#include <vector>

#include "analysis/fit/presliding/contact.hpp"
#include "analysis/fit/record.hpp"

namespace zerocount::fit {

/// The measured angle at every sample, rad; for counts the middle of the count.
Eigen::VectorXd measured_angle(const TestRecord& record);

/// Creep law estimated from the holds.
struct CreepEstimate {
  double alpha{0.0};     ///< Creep rate α, 1/s.
  double exponent{2.0};  ///< n
  double limit{0.0};     ///< Creep limit σ0ⁿ/λ, rad; 0 if there is no visible creep.
};

/// Fits the creep law to the holds by least squares, over a grid of α and n; without visible creep α is three
/// over the duration of the longest record. At constant torque only creep moves the rotor, and the law is
/// linear in its limit.
CreepEstimate estimate_creep(Records records, double creep_torque);

/// Creep extension xp (rad) at every sample, if the spring torque always equals the applied torque.
Eigen::VectorXd creep_extension(const TestRecord& record, const CreepEstimate& creep, double creep_torque);

/// Spring parameters estimated from the slow branches.
struct SpringEstimate {
  double k1{0.0};      ///< Stiffness k1, N m/rad.
  double offset{0.0};  ///< Offset k2/β, N m.
  double beta{0.0};    ///< Softening rate β, 1/rad.
};

/// Median over the branches. k1 is the slope of the last 40 % of the travel, k2/β the intercept of that line
/// at the reversal, and 1/β the travel after which 63 % of the intercept are reached.
SpringEstimate estimate_spring(Records records, const CreepEstimate& creep, double creep_torque);

/// The first oscillation after a step of the torque.
struct FirstOvershoot {
  /// Samples from the step to the first peak. If the rotor creeps without a peak: to the end.
  std::size_t peak{0};
  std::size_t rise{0};  ///< samples from the step to 63 % of the travel
  /// Travel from the start to the settled position in the direction of the step, rad.
  double travel{0.0};
  double overshoot{0.0};  ///< Overshoot as a fraction of the travel.
};

FirstOvershoot first_overshoot(const TestRecord& record, const TorqueHold& ring_down);

/// J and c from the first oscillation after the largest step, for a linear spring of the stiffness that the
/// step shows, at least k1.
motion::PlantParameters estimate_ring_down(Records records, double k1);

/// Starting points of the joint fit, the best one first. The creep and the spring come from estimate_creep()
/// and estimate_spring(); β, J and c from a coarse grid search around the estimates (sum of squares over all
/// readings). If there are slow parts, the spring and its creep come from the law without inertia and damping
/// (see fit_slow_parts()). With visible creep both results are returned.
/// @param known values of the coordinates that are not `free`
std::vector<Point> starting_points(Records records, double creep_torque, const Point& known,
                                   const FreeCoordinates& free);

/// Other starting points: springs with much larger or smaller β and with other values of k2/β, each with its
/// best J and c of the grid.
std::vector<Point> starts_with_other_softening(Records records, const Point& start, double creep_torque);

/// Other starting points: springs estimated for little, some and much creep instead of the creep of the
/// holds, each with other softening. The holds of a closed loop are short and show the motion of the loop
/// rather than creep.
std::vector<Point> starts_with_other_creep(Records records, const Point& start, double creep_torque);

/// A change of a point: each pair gives a coordinate and the amount added to it.
Point change_of(std::initializer_list<std::pair<Coordinate, double>> changes);

/// Changes of J and c by each pair of factors.
std::vector<Point> inertia_changes(std::initializer_list<double> inertias,
                                   std::initializer_list<double> dampings);

/// A point fitted to slow parts.
struct SlowFit {
  Point point;
  double squares{std::numeric_limits<double>::infinity()};  ///< sum of squares, in units of the readings
};

/// Whether the fit of the slow parts also fits the creep law, or keeps the creep law of the start.
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
