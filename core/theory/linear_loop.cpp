#include "core/theory/linear_loop.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/numerics/dense.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;
using Row = Eigen::RowVectorXd;  ///< a signal as a linear form of the loop's states

/// Paths of a stage with equal poles, which share their states.
struct PathGroup {
  std::vector<double> a;
  std::vector<std::pair<loop::LoopSignal, std::vector<double>>> numerators;

  Eigen::Index order() const {
    std::size_t coefficients = a.size();
    for (const auto& [from, b] : numerators) coefficients = std::max(coefficients, b.size());
    return static_cast<Eigen::Index>(coefficients) - 1;
  }
};

std::vector<PathGroup> groups_of(const loop::LinearBlock& stage) {
  std::vector<PathGroup> groups;
  for (const loop::SignalPath& path : stage) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const PathGroup& g) { return g.a == path.transfer.a; });
    if (group == groups.end()) group = groups.insert(group, {path.transfer.a, {}});
    group->numerators.emplace_back(path.from, path.transfer.b);
  }
  return groups;
}

/// The wanted torque where the signals are `count` and `in_force`, the torque in force.
/// @param pass returns the output of a group of paths for its input signals.
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
    for (const PathGroup& group : groups_of(block)) sum += pass(group, input);
    torque = sum;
  }
  return torque;
}

double coefficient(const std::vector<double>& of, Eigen::Index k) {
  return k < static_cast<Eigen::Index>(of.size()) ? of[static_cast<std::size_t>(k)] : 0.0;
}

/// The output of a group for its signals; its states begin at index `state` of the map:
/// y = Σ b₀·x + s₁, sᵢ ← Σ bᵢ·x − aᵢ·y + sᵢ₊₁, the sums over the inputs.
template <class Input>
Row realise(const PathGroup& group, const Input& input, Eigen::Index state, Eigen::MatrixXd& map) {
  const Eigen::Index order = group.order();
  const auto inputs_by = [&](Eigen::Index i) {
    Row sum = Row::Zero(map.cols());
    for (const auto& [from, b] : group.numerators) sum += coefficient(b, i) * input(from);
    return sum;
  };
  Row output = inputs_by(0);
  if (order > 0) output(state) += 1.0;
  for (Eigen::Index i = 1; i <= order; ++i) {
    map.row(state + i - 1) = inputs_by(i) - coefficient(group.a, i) * output;
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

Eigen::MatrixXd loop_map(const HeldPlant& plant, const loop::LinearChain& controller) {
  const Eigen::Index driven = plant.A.rows();
  Eigen::Index of_blocks = 0;
  bool knows_torque_in_force = false;
  for (const loop::LinearBlock& block : controller) {
    for (const PathGroup& group : groups_of(block)) {
      of_blocks += group.order();
      for (const auto& [from, b] : group.numerators) {
        knows_torque_in_force = knows_torque_in_force || from == loop::LoopSignal::torque_in_force;
      }
    }
  }
  // The torques decided at the last samples, newest first.
  const Eigen::Index pending = driven + of_blocks;
  const bool changes_within = !plant.b_before.isZero(0.0);
  const Eigen::Index states =
      pending + std::max(plant.delay + (changes_within ? 1 : 0), knows_torque_in_force ? 1 : 0);
  const auto state = [&](Eigen::Index i) -> Row { return Row::Unit(states, i); };

  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(states, states);
  Eigen::Index next = driven;
  const Row in_force = pending < states ? state(pending) : Row::Zero(states);
  const Row decided =
      wanted_torque<Row>(controller, state(0), in_force, [&](const PathGroup& group, const auto& input) {
        Row output = realise(group, input, next, map);
        next += group.order();
        return output;
      });
  map.topLeftCorner(driven, driven) = plant.A;
  const auto decided_before = [&](int samples) -> Row {
    return samples == 0 ? decided : state(pending + samples - 1);
  };
  map.topRows(driven) += plant.b * decided_before(plant.delay);
  if (changes_within) map.topRows(driven) += plant.b_before * decided_before(plant.delay + 1);
  if (pending < states) map.row(pending) = decided;
  for (Eigen::Index i = pending + 1; i < states; ++i) map(i, i - 1) = 1.0;
  return map;
}

double spectral_radius(const HeldPlant& plant, const loop::LinearChain& controller) {
  return numerics::spectral_radius(loop_map(plant, controller));
}

namespace {

/// The first element of (z·I − A)⁻¹·(b + b_before/z): the count per torque decided, but for whole delays.
Complex plant_response(Complex z, const HeldPlant& plant) {
  const Eigen::Index states = plant.A.rows();
  const auto m = [&](Eigen::Index i, Eigen::Index j) { return (i == j ? z : 0.0) - plant.A(i, j); };
  const auto drive = [&](Eigen::Index i) { return plant.b(i) + plant.b_before(i) / z; };
  // Of two or three states, as most plants have, Cramer's rule: c are the cofactors of the first column of m.
  if (states == 2) {
    const Complex c[] = {m(1, 1), -m(0, 1)};
    return (c[0] * drive(0) + c[1] * drive(1)) / (c[0] * m(0, 0) + c[1] * m(1, 0));
  }
  if (states == 3) {
    const Complex c[] = {m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1), m(0, 2) * m(2, 1) - m(0, 1) * m(2, 2),
                         m(0, 1) * m(1, 2) - m(0, 2) * m(1, 1)};
    return (c[0] * drive(0) + c[1] * drive(1) + c[2] * drive(2)) /
           (c[0] * m(0, 0) + c[1] * m(1, 0) + c[2] * m(2, 0));
  }
  const Eigen::MatrixXcd resolvent = z * Eigen::MatrixXcd::Identity(states, states) - plant.A;
  return numerics::solve(resolvent, plant.b.cast<Complex>() + plant.b_before.cast<Complex>() / z)(0);
}

}  // namespace

Complex open_loop(Complex z, const HeldPlant& plant, const loop::LinearChain& controller) {
  return controller_response(z, controller) * std::pow(z, -plant.delay) * plant_response(z, plant);
}

Complex controller_response(Complex z, const loop::LinearChain& controller, double error_gain) {
  const auto pass = [z, error_gain](const PathGroup& group, const auto& input) {
    Complex sum = 0.0;
    for (const auto& [from, b] : group.numerators) {
      const double gain = from == loop::LoopSignal::error ? error_gain : 1.0;
      sum += gain * value_at(b, z) * input(from);
    }
    return sum / value_at(group.a, z);
  };
  // The torque in force is z⁻¹·U, so U = from_count·count + from_itself·z⁻¹·U.
  const Complex from_count = wanted_torque<Complex>(controller, 1.0, 0.0, pass);
  const Complex from_itself = wanted_torque<Complex>(controller, 0.0, 1.0, pass);
  return -from_count / (1.0 - from_itself / z);
}

}  // namespace zerocount::theory
