#include "core/theory/linear_loop.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace zerocount::theory {

namespace {

using Complex = std::complex<double>;
using Row = Eigen::RowVectorXd;  ///< Row vector that gives a signal as a linear combination of the loop's
                                 /// < states

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

using Blocks = std::vector<std::vector<PathGroup>>;

Blocks blocks_of(const loop::LinearChain& controller) {
  Blocks blocks;
  blocks.reserve(controller.size());
  for (const loop::LinearBlock& block : controller) blocks.push_back(groups_of(block));
  return blocks;
}

bool knows_torque_in_force(const Blocks& blocks) {
  for (const std::vector<PathGroup>& groups : blocks) {
    for (const PathGroup& group : groups) {
      for (const auto& [from, b] : group.numerators) {
        if (from == loop::LoopSignal::torque_in_force) return true;
      }
    }
  }
  return false;
}

/// The torque that the controller wants for the signals `count`, `velocity_count` and `in_force`, the torque
/// in force. The target is 0.
/// @param pass returns the output of a group of paths for its input signals.
template <class Signal, class Pass>
Signal wanted_torque(const Blocks& blocks, const Signal& count, const Signal& velocity_count,
                     const Signal& in_force, Pass pass) {
  Signal torque = 0.0 * count;
  const auto input = [&](loop::LoopSignal from) -> Signal {
    switch (from) {
      case loop::LoopSignal::torque:
        return torque;
      case loop::LoopSignal::error:
        return -count;
      case loop::LoopSignal::count:
        return count;
      case loop::LoopSignal::velocity_count:
        return velocity_count;
      case loop::LoopSignal::torque_in_force:
        break;
    }
    return in_force;
  };
  for (const std::vector<PathGroup>& groups : blocks) {
    Signal sum = 0.0 * count;
    for (const PathGroup& group : groups) sum += pass(group, input);
    torque = sum;
  }
  return torque;
}

double coefficient(const std::vector<double>& of, Eigen::Index k) {
  return k < static_cast<Eigen::Index>(of.size()) ? of[static_cast<std::size_t>(k)] : 0.0;
}

/// Enters the states of a path group into the map of the loop. They begin at index `state` of the map: y = Σ
/// b₀·x + s₁, sᵢ ← Σ bᵢ·x − aᵢ·y + sᵢ₊₁, the sums over the inputs.
/// @returns the output y of the group as a linear combination of the loop's states.
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

/// Quotient a/b of two complex numbers, without the protection against overflow that the language requires.
Complex quotient(Complex a, Complex b) {
  return a * std::conj(b) * (1.0 / std::norm(b));
}

/// Value of the polynomial Σ c[k]·w^k at the complex number w.
Complex value_at(const std::vector<double>& c, Complex w) {
  Complex value = 0.0;
  for (auto k = c.rbegin(); k != c.rend(); ++k) value = value * w + *k;
  return value;
}

/// A small system of linear equations, with as many unknowns as a plant has states at most: two masses and
/// the amplifier.
struct Equations {
  static constexpr int max_size = 5;
  Eigen::Index size;
  Complex left[max_size][max_size];
  Complex right[max_size];
};

/// Brings the linear equations to triangular form, in which equation k contains the unknowns up to k. The
/// unknowns above the first are eliminated from the equations before theirs, the last one first, by the pivot
/// of largest magnitude.
void eliminate(Equations& equations) {
  auto& [size, left, right] = equations;
  for (Eigen::Index k = size - 1; k > 0; --k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = 0; i < k; ++i) {
      if (std::norm(left[i][k]) > std::norm(left[pivot][k])) pivot = i;
    }
    std::swap(left[pivot], left[k]);
    std::swap(right[pivot], right[k]);
    const Complex inverse = quotient(1.0, left[k][k]);
    for (Eigen::Index i = 0; i < k; ++i) {
      const Complex factor = left[i][k] * inverse;
      for (Eigen::Index j = 0; j < k; ++j) left[i][j] -= factor * left[k][j];
      right[i] -= factor * right[k];
    }
  }
}

/// Value of unknown k of the linear equations, after eliminate().
Complex unknown(const Equations& equations, Eigen::Index k) {
  const auto& [size, left, right] = equations;
  Complex rest = right[k];
  for (Eigen::Index j = 0; j < k; ++j) rest -= left[k][j] * unknown(equations, j);
  return quotient(rest, left[k][k]);
}

Complex power(Complex base, int exponent) {
  Complex result = 1.0;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result *= base;
    base *= base;
  }
  return result;
}

}  // namespace

Eigen::Index PathGroup::order() const {
  std::size_t coefficients = a.size();
  for (const auto& [from, b] : numerators) coefficients = std::max(coefficients, b.size());
  return static_cast<Eigen::Index>(coefficients) - 1;
}

Eigen::MatrixXd loop_map(const HeldPlant& plant, const loop::LinearChain& controller) {
  const Eigen::Index driven = plant.A.rows();
  const Blocks blocks = blocks_of(controller);
  Eigen::Index of_blocks = 0;
  for (const std::vector<PathGroup>& groups : blocks) {
    for (const PathGroup& group : groups) of_blocks += group.order();
  }
  // The torques decided at the last samples, newest first.
  const Eigen::Index pending = driven + of_blocks;
  const bool changes_within = !plant.b_before.isZero(0.0);
  const Eigen::Index states =
      pending + std::max(plant.delay + (changes_within ? 1 : 0), knows_torque_in_force(blocks) ? 1 : 0);
  const auto state = [&](Eigen::Index i) -> Row { return Row::Unit(states, i); };

  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(states, states);
  Eigen::Index next = driven;
  const Row in_force = pending < states ? state(pending) : Row::Zero(states);
  const Row count = state(0);
  const double other_per_count = plant.other_per_count;
  const Row velocity_count = other_per_count > 0.0 ? other_per_count * (count + state(2)) : count;
  const Row decided = wanted_torque<Row>(blocks, count, velocity_count, in_force,
                                         [&](const PathGroup& group, const auto& input) {
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

ControllerResponse::ControllerResponse(const loop::LinearChain& controller)
    : blocks_(blocks_of(controller)), knows_torque_in_force_(knows_torque_in_force(blocks_)) {}

Complex ControllerResponse::at(Complex z, double error_gain, Complex velocity_per_count) const {
  const Complex w = quotient(1.0, z);
  const auto pass = [w, error_gain](const PathGroup& group, const auto& input) {
    Complex sum = 0.0;
    for (const auto& [from, b] : group.numerators) {
      const double gain = from == loop::LoopSignal::error ? error_gain : 1.0;
      sum += gain * value_at(b, w) * input(from);
    }
    return group.a.size() == 1 ? sum / group.a[0] : quotient(sum, value_at(group.a, w));
  };
  const Complex from_count = wanted_torque<Complex>(blocks_, 1.0, velocity_per_count, 0.0, pass);
  if (!knows_torque_in_force_) return -from_count;
  // The torque in force is z⁻¹·U, so U = from_count·count + from_itself·z⁻¹·U.
  const Complex from_itself = wanted_torque<Complex>(blocks_, 0.0, 0.0, 1.0, pass);
  return -quotient(from_count, 1.0 - from_itself * w);
}

OpenLoop::OpenLoop(const HeldPlant& plant, const loop::LinearChain& controller)
    : plant_(plant), controller_(controller) {}

Complex OpenLoop::at(Complex z) const {
  const Complex inverse = quotient(1.0, z);
  const auto [count, velocity_per_count] = plant_at(z, inverse);
  return controller_.at(z, 1.0, velocity_per_count) * power(inverse, plant_.delay) * count;
}

/// Two responses of the plant at the point z. First: count per torque decided, without the delay of whole
/// samples, the first element of (z·I − A)⁻¹·(b + b_before/z). Second: count that the velocity loop reads,
/// per count of the position loop.
/// @param inverse 1/z.
std::pair<Complex, Complex> OpenLoop::plant_at(Complex z, Complex inverse) const {
  const Eigen::Index states = plant_.A.rows();
  const auto m = [&](Eigen::Index i, Eigen::Index j) { return (i == j ? z : 0.0) - plant_.A(i, j); };
  const auto drive = [&](Eigen::Index i) { return plant_.b(i) + plant_.b_before(i) * inverse; };
  // Of two or three states, as most plants have, Cramer's rule: c are the cofactors of the first column of m.
  if (states == 2) {
    const Complex c[] = {m(1, 1), -m(0, 1)};
    return {quotient(c[0] * drive(0) + c[1] * drive(1), c[0] * m(0, 0) + c[1] * m(1, 0)), 1.0};
  }
  if (states == 3) {
    const Complex c[] = {m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1), m(0, 2) * m(2, 1) - m(0, 1) * m(2, 2),
                         m(0, 1) * m(1, 2) - m(0, 2) * m(1, 1)};
    return {quotient(c[0] * drive(0) + c[1] * drive(1) + c[2] * drive(2),
                     c[0] * m(0, 0) + c[1] * m(1, 0) + c[2] * m(2, 0)),
            1.0};
  }
  Equations equations;
  equations.size = states;
  for (Eigen::Index i = 0; i < states; ++i) {
    for (Eigen::Index j = 0; j < states; ++j) equations.left[i][j] = m(i, j);
    equations.right[i] = drive(i);
  }
  eliminate(equations);
  const Complex count = unknown(equations, 0);
  if (plant_.other_per_count == 0.0) return {count, 1.0};
  return {count, plant_.other_per_count * (1.0 + quotient(unknown(equations, 2), count))};
}

}  // namespace zerocount::theory
