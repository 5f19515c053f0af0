#pragma once

#include <span>
#include <string>

#include "analysis/identification/contact_fit.hpp"
#include "analysis/identification/record_parts.hpp"

namespace zerocount::identification {

/// The reason why the records do not determine a coordinate, derived from their parts: a clause that
/// completes "because …".
std::string missing_information(std::span<const TestRecord> records, std::span<const RecordParts> parts,
                                const ContactFit& fit, Coordinate coordinate);

}  // namespace zerocount::identification
