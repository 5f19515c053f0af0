#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "runners/tuning/tuner.hpp"

/// What stands beside the tuned values. All of it is by simulation of the units of the search, not proven.
namespace zerocount::tuning {

struct Details {
  const study::Study& study;
  std::span<const study::FreeParameter> free;
  const Values& gains;
  Aim aim;
  Units units;
  std::stop_token stop;
};

/// The results of all units of a study, which is made with overrides_for().
/// @param change null: none
std::vector<UnitResult> results_of(const study::Study& study, const Units& units, const Change* change,
                                   const std::stop_token& stop);

/// controller.delay (samples) from which on the goal seems to be lost, to 0.05; nothing up to 5 samples more.
std::optional<double> delay_lost(const Details& details, double delay);

/// Rate of the goal if its band were one count wider.
double rate_in_wider_band(const Details& details);

std::vector<Room> room_of(const Details& details);

/// Units for the limits: fewer than the search's.
Units limit_units(const Details& details);

}  // namespace zerocount::tuning
