#pragma once

#include <string>
#include <vector>

#include "experiments/parameters/study_units.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::manifest {

/// A parameter as people read it.
struct ListedParameter {
  std::string name;           ///< dotted path in a manifest
  std::string unit;           ///< "1" if dimensionless
  std::string default_value;  ///< "none" without one; then the range over the guides, if they have it
  std::string allowed;        ///< words, or a range of numbers
  std::string source;         ///< of the default; "-" without one
  std::string meaning;
};

/// All parameters of an axis with these units, in the order of the table.
std::vector<ListedParameter> listed_parameters(const parameters::StudyUnits& units);

/// The parameters of one study: the rows of the table, and a row for each value of the lists in its manifest.
std::vector<ListedParameter> listed_parameters(const study::Study& study);

/// What a manifest may have in place of a number.
struct ListedDistribution {
  std::string name;
  std::string written;  ///< as in a manifest
  std::string meaning;
};

std::vector<ListedDistribution> listed_distributions(const parameters::StudyUnits& units);

}  // namespace zerocount::manifest
