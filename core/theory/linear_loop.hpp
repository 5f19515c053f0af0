#pragma once

#include <complex>

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

/// C(z): the torque decided per count of error, N m/count, the torque in force that blocks use being that of
/// the controller itself.
/// @param error_gain of the error before the chain, such as the describing function of its dead zone.
std::complex<double> controller_response(std::complex<double> z, const loop::LinearChain& controller,
                                         double error_gain = 1.0);

/// L(z) = C(z)·G(z), G with the plant's delay: the open loop from error to count.
std::complex<double> open_loop(std::complex<double> z, const HeldPlant& plant,
                               const loop::LinearChain& controller);

}  // namespace zerocount::theory
