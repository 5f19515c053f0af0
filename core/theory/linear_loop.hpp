#pragma once

#include <complex>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/loop/controller/transfer_function.hpp"
#include "core/theory/held_plant.hpp"

/// The sampled loop made linear, assembled from the transfer functions of the controller's blocks: target 0,
/// the count a continuous quantity, the decided torques applied after the plant's delay.
namespace zerocount::theory {

/// The one-sample map x ← M·x of the loop. Its states are those of the driven rotor, of the blocks' transfer
/// functions (direct form II transposed; paths of a stage with the same poles share them), and the torques
/// decided and not yet applied.
Eigen::MatrixXd loop_map(const HeldPlant& plant, const loop::LinearChain& controller);

/// max |eigenvalue| of the loop's map; below 1 the loop is stable.
double spectral_radius(const HeldPlant& plant, const loop::LinearChain& controller);

/// Paths of a stage with equal poles, which share their states: Σ B(z)·input/A(z).
struct PathGroup {
  std::vector<double> a;  ///< 1, a₁, …
  std::vector<std::pair<loop::LoopSignal, std::vector<double>>> numerators;

  Eigen::Index order() const;
};

/// C(z): the torque decided per count of error, N m/count, the torque in force that blocks use being that of
/// the controller itself.
class ControllerResponse {
 public:
  explicit ControllerResponse(const loop::LinearChain& controller);

  /// @param error_gain of the error before the chain, such as the describing function of its dead zone.
  /// @param velocity_per_count of the count of the velocity loop's encoder per count of the position loop's.
  std::complex<double> at(std::complex<double> z, double error_gain = 1.0,
                          std::complex<double> velocity_per_count = 1.0) const;

 private:
  std::vector<std::vector<PathGroup>> blocks_;
  bool knows_torque_in_force_;
};

/// L(z) = C(z)·G(z), G with the plant's delay: the open loop from error to count.
class OpenLoop {
 public:
  OpenLoop(const HeldPlant& plant, const loop::LinearChain& controller);

  std::complex<double> at(std::complex<double> z) const;
  /// L at z = exp(i·angle), angle = ωT.
  std::complex<double> at_angle(double angle) const { return at(std::polar(1.0, angle)); }

 private:
  std::pair<std::complex<double>, std::complex<double>> plant_at(std::complex<double> z,
                                                                 std::complex<double> inverse) const;

  HeldPlant plant_;
  ControllerResponse controller_;
};

}  // namespace zerocount::theory
