#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/batch/batch.hpp"
#include "tests/support/random_trials.hpp"

namespace zerocount::testing {

/// All that a batch tells of one of its trials.
struct BatchedTrial {
  trial::TrialOutcome outcome;
  std::vector<trial::Jerk> jerks;
  std::vector<batch::BatchSample> samples;  ///< empty where they were not observed
};

enum class Observed { samples_and_jerks, jerks };

/// Runs the trials with an engine of these settings. @returns [trial].
std::vector<BatchedTrial> run_batch(const std::vector<trial::TrialParameters>& trials,
                                    const batch::BatchSettings& settings = {},
                                    Observed observed = Observed::samples_and_jerks);

/// The same with an engine that may have run other trials before.
std::vector<BatchedTrial> run_batch(batch::BatchEngine& engine,
                                    const std::vector<trial::TrialParameters>& trials,
                                    Observed observed = Observed::samples_and_jerks);

/// What differs between two results of one trial, be it in the last bit; empty where nothing does. Samples
/// are compared where both have some.
std::string difference_in_bits(const BatchedTrial& one, const BatchedTrial& other);

/// What run_trial tells of a trial, in the same form.
BatchedTrial run_by_reference(const trial::TrialParameters& parameters);

/// Every instruction set that this processor has.
std::vector<batch::InstructionSet> available_instruction_sets();

/// random_trial(kind, index), changed where lanes would not run it: no amplifier, and the presliding model in
/// place of Coulomb's.
trial::TrialParameters trial_with_any_exponent(TrialKind kind, std::uint64_t index);

/// The same with the usual creep exponent 2, and the creep limit at 0.02 N m as before.
trial::TrialParameters trial_for_lanes(TrialKind kind, std::uint64_t index);

}  // namespace zerocount::testing
