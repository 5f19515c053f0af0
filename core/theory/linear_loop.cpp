#include "core/theory/linear_loop.hpp"

#include <algorithm>

#include <Eigen/Dense>

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;
using Row = Eigen::RowVectorXd;  ///< a signal as a linear form of the loop's states

/// The wanted torque where the signals are `count` and `in_force`, the torque in force.
/// @param pass gives what comes of a signal through a transfer function.
template <class Signal, class Pass>
Signal wanted_torque(const loop::LinearChain& controller, const Signal& count, const Signal& in_force,
                     Pass pass) {
  Signal torque = 0.0 * count;
  const auto input = [&](loop::LoopSignal from) -> Signal {
    switch (from) {
      case loop::LoopSignal::torque:
        return torque;
      case loop::LoopSignal::error:
        return -count;
      case loop::LoopSignal::count:
        return count;
      case loop::LoopSignal::torque_in_force:
        break;
    }
    return in_force;
  };
  for (const loop::LinearBlock& block : controller) {
    Signal sum = 0.0 * count;
    for (const loop::SignalPath& path : block) sum += pass(path.transfer, input(path.from));
    torque = sum;
  }
  return torque;
}

Eigen::Index order_of(const loop::TransferFunction& transfer) {
  return static_cast<Eigen::Index>(std::max(transfer.a.size(), transfer.b.size())) - 1;
}

double coefficient(const std::vector<double>& of, Eigen::Index k) {
  return k < static_cast<Eigen::Index>(of.size()) ? of[static_cast<std::size_t>(k)] : 0.0;
}

/// The output of H for the signal `input`; the states of H begin at index `state` of the map:
/// y = b₀·x + s₁, sᵢ ← bᵢ·x − aᵢ·y + sᵢ₊₁.
Row realise(const loop::TransferFunction& transfer, const Row& input, Eigen::Index state,
            Eigen::MatrixXd& map) {
  const Eigen::Index order = order_of(transfer);
  Row output = coefficient(transfer.b, 0) * input;
  if (order > 0) output(state) += 1.0;
  for (Eigen::Index i = 1; i <= order; ++i) {
    map.row(state + i - 1) = coefficient(transfer.b, i) * input - coefficient(transfer.a, i) * output;
    if (i < order) map(state + i - 1, state + i) += 1.0;
  }
  return output;
}

/// Σ c[k]·z⁻ᵏ.
Complex value_at(const std::vector<double>& c, Complex z) {
  Complex value = 0.0;
  for (auto k = c.rbegin(); k != c.rend(); ++k) value = value / z + *k;
  return value;
}

}  // namespace

Eigen::MatrixXd loop_map(const HeldPlant& plant, const loop::LinearChain& controller, int delay) {
  const Eigen::Index driven = plant.A.rows();
  Eigen::Index of_blocks = 0;
  bool knows_torque_in_force = false;
  for (const loop::LinearBlock& block : controller) {
    for (const loop::SignalPath& path : block) {
      of_blocks += order_of(path.transfer);
      knows_torque_in_force = knows_torque_in_force || path.from == loop::LoopSignal::torque_in_force;
    }
  }
  // The torques decided at the last samples, newest first.
  const Eigen::Index pending = driven + of_blocks;
  const Eigen::Index states = pending + std::max(delay, knows_torque_in_force ? 1 : 0);
  const auto state = [&](Eigen::Index i) -> Row { return Row::Unit(states, i); };

  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(states, states);
  Eigen::Index next = driven;
  const Row in_force = pending < states ? state(pending) : Row::Zero(states);
  const Row decided = wanted_torque<Row>(controller, state(0), in_force,
                                         [&](const loop::TransferFunction& transfer, const Row& x) {
                                           Row output = realise(transfer, x, next, map);
                                           next += order_of(transfer);
                                           return output;
                                         });
  map.topLeftCorner(driven, driven) = plant.A;
  map.topRows(driven) += plant.b * (delay == 0 ? decided : state(pending + delay - 1));
  if (pending < states) map.row(pending) = decided;
  for (Eigen::Index i = pending + 1; i < states; ++i) map(i, i - 1) = 1.0;
  return map;
}

double spectral_radius(const HeldPlant& plant, const loop::LinearChain& controller, int delay) {
  return loop_map(plant, controller, delay).eigenvalues().cwiseAbs().maxCoeff();
}

Complex open_loop(Complex z, const HeldPlant& plant, const loop::LinearChain& controller, int delay) {
  const Eigen::Index states = plant.A.rows();
  const Eigen::MatrixXcd resolvent = z * Eigen::MatrixXcd::Identity(states, states) - plant.A;
  const Eigen::VectorXcd response = resolvent.fullPivLu().solve(plant.b.cast<Complex>());
  const auto pass = [z](const loop::TransferFunction& transfer, Complex x) {
    return x * value_at(transfer.b, z) / value_at(transfer.a, z);
  };
  // The torque in force is z⁻¹·U, so U = from_count·count + from_itself·z⁻¹·U.
  const Complex from_count = wanted_torque<Complex>(controller, 1.0, 0.0, pass);
  const Complex from_itself = wanted_torque<Complex>(controller, 0.0, 1.0, pass);
  return -from_count / (1.0 - from_itself / z) * std::pow(z, -delay) * response(0);
}

}  // namespace zerocount::theory
