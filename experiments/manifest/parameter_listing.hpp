#pragma once

#include <string>
#include <vector>

#include "experiments/parameters/study_units.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {

/// Texts that describe a parameter in a listing.
struct ListedParameter {
  std::string name;  ///< dotted path in a manifest
  std::string unit;  ///< unit, "1" if dimensionless
  /// Text of the default; if there is none, the range over the known guides, else "none".
  std::string default_value;
  std::string allowed;  ///< allowed labels, or the range of numbers
  std::string source;   ///< source of the default; "-" if there is no default
  std::string meaning;
};

/// All parameters of an axis with these units, in the order of the table.
std::vector<ListedParameter> listed_parameters(const parameters::StudyUnits& units);

/// The parameters of one study: the rows of the table, and a row for each value of the lists in its manifest.
std::vector<ListedParameter> listed_parameters(const study::Study& study);

/// Texts that describe a distribution, which a manifest may have in place of a number.
struct ListedDistribution {
  std::string name;
  std::string written;  ///< how a manifest writes the distribution
  std::string meaning;
};

std::vector<ListedDistribution> listed_distributions(const parameters::StudyUnits& units);

}  // namespace zerocount::manifest
