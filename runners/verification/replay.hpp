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

/// When a recorded and a replayed real number are equal.
enum class Equality {
  rounded,  ///< within a relative 1e-9: exponentials may be rounded differently on another machine
  bits      ///< the same bits; any two NaN are equal
};

/// To the bit if this program on this machine made the file.
Equality equality_of(const layout::FileHeader& header);

/// Differences between a replayed trial and its record, one line each: inputs, measures of all moves, jerks.
/// Whole numbers must be equal.
/// @param inputs the study's input columns
/// @param measures the recorded measures of the moves
/// @param equality of real numbers
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

/// Reads the record from the file; sample records are not compared. No differences if the file keeps no
/// trials.
std::vector<std::string> differences_from_record(const reading::ResultsFile& file,
                                                 const shards::TrialResult& replayed, Equality equality);

/// `count` different numbers from 0 to size − 1, drawn evenly, in rising order; all if there are not more.
std::vector<std::int64_t> sample_below(std::int64_t size, std::int64_t count, std::uint64_t seed);

/// The rising `rows` as ranges, each short enough for one task.
std::vector<layout::RowRange> ranges_of(std::span<const std::int64_t> rows);

/// Trials to run again.
struct ChosenTrials {
  std::vector<std::int64_t> rows;
  std::uint64_t seed{1};  ///< of the choice of failures
};

/// Runs trials of the file again with its engine, and compares everything that is stored of each: inputs,
/// measures, jerks and sample records. If the file keeps failures only, runs as many of them, drawn evenly,
/// besides the chosen rows: a trial that fails must be among the failures as it is run, and the others must
/// succeed. A file without trials gives nothing to compare.
void check_trials(CheckReport& report, const reading::ResultsFile& file, const study::Study& study,
                  const ChosenTrials& chosen, Equality equality);

/// Where the two engines part: both are accurate, but a loop can amplify their rounding without limit.
struct Parting {
  std::int64_t sample{0};  ///< the first that differs in count or code, from the start of the trial
  double time{0.0};        ///< of that sample, s
};

/// "from t = 0.98 s on (sample 980)"
std::string text_of(const Parting& parting);

/// Runs a trial with both engines; nothing if their counts and codes are equal at all samples. Needs 16 bytes
/// a sample.
std::optional<Parting> parting_of_engines(const trial::TrialParameters& parameters);

/// A trial that the reference engine traced, beside its record.
struct TracedTrial {
  /// Of the trial, run again with the engine that ran it, from the record, as verify finds them: the file is
  /// damaged, or made by another program.
  std::vector<std::string> differences;
  /// From where on the trace differs from the recorded trial, which its own engine reproduces.
  std::optional<Parting> parting;
};

/// @param traced by the reference engine, with its row
TracedTrial compare_with_record(const reading::ResultsFile& file, const study::Study& study,
                                const shards::TrialResult& traced);

}  // namespace zerocount::verification
