#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "experiments/parameters/parameter_table.hpp"

namespace zerocount {

/// A default that is not what it was. A results file keeps the text of its manifest and not the defaults of
/// the program that wrote it: whoever reads the file has to supply them.
struct EarlierDefault {
  std::string_view name;          ///< of the parameter
  double value{0.0};              ///< what it was, in the parameter's unit
  std::int64_t until_version{1};  ///< last version of the results files with this default
};

/// All defaults that changed, those of one parameter by rising version. Whoever changes a default raises the
/// version of the results files (format_version in results/layout) and adds a row.
std::span<const EarlierDefault> earlier_defaults();

/// Stands for the version of the results files that this program writes.
inline constexpr std::int64_t newest_version = std::numeric_limits<std::int64_t>::max();

/// The default that the parameter had in the programs that wrote results files of `version`.
double default_value_in(const Parameter& parameter, std::int64_t version);

}  // namespace zerocount
