#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/keys/values.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_table.hpp"

/// Values that a sweep or a condition gives to parameters by their dotted paths.
namespace zerocount::sections {

/// One factor of the product of design points: the axis for the plan, and the labels of its options.
struct SweptAxis {
  bool cases{false};
  std::string name;                   ///< the swept key; "case" for the cases
  yaml::Place place{};                ///< of its values
  std::vector<std::string> labels{};  ///< [option]
  study::PlanAxis axis{};
  std::vector<yaml::Place> places{};  ///< [assignment]
  std::vector<std::size_t> slots{};   ///< assigned by some option, in order of appearance
};

/// The slots of the entry's dotted path. Reports an unknown one, with the nearest known.
/// @param refusal what is said of a key that is not a parameter
std::optional<study::SlotRange> find_assigned(const yaml::Field& map, const yaml::YamlEntry& entry,
                                              std::string_view refusal, keys::Reading& reading);

/// Adds slots to those that some option assigns.
void note_slots(SweptAxis& axis, const study::SlotRange& slots);
void assign(SweptAxis& axis, std::size_t slot, const study::Value& value, const yaml::Place& place);
/// Adds the values of `field` to the current option of the axis, which finish_option() ends.
void read_assignments(const yaml::Field& field, const study::SlotRange& slots, SweptAxis& axis,
                      keys::Reading& reading);
void finish_option(SweptAxis& axis, std::string label);

/// Lets the values that say nothing of it change with age as those of the sections do.
void inherit_aging(study::PlanAxis& axis, const study::StudyPlan& plan);

/// Noun for the values of a list.
std::string_view noun_of(const study::SlotRange& list, const study::StudyTable& table);

/// How messages name an option.
struct OptionWords {
  std::string_view option;   ///< "case"
  std::string_view refusal;  ///< of a key that is not a parameter
};

/// Reads an option of the axis that is a map from dotted paths to values, such as a case.
void read_option(const yaml::Field& options, const yaml::YamlEntry& entry, const OptionWords& words,
                 SweptAxis& axis, keys::Reading& reading);

}  // namespace zerocount::sections
