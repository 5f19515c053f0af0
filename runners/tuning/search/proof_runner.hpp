#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/machine_runs/machine_runner.hpp"
#include "runners/tuning/race/proof.hpp"

namespace zerocount::tuning {

/// [goal] Counts of the goals over these machines.
GoalCounts counts_of(const study::Study& study, const trials::Replicates& machines,
                     std::span<const MachineResult> results);

/// Results of a point on some machines: counts and verdict of the goals, and the criterion.
struct Judged {
  GoalCounts counts;
  goal::Verdict verdict;
  double criterion{0.0};  ///< Estimate::criterion; infinity for "never".
};

/// Judges a point that has no results file.
/// @param results results of all machines of the study
Judged judged(const study::Study& study, const trials::Replicates& machines,
              std::span<const MachineResult> results);

/// Overrides ("key=value") of the confidence of each goal in the manifest of a proof. The error probability
/// 1 − confidence becomes the fraction that this attempt may use. So the verdict on the results file is the
/// verdict of the attempt.
std::vector<std::string> confidences_of_attempt(const study::Study& study, int attempt);

/// Counts scaled to `each` trials of every machine, at the same rates.
GoalCounts with_trials_each(GoalCounts counts, std::int64_t each);

/// Number of machines with which the proof of a candidate with these counts is expected to be decided, plus
/// half as many more.
/// @param each trials of a machine
/// @param points number of points among which a choice is made, for which the bounds allow
/// @param max_trials maximum number of trials of the proof, at least min_proof_trials()
std::int64_t proof_machines(const study::Study& study, const GoalCounts& counts, std::int64_t each,
                            std::size_t points, std::int64_t max_trials);

/// Number of trials of the smallest proof that can meet the goals in this attempt, if no move misses any.
std::int64_t min_proof_trials(const study::Study& study, int attempt);

/// A finished run of a proof: its study, and the results of its machines.
struct ProofRun {
  study::Study study;
  std::vector<MachineResult> results;
};

/// Study with these values ("key=value") written into the text of its manifest; comments of the text are
/// kept. Earlier overrides of the study become part of the text too. A value that the text cannot take, such
/// as one in a list, remains an override.
study::Study with_values_in_text(const study::Study& study, const std::vector<std::string>& values);

/// Runs the study with these values ("key=value") in its text on fresh machines, and writes a results file
/// that keeps all trials. If the file already holds the same run, it is not made again.
/// @throws Failure (interrupted); the finished trials are kept in shards
/// @throws trials::Spent if the effort ended before; nothing is kept
ProofRun run_proof(const study::Study& study, std::vector<std::string> values,
                   const trials::Replicates& machines, const std::filesystem::path& output, int threads,
                   const trials::Effort& effort);

}  // namespace zerocount::tuning
