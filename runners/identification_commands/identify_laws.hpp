#pragma once

#include <span>
#include <vector>

#include "analysis/identification/identification.hpp"
#include "analysis/law_identification/law_identification.hpp"
#include "analysis/record_fit/test_record.hpp"
#include "core/failure/failure.hpp"
#include "runners/command_line/command_line.hpp"

namespace zerocount::identification_commands {

/// The options `--model` and `--series-compliance`.
std::vector<command_line::OptionSpec> law_options();

/// The laws to compare. None without these options, and for the pre-sliding model alone, which has a fit of
/// its own.
law_identification::LawChoice chosen_laws(const command_line::Arguments& arguments);

/// Refuses options that the comparison of laws does not have.
void refuse_options_beside_laws(const command_line::Arguments& arguments);

/// Success, or inconclusive with a message if no parameter is estimated or the fit does not explain the
/// records.
ExitCode identification_verdict(std::span<const identification::ParameterEstimate> parameters,
                                const record_fit::ResidualChecks& checks);

/// Compares the laws, with progress on stderr.
law_identification::LawComparison identify_laws(const command_line::Arguments& arguments,
                                                const law_identification::LawChoice& choice,
                                                std::vector<identification::TestRecord> records);

}  // namespace zerocount::identification_commands
