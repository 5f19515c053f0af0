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
  double alpha{0.0};     ///< 1/s
  double exponent{2.0};  ///< n
  double limit{0.0};     ///< σ0ⁿ/λ, rad; 0 if there is no visible creep
};

/// Fits the creep law to the holds by least squares, over a grid of α and n; without visible creep α is three
/// over the duration of the longest record. At constant torque only creep moves the rotor, and the law is
/// linear in its limit.
CreepEstimate estimate_creep(Records records, double creep_torque);

/// Creep extension xp (rad) at every sample, if the spring torque always equals the applied torque.
Eigen::VectorXd creep_extension(const TestRecord& record, const CreepEstimate& creep, double creep_torque);

/// Spring parameters estimated from the slow branches.
struct SpringEstimate {
  double k1{0.0};      ///< N m/rad
  double offset{0.0};  ///< k2/β, N m
  double beta{0.0};    ///< 1/rad
};

/// Median over the branches. k1 is the slope of the last 40 % of the travel, k2/β the intercept of that line
/// at the reversal, and 1/β the travel after which 63 % of the intercept are reached.
SpringEstimate estimate_spring(Records records, const CreepEstimate& creep, double creep_torque);

/// The first oscillation after a step of the torque.
struct FirstOvershoot {
  std::size_t peak{0};    ///< samples from the step to the first peak; of a rotor that creeps, to the end
  std::size_t rise{0};    ///< samples from the step to 63 % of the travel
  double travel{0.0};     ///< from the start to the settled position, in the direction of the step, rad
  double overshoot{0.0};  ///< as a fraction of the travel
};

FirstOvershoot first_overshoot(const TestRecord& record, const TorqueHold& ring_down);

/// J and c from the first oscillation after the largest step, for a linear spring of the stiffness that the
/// step shows, at least k1.
motion::PlantParameters estimate_ring_down(Records records, double k1);

/// Starting points of the joint fit, the best one first: the estimates above, with β, J and c from a coarse
/// grid search around them (sum of squares over all readings). Where there are slow parts, the spring and its
/// creep are those of the law without inertia and damping (see fit_slow_parts()); with visible creep both are
/// returned.
/// @param known values of the coordinates that are not `free`
std::vector<Point> starting_points(Records records, double creep_torque, const Point& known,
                                   const FreeCoordinates& free);

/// Other starting points: springs with much larger or smaller β and with other values of k2/β, each with its
/// best J and c of the grid.
std::vector<Point> starts_with_other_softening(Records records, const Point& start, double creep_torque);

/// Other starting points: springs estimated for little, some and much creep instead of that of the holds,
/// each with other softening. The holds of a closed loop are short and show its motion rather than creep.
std::vector<Point> starts_with_other_creep(Records records, const Point& start, double creep_torque);

/// A change of a point: of these coordinates by so much.
Point change_of(std::initializer_list<std::pair<Coordinate, double>> changes);

/// Changes of J and c by each pair of factors.
std::vector<Point> inertia_changes(std::initializer_list<double> inertias,
                                   std::initializer_list<double> dampings);

/// A point fitted to slow parts.
struct SlowFit {
  Point point;
  double squares{std::numeric_limits<double>::infinity()};  ///< sum of squares, in units of the readings
};

/// Whether the slow parts show the creep law, or keep that of the start.
enum class SlowCreep { kept, fitted };

/// Least squares of the law without inertia and damping on the slow branches and the later halves of holds:
/// the spring and its creep, for a spring that always carries the applied torque. It takes a fraction of a
/// second, and its minimum does not depend on inertia and damping, which such parts show little of. The
/// spring is fitted first, from the nine best of `starts` with nine values of β each; from the two best of
/// these all six coordinates. At most some thousand samples of a record are used, evenly chosen.
/// @param free coordinates that may change
/// @returns the first start with the fitted coordinates; it itself and infinity if there are no slow
/// branches.
SlowFit fit_slow_parts(Records records, std::span<const Point> starts, double creep_torque,
                       const FreeCoordinates& free, SlowCreep creep);

}  // namespace zerocount::fit
