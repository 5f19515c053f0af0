#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

/// Agreement of two integrations of the same trial, sample by sample.
struct Agreement {
  std::int64_t samples{0};  ///< number of compared samples
  /// Largest difference of the rotor angle θ until the first breakaway, counts.
  double before_breakaway{0.0};
  double after_breakaway{0.0};  ///< largest difference of the rotor angle θ after the first breakaway, counts
  /// Largest ratio of the difference after the first breakaway to the accuracy promised there.
  double after_breakaway_ratio{0.0};
  /// Number of samples with different numbers of remembered reversals (the rest rules may differ).
  std::int64_t depth_differences{0};
  std::int64_t slide_samples{0};  ///< number of samples taken while the contact slid
  std::int64_t edge_trials{
      0};  ///< trials cut short: θ on an encoder edge, within the accuracy, read differently
  std::vector<std::string> failures;  ///< disagreements, one line each

  /// Adds the results of another comparison.
  void add(const Agreement& other);
  /// Text of all numbers of the comparison in one line.
  std::string figures() const;
};

/// Compares two integrations of a trial, sample by sample. Promised accuracy of the rotor angle θ (rad): 1e-6
/// count until the first breakaway, and 1e-3 count + 1e-7 of the travel after it.
///
/// Counts, codes, errors, coarse counts and modes must be equal. Where a count differs because θ stands on an
/// edge within the promised accuracy, the two trials differ from then on: that is counted in edge_trials and
/// the rest is not compared.
Agreement compare(const trial::TrialParameters& parameters, const std::vector<trial::SampleRecord>& trial,
                  const std::vector<trial::SampleRecord>& judge, const std::string& name);

}  // namespace zerocount::testing
