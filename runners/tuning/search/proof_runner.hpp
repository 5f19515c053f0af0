#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/race/proof.hpp"

namespace zerocount::tuning {

/// [goal] Counts of the moves that meet each goal, over the results of these machines.
GoalCounts counts_of(const study::Study& study, const trials::Replicates& machines,
                     std::span<const MachineResult> results);

/// Results of one set of values on some machines: counts and verdict of the goals, and the criterion.
struct Judged {
  GoalCounts counts;
  goal::Verdict verdict;
  /// RateEstimate::criterion, the quantity that the tuning minimises; infinity for "never".
  double criterion{0.0};
};

/// Judges the goals of a study from the results of its machines, without a results file.
/// @param results results of all machines of the study
Judged judged(const study::Study& study, const trials::Replicates& machines,
              std::span<const MachineResult> results);

/// Overrides ("key=value") of the confidence of each goal in the manifest of a proof. The error probability 1
/// − confidence becomes the fraction that this attempt may use. So the verdict on the results file is the
/// verdict of the attempt.
/// @param attempt number of the attempt, from 1
std::vector<std::string> confidences_of_attempt(const study::Study& study, int attempt);

/// Scales the counts of each goal to `each` trials of every machine, at the same success rates.
GoalCounts with_trials_each(GoalCounts counts, std::int64_t each);

/// Number of machines with which the proof of a candidate with these counts is expected to be decided, plus
/// half as many more.
/// @param each trials of a machine
/// @param points number of points among which a choice is made, for which the bounds allow
/// @param max_trials maximum number of trials of the proof, at least min_proof_trials()
std::int64_t proof_machines(const study::Study& study, const GoalCounts& counts, std::int64_t each,
                            std::size_t points, std::int64_t max_trials);

/// Number of trials of the smallest proof that can show the goals to be met in this attempt, if no move
/// misses any.
/// @param attempt number of the attempt, from 1
std::int64_t min_proof_trials(const study::Study& study, int attempt);

/// A finished run of a proof: its study, and the results of its machines, from the results file.
struct ProofRun {
  study::Study study;
  std::vector<MachineResult> results;
};

/// Study with these values ("key=value") written into the text of its manifest; comments of the text are
/// kept. Earlier overrides of the study become part of the text too. A value that cannot be written into the
/// text, such as one in a list, remains an override.
study::Study with_values_in_text(const study::Study& study, const std::vector<std::string>& values);

/// Runs the study with these values ("key=value") in its text on fresh machines, and writes a results file
/// that keeps all trials. If the file already holds the same run, it is not made again.
/// @throws Failure (interrupted); the finished trials are kept in shards
/// @throws trials::Spent if the effort ended before; nothing is kept
ProofRun run_proof(const study::Study& study, std::vector<std::string> values,
                   const trials::Replicates& machines, const std::filesystem::path& output, int threads,
                   const trials::Effort& effort);

}  // namespace zerocount::tuning
