#pragma once

#include <optional>

#include "core/friction/presliding/spring.hpp"

namespace zerocount::testing {

/// Moves a hysteretic spring to the elongation x (rad), through all branches on the way.
inline void move_to(friction::HystereticSpring& spring, double x) {
  if (x == spring.elongation()) return;
  spring.set_direction(x > spring.elongation() ? 1 : -1);
  for (std::optional<double> end = spring.branch_end(); end && spring.direction() * (x - *end) >= 0.0;
       end = spring.branch_end()) {
    spring.move_on_branch(*end);
  }
  spring.move_on_branch(x);
}

}  // namespace zerocount::testing
