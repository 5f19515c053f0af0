#pragma once

#include <span>
#include <vector>

#include "analysis/fit/laws/law_identification.hpp"
#include "analysis/fit/presliding/identification.hpp"
#include "analysis/fit/record.hpp"
#include "core/failure/failure.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::identification_commands {

/// The options `--model` and `--series-compliance`.
std::vector<command_line::OptionSpec> law_options();

/// The laws to compare. None without these options, and for the pre-sliding model alone, which has a fit of
/// its own.
fit::LawChoice chosen_laws(const command_line::Arguments& arguments);

/// Refuses options that the comparison of laws does not have.
void refuse_options_beside_laws(const command_line::Arguments& arguments);

/// Success, or inconclusive with a message if no parameter is estimated or the fit does not explain the
/// records.
ExitCode identification_verdict(std::span<const fit::ParameterEstimate> parameters,
                                const fit::ResidualChecks& checks);

/// Compares the laws, with progress on stderr.
fit::LawComparison identify_laws(const command_line::Arguments& arguments, const fit::LawChoice& choice,
                                 std::vector<fit::TestRecord> records);

}  // namespace zerocount::identification_commands
