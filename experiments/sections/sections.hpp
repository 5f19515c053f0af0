#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/keys/values.hpp"
#include "experiments/shapes/shape.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_table.hpp"

namespace zerocount::sections {

// Values that a sweep or a condition gives to parameters by their dotted paths.

/// One factor of the product of design points: a swept key or the list of cases. It has the axis for the
/// plan, and the labels of its options (the alternatives that it runs through).
struct SweptAxis {
  bool cases{false};
  std::string name;                   ///< dotted path of the swept key; "case" for the cases
  yaml::Place place{};                ///< place of the axis's values in the manifest
  std::vector<std::string> labels{};  ///< [option of the axis] label
  study::PlanAxis axis{};
  /// [assignment of a value in `axis`] place of this value in the manifest.
  std::vector<yaml::Place> places{};
  /// Slots (parameters in the plan) to which some option assigns a value, in order of appearance.
  std::vector<std::size_t> slots{};
};

/// Whether the path names a value inside a spectrum of the study, its points or its number of lines:
/// "disturbance.vibration.0.lines".
bool is_of_spectrum(const study::StudyPlan& plan, std::string_view path);

/// The slots (parameters in the plan) that the dotted path in the key of `entry` names. Empty for an unknown
/// path, which is reported with the nearest known path.
/// @param refusal message about a key that is not a parameter
std::optional<study::SlotRange> find_assigned(const yaml::Field& map, const yaml::YamlEntry& entry,
                                              std::string_view refusal, keys::StudyDraft& draft);

/// Adds the slots to SweptAxis::slots, unless they are there already.
void note_slots(SweptAxis& axis, const study::SlotRange& slots);
void assign(SweptAxis& axis, std::size_t slot, const study::Value& value, const yaml::Place& place);
/// Reads the values of `field` and assigns them to these slots in the current option of the axis.
/// finish_option() ends the option.
void read_assignments(const yaml::Field& field, const study::SlotRange& slots, SweptAxis& axis,
                      keys::StudyDraft& draft);
void finish_option(SweptAxis& axis, std::string label);

/// Gives the values of the axis that have no `aging` the law of aging that their parameter has outside the
/// sweep.
void inherit_aging(study::PlanAxis& axis, const study::StudyPlan& plan);

/// Noun for the values of the list that the slots hold, such as "targets", for messages.
std::string_view noun_of(const study::SlotRange& list, const study::StudyTable& table);

/// Words for messages about one option of an axis, such as a case or a condition.
struct OptionWords {
  std::string_view option;   ///< noun for one option in messages, "case"
  std::string_view refusal;  ///< message that refuses a key which is not a parameter
};

/// Reads one option of the axis, such as a case of the sweep: a map from dotted paths of parameters to
/// values.
void read_option(const yaml::Field& options, const yaml::YamlEntry& entry, const OptionWords& words,
                 SweptAxis& axis, keys::StudyDraft& draft);

/// Reads `ages: {at: [0, 1.0e+5], unit: cycles}` into the study and its plan. Must come before the values
/// that change with age.
/// @param root the manifest
void read_ages(const yaml::Field& root, keys::StudyDraft& draft);

/// The axis whose options are the settings of the study: all pairs of a condition and an age. The axis has no
/// options if there are neither conditions nor ages. Reports too many settings, and removes them from the
/// study.
/// @param conditions result of read_conditions(); without options if there are no conditions
SweptAxis settings_axis(const SweptAxis& conditions, keys::StudyDraft& draft);

/// Reads `conditions: {NAME: {PATH: value}}` as the last axis of the plan: an override is another value of
/// its slot, drawn as often as the parameter and with the same random number. Reports an override of a
/// parameter that is swept. Stores the names of the conditions in the study.
/// @param swept axes of the sweep; all parameters must be read already
/// @return an axis without options, after a report, if there are none
SweptAxis read_conditions(const yaml::Field& field, const std::vector<SweptAxis>& swept,
                          keys::StudyDraft& draft);

/// Reports overrides by conditions of parameters that come from the table `samples`, or that `tune` may
/// change.
/// @param root the manifest.
/// @param sampled [sampled slot of the plan] place in the header of the table
void check_overrides(const yaml::Field& root, const SweptAxis& conditions,
                     const std::vector<yaml::Place>& sampled, keys::StudyDraft& draft);

/// Reads `goal`, or `goals`, of the manifest. Adds the error bands and tolerances of the goals to those that
/// the trials measure. The study's machines and all parameters must be read already.
void read_goals(const yaml::Field& root, keys::StudyDraft& draft);

/// Lets the trials of a sequence measure the position of a load whose encoder does not close the loop. The
/// study's goals must be read already.
void measure_both_masses(study::StudyPlan& plan);

/// Reads the sequential stopping rule `stop`. The manifest's `trials` become the number of trials between two
/// tests of the rule, and the study's number of trials becomes the maximum.
void read_stop(const yaml::Field& field, keys::StudyDraft& draft);

/// Reads the section `tune`: parameters that the tuning may change, criterion and margins. The study's goal
/// and all parameters must be read already.
void read_tuning(const yaml::Field& field, keys::StudyDraft& draft);

/// Reads `sweep: {grid, cases}`. The cases are the slowest axis, followed by the keys of the grid in their
/// order, the last one fastest. If both give a value to a parameter, the grid takes precedence, with a
/// warning. A product of more than max_points is an error, found without expanding it. `linspace: [a, b, n]`
/// is n numbers with equal distances from a to b, both included; `logspace: [a, b, n]` is n numbers with
/// equal ratios from a to b (values, not exponents). The values between the ends are rounded to 15
/// significant digits.
std::vector<SweptAxis> read_sweep(const yaml::Field& sweep, keys::StudyDraft& draft);

/// The labels of all design points, such as "a, controller.kp=0"; {"all"} if the study sweeps nothing.
std::vector<std::string> label_points(const std::vector<SweptAxis>& axes);

/// The sweep's axes as the results file describes them: the name of the case, and one axis for every swept
/// parameter.
std::vector<study::SweepAxis> describe_axes(const std::vector<SweptAxis>& axes, const study::StudyPlan& plan);

/// Reads `observed`, a map from cases or point labels to observations on a real machine: study.observed and
/// study.observed_counts. An observation is a text, or counts: {successes: 9, of: 10, text: what else}. The
/// observation of a case applies to all its points, except those with their own observation.
/// @param axes all axes of the sweep
void read_observations(const yaml::Field& field, const std::vector<SweptAxis>& axes, keys::StudyDraft& draft);

/// Reads the parameter sections of the manifest `root`: the plan's list, its sequence and its base values,
/// and their places. Missing values get their defaults.
void read_sections(const yaml::Field& root, keys::StudyDraft& draft, keys::PlanPlaces& places);

constexpr std::size_t max_points = 1'000'000;  ///< maximum number of points of a sweep

/// The description of `count` numbers from `from` to `to`, both included, with equal distances or
/// (logarithmic) equal ratios.
struct Spacing {
  double from{0.0};
  double to{1.0};
  std::size_t count{2};
  bool logarithmic{false};
};

/// Shape of the value of the key linspace or logspace: [first value, last value, number of values].
shapes::Shape spacing_shape(bool logarithmic);

/// Reads the value of linspace or logspace in `field`. Empty after errors, which are reported.
std::optional<Spacing> read_spacing(const yaml::Field& field, bool logarithmic, yaml::Problems& problems);

/// The numbers of a linspace or logspace. Numbers between the ends are rounded to 15 significant digits.
std::vector<double> spaced_values(const Spacing& spacing);

/// Labels "name=value" for all `values`, as short as possible but all different.
std::vector<std::string> spaced_labels(const std::string& name, const std::vector<double>& values);

}  // namespace zerocount::sections
