#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/parameters/handles.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::study {

/// The lowest value of a parameter that a design must cover at a design point in a setting (a condition at an
/// age).
struct LowEnd {
  enum class Kind : std::uint8_t {
    number,   ///< the number itself: the parameter is not drawn
    support,  ///< the low end of the support (possible values) of the parameter's distribution
    /// The 0.1 % quantile of a normal, truncated normal or lognormal distribution, which would reach lower.
    tail,
    profile  ///< the parameter varies along the rotor: the minimum of the trial's profile counts, not `value`
  };
  Kind kind{Kind::number};
  double value{0.0};  ///< lowest value, in the parameter's unit; not used for a profile
};

/// The lowest value of a parameter that a design must cover, at a design point in a setting (condition at an
/// age).
/// @param parameter dotted path of a positive physical value, such as friction.k1
LowEnd low_end(const Study& study, std::int64_t point, std::string_view parameter, std::int64_t setting = 0);

/// Range of a value over all trials of a design point: the support of its distribution, the range of its
/// profile, the range of a value computed from drawn sources, or the number itself. NaN if the value could
/// not be read or cannot be computed from its sources.
struct ParameterRange {
  double low{0.0};
  double high{0.0};
  bool can_be_zero{false};
  /// Typical value: the number, the median of the distribution, or the mean of the profile along the axis.
  double typical{0.0};
};

/// The lowest and the highest number that can be drawn for the slot (a parameter in the plan) at a design
/// point in a setting, at the setting's age. Both are finite, unlike the ends of a distribution's support.
/// The value of the slot must be a number or a distribution.
std::pair<double, double> extremes_of(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// The range of a value of the manifest at age 0, over all that can be drawn. The value must not be computed
/// from other slots.
ParameterRange range_of(const StudyPlan& plan, const Value& value);

/// The range of the factor by which age multiplies the value of a slot (a parameter in the plan) at a design
/// point in a setting: factor_at_age(). It is {1, 1, false, 1} if the value does not change with age.
ParameterRange age_factors(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// The range of the value of a slot (a parameter in the plan) over all trials at a design point in a setting,
/// at the setting's age.
ParameterRange range_of_slot(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// Whether the control has a coarse phase in some trial, from the range of controller.coarse.coarse_beyond.
bool can_have_coarse_phase(const ParameterRange& coarse_beyond);

/// The ranges of several parameters at a design point in a setting, found by handle:
/// of[parameter::friction::k1].
class Ranges {
 public:
  /// @param handles,ranges in the same order; both must outlive the object
  Ranges(std::span<const parameter::Handle> handles, std::span<const ParameterRange> ranges)
      : handles_(handles), ranges_(ranges) {}

  /// The range of the parameter.
  /// @throws std::logic_error if the parameter is not among the given ones
  const ParameterRange& operator[](const parameter::Handle& handle) const;
  std::span<const ParameterRange> all() const { return ranges_; }

 private:
  std::span<const parameter::Handle> handles_;
  std::span<const ParameterRange> ranges_;
};

/// The parameters that decide whether a point has an encoder on each mass, and which encoder closes the
/// (position) loop.
inline constexpr std::array<parameter::Handle, 5> two_encoders{
    parameter::encoder::load::counts_per_revolution, parameter::encoder::load::resolution,
    parameter::controller::cascade::position, parameter::plant::load::encoder,
    parameter::controller::structure};

/// Whether each mass has an encoder.
/// @param of ranges of the parameters `two_encoders`
bool has_two_encoders(const Ranges& of);
/// Whether the load's encoder closes the (position) loop.
/// @param of ranges of the parameters `two_encoders`
bool closes_at_load(const Ranges& of);
/// Whether some trial has two masses, and at some point the encoder of `mass` closes the loop.
bool closes_somewhere(const StudyPlan& plan, motion::EncoderPlace mass);

/// Whether the axis has a coarse encoder beside the fine one: the manifest names it, or the control reads it.
bool has_coarse_encoder(const StudyPlan& plan);

/// The slots (indices in the plan) of these parameters; for a list, the first slot.
std::vector<std::size_t> slots_named(const StudyTable& table, std::span<const parameter::Handle> handles);
/// The slots (indices in the plan) of the parameters with these dotted paths; for a list, the first slot.
std::vector<std::size_t> slots_named(const StudyTable& table, std::span<const std::string_view> paths);

/// The slots (indices in the plan) of a group of consecutive rows of the study's table of parameters.
std::vector<std::size_t> slots_of(const RowGroup& group);

/// Calls `visit` for one design point of each combination of values of `slots`, until it returns false.
/// Points that differ only in other slots are skipped.
void visit_points(const StudyPlan& plan, std::span<const std::size_t> slots,
                  const std::function<bool(std::size_t point)>& visit);

/// All values that the manifest gives to a slot (a parameter in the plan): one for each combination of
/// options of the sweep and conditions on which it depends.
std::vector<const Value*> values_of(const StudyPlan& plan, std::size_t slot);

/// The ranges of the values of these slots (parameters in the plan) at a design point in a setting, in the
/// order of `slots`.
std::vector<ParameterRange> ranges_at(const StudyPlan& plan, std::span<const std::size_t> slots,
                                      std::size_t point);

/// Whether the values behind all these ranges could be read: no range is NaN.
bool are_readable(std::span<const ParameterRange> ranges);

/// Whether the predicate `holds` is true at some design point. Its argument is the ranges of these parameters
/// at the point.
bool holds_somewhere(const StudyPlan& plan, std::span<const parameter::Handle> handles,
                     const std::function<bool(const Ranges&)>& holds);
/// Whether the predicate `holds` is true for the range of the parameter with this path at some design point.
bool holds_somewhere(const StudyPlan& plan, std::string_view path,
                     const std::function<bool(const ParameterRange&)>& holds);

}  // namespace zerocount::study
