#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "core/plugin/controller_plugin.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/distributions/distribution.hpp"
#include "experiments/parameters/measured_parameters.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/aging.hpp"
#include "experiments/study/draws.hpp"
#include "experiments/study/features.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/rotors.hpp"
#include "experiments/study/sequence.hpp"
#include "experiments/study/study.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::study {

/// The value that the manifest gives to one slot, that is to one parameter in the plan of a study.
struct Value {
  enum class Kind : std::uint8_t {
    number,
    distribution,
    profile,
    derived  ///< the value is computed from the values of other slots (parameters in the plan)
  };
  Kind kind{Kind::number};
  /// Index in the plan's distributions, profiles or derived values, depending on `kind`; unused for a number.
  std::uint32_t index{0};
  /// How often the value is drawn (per study, world, machine, trial or contact); for a profile: study or
  /// machine.
  DrawLevel level{DrawLevel::trial};
  double number{0.0};  ///< the value itself if `kind` is number
  /// Index in StudyPlan::agings of the law by which the value changes with age; empty: it does not change.
  std::optional<std::uint32_t> aging{};
};

inline bool is_drawn_per_contact(const Value& value) {
  return value.kind == Value::Kind::distribution && value.level == DrawLevel::contact;
}

/// A value that is computed from the values of other slots (parameters in the plan), which are numbers or
/// distributions.
struct DerivedValue {
  std::vector<std::uint32_t> from;  ///< slots (parameters in the plan) from whose values it is computed
  /// Computes the value from the numbers of the slots `from`, in that order; NaN if no value follows from
  /// these numbers. Null: the value equals the number of its only source.
  double (*value)(std::span<const double> from){nullptr};
};

/// The slots (indices in the plan) of a group of measured parameters, in the order of
/// MeasuredParameters::names.
struct MeasuredSlots {
  const parameters::MeasuredParameters* group{nullptr};
  std::vector<std::uint32_t> slots;
};

/// A value that one option of an axis (such as a case of the sweep, or a condition) gives to a slot, that is
/// to one parameter in the plan.
struct Assignment {
  std::uint32_t slot{0};
  Value value;
};

/// One factor of the product of design points: a list of options (such as the values of a swept key), each of
/// which assigns values to slots. The assignments of option o are assignments[first[o]] … assignments[first[o
/// + 1] − 1]. They are stored in one flat vector because an axis may have a million options.
struct PlanAxis {
  std::vector<std::uint32_t> first{0};
  std::vector<Assignment> assignments;
};

inline std::size_t option_count(const PlanAxis& axis) {
  return axis.first.size() - 1;
}

/// Source of an input column in the results: the value of a slot (a parameter in the plan), or the mean of
/// its profile along the axis.
struct InputSource {
  std::uint32_t slot{0};
  bool profile_mean{false};
  /// Index of the setting (condition at an age) whose value the column has. Set for columns of machines and
  /// worlds whose value differs between settings; otherwise empty.
  std::optional<std::int64_t> setting{};
};

/// The factors whose Sobol' indices can be estimated: quantities drawn anew in each trial. Factor f <
/// slots.size() is the value of slot slots[f]. With `within_trial` there is one more factor: all random
/// numbers that trials use while they run.
struct TrialFactors {
  std::vector<std::uint32_t> slots;
  bool within_trial{false};
};

inline std::size_t factor_count(const TrialFactors& factors) {
  return factors.slots.size() + (factors.within_trial ? 1 : 0);
}

/// The compiled form of a manifest: the value or distribution of every parameter at every design point in
/// every setting, and the random numbers that each of them draws. A *slot* stands for one number of a
/// trial: a row of `table`. A *point of the plan* is a design point in a setting (plan_point).
/// A trial is made from it in four steps:
///
///     value(slot) = assignment of the last axis that has the slot at this point, otherwise base[slot]
///     number(slot) = its number, the quantile of its distribution at the slot's uniform number, or the
///     number computed from other slots; times factor_at_age() if the value changes with age parameters =
///     common, with number(slot) set for the slots in input_slots and those that axes assign
///
/// study_trial() (study_trial.hpp) does this; point_limits.hpp has the range of a slot over all trials.
struct StudyPlan {
  parameters::StudyUnits units;
  /// Period of friction parameters that vary along the axis: a revolution, rad; on a linear axis the travel,
  /// m, if it is given.
  std::optional<double> period{2.0 * std::numbers::pi};
  StudyTable table;
  RowGroup list;  ///< the list that defines the moves: targets, torque levels, or the targets of a sequence
  std::shared_ptr<const plugin::ControllerPlugin> plugin;  ///< the user's controller; null: none
  bool open_loop{false};  ///< the list that defines the moves holds torque levels: there is no control
  /// Cycle of the sequence to which the list of targets belongs; empty: the command is not a sequence.
  std::optional<SequenceCycle> sequence;
  /// [slot] value of the parameter, used unless an axis of the sweep or a condition assigns one.
  std::vector<Value> base;
  std::vector<bool> given;  ///< [slot] whether the manifest, an axis or a table of samples has its value
  /// Axes of the sweep and the settings; the last one changes fastest, and takes precedence over the others.
  std::vector<PlanAxis> axes;
  SettingCounts settings{};  ///< numbers of conditions and ages
  /// Index in `axes` of the axis whose options are the settings (a condition at an age), with the overrides
  /// of their conditions; empty without conditions and ages.
  std::optional<std::size_t> settings_axis{};
  /// Ages at which every machine is simulated, rising; empty: nothing changes with age.
  std::vector<double> ages;
  std::vector<Aging> agings;  ///< laws of aging; Value::aging is an index in this list
  std::vector<distributions::Distribution> distributions;
  std::vector<std::shared_ptr<const Rotors>> profiles;
  std::vector<DerivedValue> derived;
  std::vector<MeasuredSlots> measured;   ///< groups of measured parameters that the study gives
  std::optional<GaussianCopula> copula;  ///< copula of the correlated values; empty if none are
  /// Slots whose values come from one row of the table of joint draws (`samples`) and share one random
  /// number.
  std::vector<std::uint32_t> sampled_slots;
  std::vector<SlotRandomness> randomness;  ///< [slot] source of the random numbers of its value
  /// Keys of the random order in which trials and machines take Sobol points (sobol_place_key()), for
  /// machines and worlds; only for the design `sobol`.
  ByGrouping<random::RandomKey> sobol_places;
  std::vector<std::uint32_t> input_slots;  ///< slots whose values differ between trials
  std::vector<InputSource> inputs;  ///< [input column of the table of trials] slot from which its values come
  /// [column of InputColumns::shared] slot from which its values come, for each way of grouping trials.
  ByGrouping<std::vector<InputSource>> shared_inputs;
  TrialFactors factors;  ///< factors of the design `saltelli`: quantities drawn anew in each trial
  /// [slot] index of the factor (quantity drawn anew in each trial) that the slot is; for the design
  /// `saltelli`.
  std::vector<std::uint32_t> factor_of;
  trial::TrialParameters common;  ///< parameters that all trials have in common; the input slots are not set
  /// [slot] number of `base`, used if the slot is not an input slot; undefined for input slots.
  std::vector<double> numbers;
};

/// Index of a point of the plan: the combination of a design point and a setting (condition at an age).
inline std::size_t plan_point(const StudyPlan& plan, std::int64_t point, std::int64_t setting = 0) {
  return static_cast<std::size_t>(point * plan.settings.total() + setting);
}
/// The design point of a point of the plan, which is a design point in a setting.
inline std::int64_t design_point(const StudyPlan& plan, std::size_t point) {
  return static_cast<std::int64_t>(point) / plan.settings.total();
}
/// The index of the setting (condition at an age) of a point of the plan.
inline std::int64_t setting_at(const StudyPlan& plan, std::size_t point) {
  return static_cast<std::int64_t>(point) % plan.settings.total();
}

/// The age at a point of the plan (a design point in a setting), in the unit of the study's ages; 0 without
/// ages.
inline double age_at(const StudyPlan& plan, std::size_t point) {
  if (plan.ages.empty()) return 0.0;
  return plan.ages[static_cast<std::size_t>(plan.settings.at(setting_at(plan, point)).age)];
}

/// Whether the value of the slot (a parameter in the plan), or a value from which it is computed, changes
/// with age at some design point in some setting.
bool changes_with_age(const StudyPlan& plan, std::size_t slot);

/// The index of the option (such as the value of a swept key) that axis number `axis` has at a point of the
/// plan, which is a design point in a setting.
std::size_t option_at(const StudyPlan& plan, std::size_t axis, std::size_t point);

/// The value that the manifest gives to one slot (a parameter in the plan) at a point of the plan, which is a
/// design point in a setting.
const Value* value_at_point(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// [slot] the values that the manifest gives to all slots (parameters) at a point of the plan, which is a
/// design point in a setting.
std::vector<const Value*> values_at(const StudyPlan& plan, std::size_t point);

/// The number of a value that is computed from other slots (parameters in the plan).
/// @param number function that returns the number of a slot
template <class NumberOf>
double derived_value(const DerivedValue& derived, NumberOf number) {
  std::vector<double> from;
  for (const std::uint32_t slot : derived.from) from.push_back(number(slot));
  return derived.value == nullptr ? from.front() : derived.value(from);
}

/// Finds the features of a study from the ranges of the parameters in its plan. All other members of the
/// study must be set.
StudyFeatures find_features(const StudyPlan& plan, const Study& study);

}  // namespace zerocount::study
