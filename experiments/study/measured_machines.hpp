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

/// A contradiction between measured values: no machine can have all of them.
struct MeasuredFault {
  /// Slots (parameters in the plan) of the values that contradict each other.
  std::vector<std::uint32_t> slots;
  /// Message that names the contradiction: "final_stiffness = 5e+05 N/m is not below breakaway/… = 4e+05
  /// N/m".
  std::string what;
  /// The condition that the values violate, as text: "final_stiffness below breakaway/…".
  std::string expected;
};

/// Function that returns the lowest and the highest number that a slot (a parameter in the plan) can have;
/// both are equal if the number is known.
using SlotEnds = std::function<std::pair<double, double>(std::uint32_t slot)>;

/// The first condition between measured values that some numbers between the ends violate; empty if none is
/// violated. Only the corners of the box are tried. This is exact, because each condition is linear in each
/// of its numbers or in the inverse of the number, so a violated condition is violated at a corner.
std::optional<MeasuredFault> fault_within(const StudyPlan& plan, const MeasuredSlots& measured,
                                          const SlotEnds& ends);

/// The first condition between measured values that the values of a trial, or of one of its contacts (periods
/// between two slips), violate; see fault_within(). A value that is drawn at each contact may take any value
/// of its distribution, or any row of joint samples.
/// @param ends ends of the slots that are not drawn at each contact
std::optional<MeasuredFault> fault_of_machine(const StudyPlan& plan, std::size_t point,
                                              const MeasuredSlots& measured, const SlotEnds& ends);

/// The numbers that trial `index` has for the given slots (parameters in the plan). The values of these slots
/// must be numbers or distributions.
std::vector<double> drawn_numbers(const Study& study, std::int64_t point, std::int64_t index,
                                  std::span<const std::uint32_t> slots, const GivenDraws& given = {});

/// Whether a machine can have the measured values of the trial: they satisfy all conditions between them.
bool is_machine(const Study& study, std::int64_t point, std::int64_t index, const GivenDraws& given);

}  // namespace zerocount::study
