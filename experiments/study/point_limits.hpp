#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The lowest value of a parameter that a design must cover at a design point under a condition.
struct LowEnd {
  enum class Kind : std::uint8_t {
    number,   ///< the parameter is one number
    support,  ///< low end of its distribution
    tail,     ///< 0.1 % quantile of a normal, truncated normal or lognormal distribution
    profile  ///< the parameter varies along the rotor: use the minimum of the trial's profile; `value` is not
             ///< set
  };
  Kind kind{Kind::number};
  double value{0.0};  ///< in the parameter's unit
};

/// @param parameter name of a positive physical value, such as friction.k1.
LowEnd low_end(const Study& study, std::int64_t point, std::string_view parameter,
               std::int64_t condition = 0);

/// Range of a value over all trials of a design point: the support of its distribution, the limits of its
/// profile, what can follow from the draws of its sources, or the number itself. NaN for a value that could
/// not be read.
struct ValueLimits {
  double low{0.0};
  double high{0.0};
  bool can_be_zero{false};
  double typical{0.0};  ///< the number, the median of the distribution, or the mean of the profile
};

/// The lowest and the highest number of the slot at a point of the plan, at its age, which unlike the ends of
/// a support are finite. For a number or a distribution.
std::pair<double, double> extremes_of(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// The limits of a value that does not follow from others, at age 0.
ValueLimits limits_of(const StudyPlan& plan, const Value& value);

/// The limits of factor_at_age() for the value of a slot at a point of the plan; {1, 1, false, 1} if it does
/// not change with age.
ValueLimits age_factors(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// The limits of the slot at a point of the plan, at its age.
ValueLimits limits_of_slot(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// Whether the control has a coarse phase in some trial, from the limits of controller.coarse.coarse_beyond.
bool can_have_coarse_phase(const ValueLimits& coarse_beyond);

/// The parameters by which a point has an encoder on each mass, and which of them closes the (position) loop.
inline constexpr std::array<std::string_view, 5> two_encoders{
    "encoder.load.counts_per_revolution", "encoder.load.resolution", "controller.cascade.position",
    "plant.load.encoder", "controller.structure"};

/// @param limits of two_encoders.
bool has_two_encoders(std::span<const ValueLimits> limits);
bool closes_at_load(std::span<const ValueLimits> limits);
/// Whether some trial has two masses, and some point a loop that is closed by the encoder of this one.
bool closes_somewhere(const StudyPlan& plan, motion::EncoderPlace mass);

/// Whether the axis has a coarse encoder beside the fine one: the manifest names it, or the control reads it.
bool has_coarse_encoder(const StudyPlan& plan);

/// The slots of these parameters, by their dotted paths.
std::vector<std::size_t> slots_named(const StudyTable& table, std::span<const std::string_view> names);

/// The slots of the group.
std::vector<std::size_t> slots_of(const RowGroup& group);

/// Calls `visit` for one design point of each combination of values of `slots`, until it returns false.
/// Points that differ only in other slots are skipped.
void visit_points(const StudyPlan& plan, std::span<const std::size_t> slots,
                  const std::function<bool(std::size_t point)>& visit);

/// The values of a slot: one of each design point at which it can differ.
std::vector<const Value*> values_of(const StudyPlan& plan, std::size_t slot);

/// The limits of the parameters at a design point, in the order of `slots`.
std::vector<ValueLimits> limits_at(const StudyPlan& plan, std::span<const std::size_t> slots,
                                   std::size_t point);

/// Whether all values could be read.
bool are_readable(std::span<const ValueLimits> limits);

/// Whether `holds` for the limits of these parameters, in their order, at some design point.
bool holds_somewhere(const StudyPlan& plan, std::span<const std::string_view> names,
                     const std::function<bool(std::span<const ValueLimits>)>& holds);
/// Whether `holds` for the limits of one parameter at some design point.
bool holds_somewhere(const StudyPlan& plan, std::string_view name,
                     const std::function<bool(const ValueLimits&)>& holds);

}  // namespace zerocount::study
