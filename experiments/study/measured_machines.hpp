#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::study {

/// Measured values that are those of no machine.
struct MeasuredFault {
  std::vector<std::uint32_t> slots;  ///< of the values that contradict each other
  std::string what;                  ///< "final_stiffness = 5e+05 N/m is not below breakaway/… = 4e+05 N/m"
  std::string expected;              ///< "final_stiffness below breakaway/…"
};

/// Lowest and highest number of a slot; the same for one that is known.
using SlotEnds = std::function<std::pair<double, double>(std::uint32_t slot)>;

/// The first condition that some numbers between these ends violate. Exact, because each condition is linear
/// in each of its numbers or in its inverse, so that a corner violates it.
std::optional<MeasuredFault> fault_within(const StudyPlan& plan, const MeasuredSlots& measured,
                                          const SlotEnds& ends);

/// As fault_within, for a trial or one of its contacts: a value that is drawn at each contact may be any of
/// its distribution, or any row of joint draws.
/// @param ends of the other slots
std::optional<MeasuredFault> fault_of_machine(const StudyPlan& plan, std::size_t point,
                                              const MeasuredSlots& measured, const SlotEnds& ends);

/// Numbers of slots that have numbers or distributions, as the trial has them.
std::vector<double> drawn_numbers(const Study& study, std::int64_t point, std::int64_t index,
                                  std::span<const std::uint32_t> slots, const GivenDraws& given = {});

/// Whether the measured values of the trial are those of a machine.
bool is_machine(const Study& study, std::int64_t point, std::int64_t index, const GivenDraws& given);

}  // namespace zerocount::study
