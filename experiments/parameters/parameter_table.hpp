#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/numerics/interval.hpp"
#include "core/trial/parameters.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount {

enum class ParameterKind { real, whole_number, enumeration, truth };

/// One row of the table of parameters: all that the project knows of one of a trial's parameters.
struct Parameter {
  std::string_view name;  ///< dotted path in the manifest: "plant.inertia", "controller.coarse.kp"
  std::string_view
      unit;  ///< on a rotary axis, of a gain with controller.units: count; "1" where dimensionless
  std::string_view meaning;
  std::string_view source;  ///< of the default: a place in the paper, or "assumed"
  ParameterKind kind{ParameterKind::real};
  Interval range;                       ///< of the values allowed
  std::vector<std::string_view> words;  ///< of an enumeration or a truth value, in the order of its numbers
  std::size_t sobol_dimension{0};       ///< by sobol_order.hpp; of a list, that of its first value
  double FrictionParameters::*profiled{nullptr};  ///< where a profile goes; null where none is allowed
  std::string_view si_unit{};         ///< of a gain with controller.units: si; empty for other parameters
  std::string_view si_meaning{};      ///< likewise
  std::optional<AxisKind> only_on{};  ///< the kind of axis that has the parameter; none where both have
  std::string_view instead{};         ///< what to give on the other kind, for messages
  bool of_machine{false};             ///< it belongs to the machine, and not to what a trial does with it
  bool listed{false};  ///< a list of values: one way to say what the moves go to; a study uses one of them
  double (*get)(const TrialParameters&){nullptr};        ///< null where the trial has no field for it alone
  void (*set)(TrialParameters&, double value){nullptr};  ///< likewise
};

/// The one table of parameters, in the order of columns and listings. It drives parsing, validation, the JSON
/// Schema, the columns of results files and `zerocount parameters`.
std::span<const Parameter> parameter_table();

/// Most values of a listed parameter.
constexpr std::size_t max_listed_values = 3000;

/// Sobol dimension of value i of a listed parameter: this number + i. The rows' own are those below it and
/// those from first_sobol_dimension_beyond_moves on.
constexpr std::size_t first_sobol_dimension_of_moves = 64;
constexpr std::size_t first_sobol_dimension_beyond_moves = first_sobol_dimension_of_moves + max_listed_values;

/// Sobol dimension of the mean of a profile: this number + that of its parameter, a row of friction.
constexpr std::size_t first_sobol_dimension_of_means = 3600;

/// Row of the parameter with this dotted path.
std::optional<std::size_t> find_parameter(std::string_view name);

/// Whether the parameter may be left out wherever it has a meaning.
inline bool has_default(const Parameter& parameter) {
  return parameter.get != nullptr;
}

/// Whether its values are words, and not numbers: that of an enumeration or a truth value.
inline bool has_labels(const Parameter& parameter) {
  return !parameter.labels.empty();
}

/// Whether an axis of this kind has the parameter.
inline bool exists_on(const Parameter& parameter, AxisKind axis) {
  return !parameter.only_on || *parameter.only_on == axis;
}

/// Its unit in a study; "1" where dimensionless.
std::string unit_of(const Parameter& parameter, const StudyUnits& units);

/// The values allowed in a study. A gain in SI units has room for the finest encoder and the shortest sample.
Interval range_of(const Parameter& parameter, const StudyUnits& units);

/// Its meaning in the words of a study.
std::string meaning_of(const Parameter& parameter, const StudyUnits& units);

/// Whether the default is one in these units: that of a rotary rig, N m/rad say, says nothing of a linear
/// axis.
bool default_holds(const Parameter& parameter, const StudyUnits& units);

/// Default value, from the core's own structs; where it is a word, the number of it.
double default_value(const Parameter& parameter);

/// The default as it would be written in a manifest; "none" where there is none.
std::string default_text(const Parameter& parameter, const StudyUnits& units = {});

}  // namespace zerocount
