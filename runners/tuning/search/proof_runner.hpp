#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/tuning/race/proof.hpp"
#include "runners/tuning/units/unit_runner.hpp"

namespace zerocount::tuning {

/// The counts of the goals in these units, as those of a point of the study.
GoalCounts counts_of(const study::Study& study, const trials::Replicates& units,
                     std::span<const UnitResult> results);

/// A point on some units: what they count, the verdict on the goals, and the criterion.
struct Judged {
  GoalCounts counts;
  goal::Verdict verdict;
  double criterion{0.0};  ///< infinite for never
};

/// The verdict on a point that has no results file. @param results of all units of the study
Judged judged(const study::Study& study, const trials::Replicates& units,
              std::span<const UnitResult> results);

/// "key=value" of the confidence that each goal has in the manifest of a proof, of which the error
/// probability is the part of this attempt. So the verdict on the results file is that of the attempt.
std::vector<std::string> confidences_of_attempt(const study::Study& study, int attempt);

/// The counts as they would be with `each` trials of every machine, at the same rates.
GoalCounts with_trials_each(GoalCounts counts, std::int64_t each);

/// Units with which the proof of a candidate with such counts is expected to be decided, and half as many
/// more.
/// @param each trials of a unit @param points from which the bounds have to allow for a choice
/// @param max_trials limit of the proof, at least min_proof_trials()
std::int64_t proof_units(const study::Study& study, const GoalCounts& counts, std::int64_t each,
                         std::size_t points, std::int64_t max_trials);

/// Trials of the smallest proof in this attempt that can meet the goals, if no move misses one.
std::int64_t min_proof_trials(const study::Study& study, int attempt);

/// A finished run of some units.
struct ProofRun {
  study::Study study;
  std::vector<UnitResult> results;
};

/// The study with these values ("key=value") written into the text of its manifest, where its comments stay.
/// Overrides of the study become part of the text too. A value that the text cannot take, such as one in a
/// list, stays an override.
study::Study with_values_in_text(const study::Study& study, const std::vector<std::string>& values);

/// Runs the study with these values ("key=value") in its text on fresh units, into a results file that keeps
/// its trials. A file with the same run is not made again.
/// @throws Failure: interrupted; the finished trials are kept in shards. trials::Spent: the effort ended
/// before, and nothing is kept.
ProofRun run_proof(const study::Study& study, std::vector<std::string> values,
                   const trials::Replicates& units, const std::filesystem::path& output, int threads,
                   const trials::Effort& effort);

}  // namespace zerocount::tuning
