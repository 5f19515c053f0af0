#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/grouping.hpp"

namespace zerocount::study {

/// The engine that runs the trials. The results of the engines agree to the tolerances in
/// core/batch/README.md, not bitwise.
enum class Engine {
  batch,     ///< the batch engine: simulates many trials at a time in SIMD lanes
  reference  ///< the reference engine: simulates one trial after the other
};

/// Sequential stopping (`stop`): after each block of trials the study ends if the bounds of the success rate
/// are narrow enough at every point. The bounds are a confidence sequence, which allows repeated tests.
struct StoppingRule {
  /// Largest half-width of the success rate's bounds at which the study ends (see
  /// analysis/basis/statistics/mean_bounds.hpp).
  double success_rate_halfwidth{0.1};
  double confidence{0.95};     ///< confidence level of the bounds of one design point
  std::int64_t block{1};       ///< number of trials per design point between two tests of the rule
  std::int64_t min_trials{1};  ///< number of trials per design point before the study may end
  std::int64_t max_trials{1};  ///< number of trials per design point at which the study ends in any case
};

/// The trials that a results file keeps beside the statistics.
enum class Retention {
  trials,     ///< keeps all trials
  failures,   ///< keeps the trials that did not succeed in all their moves
  statistics  ///< keeps no trials, only statistics
};

enum class Design { monte_carlo, latin_hypercube, sobol, saltelli };

/// Whether existing trials stay the same when `trials` is increased. False for a Latin hypercube, whose
/// strata depend on the number of trials.
bool trials_stay_when_extended(Design design);

/// Name of the factor in a sensitivity analysis that stands for all random numbers that trials use while they
/// run: noise, missed counts, the levels of the load history.
inline constexpr std::string_view within_trial_factor = "within_trial";

/// An entry of `correlation`: the correlation of the normal scores Φ⁻¹(F(x)) of two parameters.
struct Correlation {
  std::string first;  ///< dotted path of the first of the two correlated parameters
  std::string second;
  double coefficient{0.0};  ///< correlation coefficient ρ of the normal scores, −1 < ρ < 1
};

/// Text of the correlations, "friction.k1 and friction.k2 (0.6), friction.k1 and friction.beta (-0.5)".
std::string correlations_text(const std::vector<Correlation>& correlations);

/// Joint draws of several parameters (`samples`). A row is drawn as a whole, with equal probability.
struct JointSamples {
  std::string file;                     ///< name of the table's file as the manifest gives it
  std::string text;                     ///< contents of the file, the table of draws
  std::vector<std::string> parameters;  ///< [column of the table] dotted path of the parameter
  std::int64_t rows{0};
  DrawLevel level{DrawLevel::trial};  ///< how often a row is drawn (per study, world, machine or trial)
};

/// Text of the joint draws, "friction.k1, friction.k2: a row of posterior.csv (1000 draws) for each machine".
std::string samples_text(const JointSamples& samples);

}  // namespace zerocount::study
