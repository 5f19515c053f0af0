#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/parameters/interval.hpp"

namespace zerocount {

enum class ParameterKind { real, whole_number, enumeration };

/// One row of the table of parameters: all that the project knows of one of a trial's parameters.
struct Parameter {
  std::string_view name;  ///< dotted path in the manifest: "section.key"
  std::string_view unit;  ///< "1" where dimensionless
  std::string_view meaning;
  std::string_view source;  ///< of the default: a place in the paper, or "assumed"
  ParameterKind kind{ParameterKind::real};
  Interval range;                       ///< of the values allowed
  std::vector<std::string_view> words;  ///< of an enumeration, in the order of its numbers
  std::size_t sobol_dimension{0};       ///< fixed for ever, so that a new row changes no other's draws
  double FrictionParameters::*profiled{nullptr};  ///< where a profile goes; null where none is allowed
  bool per_move{false};  ///< a list with one value per move: the targets, which have no default
  double (*get)(const TrialParameters&){nullptr};        ///< null where per_move
  void (*set)(TrialParameters&, double value){nullptr};  ///< null where per_move
};

/// The one table of parameters, in the order of columns and listings. It drives parsing, validation, the JSON
/// Schema, the columns of results files and `zerocount parameters`.
std::span<const Parameter> parameter_table();

/// Sobol dimension of move i's value of a per_move parameter: this number + i. Below it are the rows' own.
constexpr std::size_t first_sobol_dimension_of_moves = 64;

/// Row of the parameter with this dotted path.
std::optional<std::size_t> find_parameter(std::string_view name);

/// Default value, from the core's own structs; an enumeration's is the number of its word.
double default_value(const Parameter& parameter);

/// The default as it would be written in a manifest; "required" where there is none.
std::string default_text(const Parameter& parameter);

}  // namespace zerocount
