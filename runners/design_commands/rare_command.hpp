#pragma once

#include "analysis/document/answer.hpp"
#include "runners/rare/rare_question.hpp"
#include "runners/trials/effort.hpp"

namespace zerocount::design_commands {

/// Trials that `rare` takes at most, unless it is asked for another number.
inline constexpr std::int64_t usual_rare_trials = 1'000'000;

/// The answer of `rare` on missed goals, whose weighted trials are written to no file.
/// @throws Failure: bad_input if the study draws nothing for each trial; interrupted
document::Answer rare_of(const study::Study& study, const rare::Population& of, const trials::Effort& effort);

}  // namespace zerocount::design_commands
