#pragma once

#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/distributions/distribution.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/study/draws.hpp"
#include "experiments/study/rotors.hpp"
#include "experiments/study/sequence.hpp"

namespace zerocount {

// The compiled form of a manifest. A slot is a place for one value of a trial: slot s below the number of
// rows is row s of the table of parameters (that of a listed row is unused), and slot rows + i is value i of
// the one listed parameter that the study uses.

/// The listed parameter of a study: targets, torque levels, or the targets of a sequence.
struct ListedValues {
  std::size_t row{0};    ///< of the table of parameters
  std::size_t count{1};  ///< how many stand in the list
};

/// What a manifest says of one slot.
struct Value {
  enum class Kind : std::uint8_t { number, distribution, profile };
  Kind kind{Kind::number};
  std::uint32_t index{0};  ///< into the plan's distributions or profiles
  Per per{Per::trial};     ///< where it is drawn; of a profile, study or rig
  double number{0.0};      ///< where kind is number
};

/// A value that one option of an axis gives to a slot.
struct Assignment {
  std::uint32_t slot{0};
  Value value;
};

/// One factor of the product of design points. Flat, because an axis may have a million options: the
/// assignments of option o are assignments[first[o]] … assignments[first[o + 1] − 1].
struct PlanAxis {
  std::vector<std::uint32_t> first{0};
  std::vector<Assignment> assignments;
};

inline std::size_t option_count(const PlanAxis& axis) {
  return axis.first.size() - 1;
}

/// Where an input column comes from: the value of a slot, or the mean of its profile.
struct InputSource {
  std::uint32_t slot{0};
  bool profile_mean{false};
};

/// What is drawn anew in each trial. Factor f below the number of slots is the value of slot slots[f]; the
/// one after them, where there is one, is all that trials draw while they run.
struct TrialFactors {
  std::vector<std::uint32_t> slots;
  bool within_trial{false};
};

inline std::size_t factor_count(const TrialFactors& factors) {
  return factors.slots.size() + (factors.within_trial ? 1 : 0);
}

struct StudyPlan {
  StudyUnits units;
  /// Of profiles, rad or m: a revolution; on a linear axis the travel, none where it is not given.
  std::optional<double> period{2.0 * std::numbers::pi};
  ListedValues list;
  bool open_loop{false};                  ///< the list is one of torque levels
  std::optional<SequenceCycle> sequence;  ///< where the list is that of a sequence
  std::vector<Value> base;                ///< [slot], where no axis says otherwise
  std::vector<PlanAxis> axes;  ///< the last changes fastest from point to point, and wins over the others
  std::vector<Distribution> distributions;
  std::vector<std::shared_ptr<const Rotors>> profiles;
  std::vector<SlotRandomness> randomness;  ///< [slot]
  RandomKey sobol_places{};                ///< used by the design `sobol` where there are rigs
  std::vector<std::uint32_t> input_slots;  ///< those that are not the same in all trials
  std::vector<InputSource> inputs;         ///< [input column]
  std::vector<InputSource> rig_inputs;     ///< [rig column]
  TrialFactors factors;                    ///< used by the design `saltelli`
  std::vector<std::uint32_t> factor_of;    ///< [slot] its factor, likewise
  TrialParameters common;                  ///< a trial's, all but the input slots in their places
  std::vector<double> numbers;             ///< [slot] the numbers of the base; of an input slot, any
};

/// Puts the number of a slot where a trial has it. The targets of a sequence and its overrun have no place of
/// their own: they go into the targets of the moves.
void set_number(const StudyPlan& plan, std::size_t slot, double number, TrialParameters& to);

/// Which option of `axis` the design point takes.
std::size_t option_at(const StudyPlan& plan, std::size_t axis, std::size_t point);

/// The value of one slot at a design point.
const Value* value_at_point(const StudyPlan& plan, std::size_t slot, std::size_t point);

/// The values of all slots at a design point.
std::vector<const Value*> values_at(const StudyPlan& plan, std::size_t point);

}  // namespace zerocount
