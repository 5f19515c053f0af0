#pragma once

#include <functional>
#include <string>

#include "experiments/study/point_edit.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// An effect of a real axis, and a study without it, or with it added.
struct Effect {
  std::string name;
  std::string note{};     ///< what is assumed, or what the rate does not show
  std::string refusal{};  ///< why it cannot be simulated; empty if it can
  /// The values to change, those that belong to them included; empty: none.
  std::function<void(study::PointEdit&)> edit{};
  Change change{};  ///< of what a trial has drawn; empty: none
};

}  // namespace zerocount::tuning
