#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"
#include "experiments/study/study.hpp"
#include "tests/support/agreement.hpp"

namespace zerocount::testing {

using TrialRecorder = std::function<std::vector<trial::SampleRecord>(const trial::TrialParameters&)>;

/// All samples of a trial, simulated by the scalar reference engine.
std::vector<trial::SampleRecord> reference_records(const trial::TrialParameters& parameters);

/// Agreement of an engine with the scalar reference on the trials of a study.
struct EngineAgreement {
  Agreement samples;              ///< agreement up to the first breakaway of each trial
  std::int64_t calm_trials{0};    ///< number of compared trials that never break away
  std::int64_t broken_trials{0};  ///< number of trials that were compared up to their first breakaway

  /// Whether the engine agrees: no failure, and at most one trial in fifty cut short because its angle stands
  /// on an encoder edge.
  bool holds() const;
  std::string text() const;  ///< figures in one line, and one line for each failure
};

/// Compares an engine with the reference on the first trials of the study (of one design point) until `calm`
/// of them that never break away have been compared, and of the others no more than that: counts, codes and
/// modes equal at every sample, θ within 1e-6 count. A trial that breaks away is compared up to there: after
/// it, rounding decides.
EngineAgreement agreement_with_reference(const TrialRecorder& record, const study::Study& study,
                                         std::int64_t calm);

}  // namespace zerocount::testing
