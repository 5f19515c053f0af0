#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/batch/batch.hpp"
#include "results/layout/fields.hpp"
#include "tests/support/random_trials.hpp"

namespace zerocount::testing {

/// All results that the batch engine gives for one trial.
struct BatchedTrial {
  trial::TrialOutcome outcome;
  std::vector<trial::Jerk> jerks;
  std::vector<batch::BatchSample> samples;  ///< all samples of the trial; empty if they were not observed
};

enum class Observed { samples_and_jerks, jerks };

/// Runs the trials with a new engine with these settings.
/// @returns [trial] result
std::vector<BatchedTrial> run_batch(const std::vector<trial::TrialParameters>& trials,
                                    const batch::BatchSettings& settings = {},
                                    Observed observed = Observed::samples_and_jerks);

/// Runs the trials with an engine that may have run other trials before.
std::vector<BatchedTrial> run_batch(batch::BatchEngine& engine,
                                    const std::vector<trial::TrialParameters>& trials,
                                    Observed observed = Observed::samples_and_jerks);

/// All measures of a move that a results file may have, with those of all error bands and tolerances of
/// verdict_with_all_measures().
const std::vector<layout::RecordField<trial::MoveOutcome>>& fields_of_moves();

/// Parameters of a verdict that ask for all measures, except the measures of another mass.
trial::VerdictParameters verdict_with_all_measures();

/// The trial with all measures, and with the measures of the other mass if it has a second mass.
trial::TrialParameters with_all_measures(trial::TrialParameters trial);

/// Text of the differences between two results of one trial, compared bit by bit; empty if there are none.
/// Samples are compared if both results have samples.
std::string difference_in_bits(const BatchedTrial& one, const BatchedTrial& other);

/// The result of run_trial() for a trial, in the form of a batched trial.
BatchedTrial run_by_reference(const trial::TrialParameters& parameters);

/// All instruction sets that this processor supports.
std::vector<batch::InstructionSet> available_instruction_sets();

/// random_trial(kind, index), changed so that lanes run it: without amplifier, and with the presliding model
/// in place of Coulomb's.
trial::TrialParameters trial_with_any_exponent(TrialKind kind, std::uint64_t index);

/// A random trial that lanes run, with the usual creep exponent 2 and the creep limit at 0.02 N m.
trial::TrialParameters trial_for_lanes(TrialKind kind, std::uint64_t index);

}  // namespace zerocount::testing
