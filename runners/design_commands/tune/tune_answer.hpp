#pragma once

#include <string>

#include "analysis/document/answer.hpp"
#include "runners/tuning/extras.hpp"

namespace zerocount::design_commands {

using tuning::Tuning;

/// Adds the verdict, the proof and the behaviour of the moves, which are printed before the extras are made.
document::AnswerDescription<Tuning> proven_answer();

/// One extra, by simulation.
document::AnswerDescription<Tuning> extra_answer(const tuning::Extra& extra);

/// The effort, and what was left out.
document::AnswerDescription<Tuning> closing_answer();

/// All of it, with figures.
document::AnswerDescription<Tuning> tune_answer();

/// The margins of the tuned loops as a table, for the first screen of a page.
document::AnswerDescription<Tuning> margins_answer();

/// What a page with that first screen does not show yet of the proof.
document::AnswerDescription<Tuning> proof_answer();

/// Before the proof: what a drive engineer would refuse of the values that are to be proven, in one line.
std::string sanity_line(const Tuning& tuning);

}  // namespace zerocount::design_commands
