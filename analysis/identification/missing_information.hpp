#pragma once

#include <span>
#include <string>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/record_parts.hpp"

namespace zerocount {

/// Why the records leave a coordinate open, as far as their parts tell: a clause that goes on after
/// "because".
std::string missing_information(std::span<const TestRecord> records, std::span<const RecordParts> parts,
                                const ContactFit& fit, Coordinate coordinate);

}  // namespace zerocount
