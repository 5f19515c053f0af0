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

/// Criterion for the equality of a recorded and a replayed real number.
enum class Equality {
  rounded,  ///< Equal within a relative 1e-9, because another computer may round exponentials differently.
  bits      ///< The same bits; any two NaN are equal.
};

/// Criterion for a file: Equality::bits if this program on this computer made the file, otherwise
/// Equality::rounded.
Equality equality_of(const layout::FileHeader& header);

/// Differences between a replayed trial and its record, one line each: inputs, measures of all moves, jerks.
/// Whole numbers must be equal.
/// @param inputs the study's input columns
/// @param measures the recorded measures of the moves
/// @param equality criterion for real numbers
std::vector<std::string> differences(
    const std::vector<study::InputColumn>& inputs, const shards::TrialResult& recorded,
    const shards::TrialResult& replayed,
    const std::vector<layout::RecordField<trial::MoveOutcome>>& measures = layout::outcome_fields(),
    Equality equality = Equality::rounded);

/// Differences between a replayed trial of a results file and its record, including the sample records if the
/// record has them.
/// @param recorded null if the file does not keep the trial: then it keeps failures, and the replay must
/// succeed
std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult* recorded,
                                                 const shards::TrialResult& replayed, Equality equality);

/// Differences between a replayed trial and its record, which is read from the file. Sample records are not
/// compared. Empty if the file keeps no trials.
std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult& replayed, Equality equality);

/// `count` different numbers from 0 to size − 1, drawn with equal probability, in ascending order; all
/// numbers if `count` is at least `size`.
std::vector<std::int64_t> sample_below(std::int64_t size, std::int64_t count, std::uint64_t seed);

/// Divides ascending rows into ranges, each short enough for one task.
std::vector<layout::RowRange> ranges_of(std::span<const std::int64_t> rows);

/// Trials to run again.
struct ChosenTrials {
  std::vector<std::int64_t> rows;
  std::uint64_t seed{1};  ///< Seed for the choice of failures.
};

/// Runs trials of the file again with its engine, and compares all stored data of each: inputs, measures,
/// jerks and sample records. If the file keeps only failures, equally many of these, drawn with equal
/// probability, run in addition to the chosen rows. A chosen trial that fails must then be among the recorded
/// failures, and the others must succeed. A file without trials gives nothing to compare.
void check_trials(CheckReport& report, const reading::ResultsFile& file, const study::Study& study,
                  const ChosenTrials& chosen, Equality equality);

/// Point from which the traces of the two engines differ. Both engines are accurate, but a loop can amplify
/// their rounding differences without limit.
struct Parting {
  std::int64_t sample{0};  ///< First sample that differs in count or code, from the start of the trial.
  double time{0.0};        ///< Time of this sample, s.
};

/// Text such as "from t = 0.98 s on (sample 980)".
std::string text_of(const Parting& parting);

/// Runs a trial with both engines. Returns where they part; nothing if counts and codes are equal at all
/// samples. Needs 16 bytes per sample.
std::optional<Parting> parting_of_engines(const trial::TrialParameters& parameters);

/// Comparison of a trial traced by the reference engine with its record.
struct TracedTrial {
  /// Differences between the record and a rerun with the engine that made it, as `verify` finds them. If
  /// there are any, the file is damaged or was made by another program.
  std::vector<std::string> differences;
  /// Point from which the trace differs from the recorded trial, if its own engine reproduces the record.
  std::optional<Parting> parting;
};

/// Compares a traced trial with its record.
/// @param traced trial traced by the reference engine, with its row
TracedTrial compare_with_record(const reading::ResultsFile& file, const study::Study& study,
                                const shards::TrialResult& traced);

}  // namespace zerocount::verification
