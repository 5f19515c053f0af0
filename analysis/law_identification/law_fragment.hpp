#pragma once

#include <string>

#include "analysis/law_identification/law_fit.hpp"
#include "analysis/law_identification/law_identification.hpp"

namespace zerocount::law_identification {

/// The maps `plant` and `friction` of a manifest, with a distribution for each estimated parameter.
std::string law_fragment(Records records, const LawModel& model, const LawPoint& point,
                         const IdentifiedLaw& law);

}  // namespace zerocount::law_identification
