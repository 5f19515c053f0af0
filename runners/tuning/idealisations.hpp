#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/study/point_edit.hpp"
#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// A cause of failures, and the study without it.
struct Idealisation {
  std::string cause;
  std::string note{};     ///< what the rate without it does not show
  std::string refusal{};  ///< why it cannot be simulated; empty if it can
  /// The values to change, those that belong to them included.
  std::function<void(study::PointEdit&)> edit{};
  Change change{};  ///< of what a trial has drawn; empty: none
};

/// The causes that a trial of the point can have.
std::vector<Idealisation> idealisations_of(const study::Study& study, std::int64_t point);

}  // namespace zerocount::tuning
