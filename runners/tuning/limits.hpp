#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "runners/tuning/unit_runner.hpp"

namespace zerocount::tuning {

/// Rate of the goal with a cause of failures switched off.
struct Limit {
  std::string cause;
  double rate{0.0};
};

/// Rate of the goal (Estimate::rate) on the first `count` units.
/// @param change null: none
double rate_of(const study::Study& study, const Units& units, std::int64_t count, const Change* change,
               const std::stop_token& stop);

/// Rates of the goal on all units, with each cause of failures switched off that the study has, and with the
/// best pair of them. The first entry is "none".
/// @throws trial::Interrupted
std::vector<Limit> limits_of(const study::Study& study, const Units& units, const std::stop_token& stop);

}  // namespace zerocount::tuning
