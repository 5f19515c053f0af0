#pragma once

#include <string>
#include <vector>

#include "core/theory/frozen_loop.hpp"
#include "core/trial/parameters.hpp"

// Beside theory_prediction.hpp, which many include: the loop brings Eigen's matrices.
namespace zerocount::theory {

/// A loop of a trial with its friction frozen.
struct TrialLoop {
  std::string name;       ///< "at k1", "at k1 + k2", "while sliding", "while sliding, the fine phase", …
  bool slides{false};     ///< there is no spring
  double stiffness{0.0};  ///< of the spring, N m/rad
  FrozenLoop loop;
};

/// The loop in the fine phase about each stiffness of the contact at the start, then each phase of the
/// control while the rotor slides. Empty if has_no_linear_loop().
std::vector<TrialLoop> trial_loops(const trial::TrialParameters& parameters);

}  // namespace zerocount::theory
