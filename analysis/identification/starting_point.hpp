#pragma once

#include <span>
#include <vector>

#include "analysis/identification/contact_coordinates.hpp"
#include "analysis/identification/record_parts.hpp"
#include "analysis/identification/test_record.hpp"

namespace zerocount {

/// The measured angle at every sample, rad: the middles of the counts, where the readings are counts.
Eigen::VectorXd measured_angle(const TestRecord& record);

/// Creep as it is seen in the holds.
struct CreepEstimate {
  double alpha{0.5};     ///< 1/s
  double exponent{2.0};  ///< n
  double limit{0.0};     ///< σ0ⁿ/λ, rad; 0 where no creep is seen
};

/// The creep law that explains the holds best, by least squares over a grid of α and n: where the torque is
/// held, only creep moves the rotor, and the law is linear in its limit.
CreepEstimate estimate_creep(std::span<const TestRecord> records, std::span<const RecordParts> parts,
                             double creep_torque);

/// Extension xp (rad) at every sample by the creep law, if the spring always carried the torque applied.
Eigen::VectorXd creep_extension(const TestRecord& record, const CreepEstimate& creep, double creep_torque);

/// The spring as the slow branches show it.
struct SpringEstimate {
  double k1{110.0};       ///< N m/rad
  double offset{7.5e-3};  ///< k2/β, N m
  double beta{1.0e5};     ///< 1/rad
};

/// The branch law by its chord, median over the branches: k1 is the slope of the last 40 % of the travel,
/// k2/β what the line through it leaves at the reversal, and 1/β the travel over which 63 % of that are
/// gained.
SpringEstimate estimate_spring(std::span<const TestRecord> records, std::span<const RecordParts> parts,
                               const CreepEstimate& creep, double creep_torque);

/// The first swing after a step of the torque.
struct FirstSwing {
  std::size_t peak{0};    ///< samples from the step to the first peak
  double travel{0.0};     ///< to where the rotor settles, in the direction of the step, rad
  double overshoot{0.0};  ///< beyond that, as a proportion of the travel
};

FirstSwing first_swing(const TestRecord& record, const TorqueHold& ring_down);

/// J and c from the first swing after the largest step, as if the spring had the stiffness k1.
PlantParameters estimate_ring_down(std::span<const TestRecord> records, std::span<const RecordParts> parts,
                                   double k1);

/// Where the joint fit starts: the estimates above, with β, J and c the best of a coarse grid around them by
/// the sum of squares over all readings.
ContactPoint starting_point(std::span<const TestRecord> records, std::span<const RecordParts> parts,
                            double creep_torque);

/// Where else to start if that leads nowhere: springs that soften far sooner or later, and yield more or less
/// as they do, each with the J and c of the grid that suit it best.
std::vector<ContactPoint> other_starting_points(std::span<const TestRecord> records,
                                                std::span<const RecordParts> parts, const ContactPoint& start,
                                                double creep_torque);

}  // namespace zerocount
