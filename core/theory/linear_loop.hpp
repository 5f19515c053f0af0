#pragma once

#include <complex>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/loop/controller/control_block.hpp"
#include "core/loop/parameters.hpp"
#include "core/motion/parameters.hpp"
#include "core/theory/stability.hpp"

/// The sampled loop made linear, assembled from the transfer functions of the controller's blocks: target 0,
/// the count a continuous quantity, the decided torques applied after the plant's delay.
namespace zerocount::theory {

/// The driven plant over sample k: x ← A·x + b·v[k − delay] + b_before·v[k − delay − 1] with x = (count,
/// change of the count per sample at the present velocity; with a load both of the mass that the encoder does
/// not read, its angle relative to the measured one; with an amplifier its torque), v the decided torques (N
/// m).
struct HeldPlant {
  Eigen::MatrixXd A;  ///< State matrix over one sample; states in units of counts and N m
  Eigen::VectorXd b;  ///< Input vector for the torque v[k − delay], counts/(N m); dimensionless in the row of
                      /// < the amplifier's torque
  Eigen::VectorXd b_before;  ///< Input vector for the torque v[k − delay − 1]; 0 for a delay of whole samples
  int delay{0};              ///< Number of whole samples between deciding a torque and applying it
  /// Counts of the encoder on the other mass per count of the fine one, if the velocity loop reads that
  /// encoder; otherwise 0.
  double other_per_count{0.0};
};

/// Springs and dampers between each mass and the frame that replace its friction in the linear model.
struct FrozenFriction {
  double stiffness{0.0};       ///< Stiffness of the spring between motor and frame, N m/rad
  double damping{0.0};         ///< Damping of the damper between motor and frame, N m s/rad
  double load_stiffness{0.0};  ///< Stiffness of the spring between load and frame, N m/rad
  /// Damping between load and frame, besides the load's damping to ground, N m s/rad
  double load_damping{0.0};
};

/// Exact discretisation of J·θ¨ + damping·θ˙ + stiffness·θ = u − Ts, with the load of `plant`, and the
/// drive's input held over each sample. The coupling is in contact and without an error.
/// @param plant inertia of the rotor, and its load.
/// @param count_angle Δx, rad.
/// @param sample_time T, s.
/// @param delay samples between deciding a torque and applying it, whole or not.
HeldPlant hold_plant(const FrozenFriction& friction, const motion::PlantParameters& plant, double count_angle,
                     double sample_time, const LinearDrive& drive, double delay = 0.0);

/// The one-sample map x ← M·x of the loop, which is stable if every |eigenvalue| is below 1. Its states are
/// the states of the driven rotor, the states of the blocks' transfer functions (direct form II transposed;
/// paths of a stage with the same poles share them), and the torques decided and not yet applied.
Eigen::MatrixXd loop_map(const HeldPlant& plant, const loop::LinearChain& controller);

/// Paths of one controller stage that have equal poles, and so share their states: Σ B(z)·input/A(z).
struct PathGroup {
  std::vector<double> a;  ///< Coefficients 1, a₁, … of the common denominator A(z)
  std::vector<std::pair<loop::LoopSignal, std::vector<double>>> numerators;

  Eigen::Index order() const;
};

/// Frequency response C(z) of the controller: torque decided per count of error, N m/count. Blocks that use
/// the torque in force get the controller's own output.
class ControllerResponse {
 public:
  explicit ControllerResponse(const loop::LinearChain& controller);

  /// The frequency response at a point z of the z plane.
  /// @param error_gain gain on the error before the chain, such as the describing function of a dead zone.
  /// @param velocity_per_count count that the velocity loop reads per count of the position loop.
  std::complex<double> at(std::complex<double> z, double error_gain = 1.0,
                          std::complex<double> velocity_per_count = 1.0) const;

 private:
  std::vector<std::vector<PathGroup>> blocks_;
  bool knows_torque_in_force_;
};

/// Frequency response of the open loop from error to count, L(z) = C(z)·G(z), with C the controller and G the
/// plant with its delay.
class OpenLoop {
 public:
  OpenLoop(const HeldPlant& plant, const loop::LinearChain& controller);

  std::complex<double> at(std::complex<double> z) const;
  /// Frequency response L at z = exp(i·angle), angle = ωT in rad.
  std::complex<double> at_angle(double angle) const { return at(std::polar(1.0, angle)); }

 private:
  std::pair<std::complex<double>, std::complex<double>> plant_at(std::complex<double> z,
                                                                 std::complex<double> inverse) const;

  HeldPlant plant_;
  ControllerResponse controller_;
};

}  // namespace zerocount::theory
