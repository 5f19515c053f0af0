#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/grouping.hpp"
#include "experiments/study/study.hpp"
#include "results/layout/layout.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "runners/verification/verification.hpp"

namespace zerocount::verification {

/// Criterion by which a recorded real number and the one of the repeated simulation count as equal.
enum class Equality {
  rounded,  ///< Equal within a relative 1e-9, because another computer may round exponentials differently.
  bits      ///< The bits must be the same; any two NaN are equal.
};

/// Criterion for the numbers of a file: Equality::bits if this program on this computer made the file,
/// otherwise Equality::rounded.
Equality equality_of(const layout::FileHeader& header);

/// Texts of the differences between a repeated simulation of a trial and its record, one line each: inputs,
/// measures of all moves, jerks. Whole numbers must be equal. Empty if there are none.
/// @param inputs the study's input columns
/// @param measures the recorded measures of the moves
/// @param equality criterion for real numbers
std::vector<std::string> differences(
    const std::vector<study::InputColumn>& inputs, const shards::TrialResult& recorded,
    const shards::TrialResult& replayed,
    const std::vector<layout::RecordField<trial::MoveOutcome>>& measures = layout::outcome_fields(),
    Equality equality = Equality::rounded);

/// Texts of the differences between a repeated simulation of a trial of a results file and its record,
/// including the sample records if the record has them. Empty if there are none.
/// @param recorded null if the file does not keep the trial: then it keeps failures, and the replay must
/// succeed
/// @param equality criterion for real numbers
std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult* recorded,
                                                 const shards::TrialResult& replayed, Equality equality);

/// Texts of the differences between a repeated simulation of a trial and its record, which is read from the
/// file. Sample records are not compared. Empty if there are none, or if the file keeps no trials.
/// @param equality criterion for real numbers
std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult& replayed, Equality equality);

/// Random sample of `count` different numbers from 0 to size − 1, each with equal probability, in ascending
/// order; all numbers if `count` is at least `size`.
std::vector<std::int64_t> sample_below(std::int64_t size, std::int64_t count, std::uint64_t seed);

/// Divides ascending rows (numbers of trials) into contiguous ranges, each short enough for one task.
std::vector<layout::RowRange> ranges_of(std::span<const std::int64_t> rows);

/// Trials of a results file that are to be simulated again.
struct ChosenTrials {
  std::vector<std::int64_t> rows;
  std::uint64_t seed{1};  ///< Seed for the random choice of recorded failures that are run in addition.
};

/// Runs trials of the file again with its engine, and compares all stored data of each: inputs, measures,
/// jerks and sample records. If the file keeps only failures, equally many of these, drawn with equal
/// probability, run in addition to the chosen rows. A chosen trial that fails must then be among the recorded
/// failures, and the others must succeed. A file without trials gives nothing to compare.
void check_trials(CheckReport& report, const reading::ResultsFile& file, const study::Study& study,
                  const ChosenTrials& chosen, Equality equality);

/// Sample from which the traces of a trial by the two engines (reference and batch) differ. Both engines are
/// accurate, but a loop can amplify their rounding differences without limit.
struct Parting {
  /// Number of the first sample that differs in encoder count or converter code, counted from the start of
  /// the trial.
  std::int64_t sample{0};
  double time{0.0};  ///< Time of this sample from the start of the trial, s.
};

/// Text about the first sample at which two traces differ, such as "from t = 0.98 s on (sample 980)".
std::string text_of(const Parting& parting);

/// Simulates a trial with both engines (reference and batch). Returns the first sample at which they differ;
/// nothing if encoder counts and converter codes are equal at all samples. Needs 16 bytes per sample.
std::optional<Parting> parting_of_engines(const trial::TrialParameters& parameters);

/// Result of comparing a trial, traced by the reference engine, with its record in a results file.
struct TracedTrial {
  /// Differences between the record and a rerun with the engine that made it, one line each, as `verify`
  /// finds them; empty: none. If there are any, the file is damaged or was made by another program.
  std::vector<std::string> differences;
  /// First sample at which the trace differs from the recorded trial; nothing if it does not, or if the
  /// record's own engine does not reproduce it either.
  std::optional<Parting> parting;
};

/// Compares a trial that was traced by the reference engine with its record in the file.
/// @param traced the traced trial, with its row (number in the study)
TracedTrial compare_with_record(const reading::ResultsFile& file, const study::Study& study,
                                const shards::TrialResult& traced);

}  // namespace zerocount::verification
