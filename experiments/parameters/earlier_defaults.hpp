#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::parameters {

/// A default that was changed. A results file has the text of its manifest, but not the defaults of the
/// program that wrote it, so the reader must supply them.
struct EarlierDefault {
  std::string_view name;          ///< of the parameter
  double value{0.0};              ///< the former default, in the parameter's unit
  std::int64_t until_version{1};  ///< last version of the results files with this default
};

/// All changed defaults, those of one parameter by increasing version. To change a default, increment the
/// version of the results files (format_version in results/layout) and add a row.
std::span<const EarlierDefault> earlier_defaults();

/// Represents the version of the results files that this program writes.
inline constexpr std::int64_t newest_version = std::numeric_limits<std::int64_t>::max();

/// The parameter's default in the programs that wrote results files of `version`.
double default_value_in(const Parameter& parameter, std::int64_t version);

}  // namespace zerocount::parameters
