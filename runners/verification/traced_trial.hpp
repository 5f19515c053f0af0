#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/study.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"

namespace zerocount::verification {

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
