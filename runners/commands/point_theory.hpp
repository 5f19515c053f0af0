#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/measures/theory_prediction.hpp"
#include "core/theory/frozen_loop.hpp"
#include "core/theory/margins.hpp"
#include "experiments/study/low_end.hpp"
#include "experiments/study/study.hpp"

/// Theory of a design point, as `check` prints it.
namespace zerocount::commands {

/// Trials of a point that are examined at most.
inline constexpr std::int64_t max_trials_examined = 200;
/// Of them those of which time constants, margins and the bounds of the sampled loop are found.
inline constexpr std::int64_t max_trials_examined_closely = 20;

/// Range of a quantity over the trials of a point.
struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
};

/// Estimated time until a move has arrived, including the dwell.
struct Arrival {
  std::int64_t step{0};  // of the target, counts; 0: no step
  double time{0.0};      // from the start of the move, s
};

/// Margins of a loop over the trials. A trial without a crossover adds nothing.
struct MarginRanges {
  Range gain{};                                 // dB
  Range gain_at{};                              // Hz
  Range phase{};                                // degrees
  Range phase_at{};                             // Hz
  std::set<theory::LoopStability> stability{};  // in the trials

  void add(const theory::StabilityMargins& margins, theory::LoopStability of_trial) {
    if (!std::isnan(margins.gain.value)) {
      gain.add(20.0 * std::log10(margins.gain.value));
      gain_at.add(margins.gain.frequency);
    }
    if (!std::isnan(margins.phase.value)) {
      phase.add(margins.phase.value);
      phase_at.add(margins.phase.frequency);
    }
    stability.insert(of_trial);
  }
};

/// A loop with the friction frozen (measures::trial_loops), over the trials.
struct LoopRanges {
  std::string name;
  bool slides{false};
  Range bandwidth{};  // Hz, of a loop that slides
  MarginRanges margins{};
};

/// Results of the theory (section 3 of the paper) for the trials of a design point.
struct PointTheory {
  std::string_view outside;   // reason why the theory does not apply; empty if it does
  std::string_view left_out;  // of the controller, by criteria (6) and (7); empty: they apply
  bool observes{false};       // a disturbance observer stands in for the integral
  std::string hunting;        // lines on its prediction; empty: there is none
  bool free{false};           // no spring: ki and sampled_below are of the loop without friction
  Range ki, stable_below, sampled_below, unstable_above;  // gain_unit
  std::set<bool> sampled_stable;                          // whether the sampled loop is, in the trials
  std::string gain_name;                                  // "ki", or that of a cascade
  std::string gain_unit;                                  // its unit in the manifest
  Range dac_resolution, dac_bound;                        // torque_unit
  std::string torque_unit;
  Range frequency, sample_rate;  // Hz
  bool coarse_feedback{false};   // the bound uses the resolution Δx of the coarse encoder
  bool fine_enough{true};        // the DAC satisfies the bound in every trial
  bool fast_enough{true};        // the sample rate satisfies the rule in every trial
  measures::TheoryPrediction prediction;

  study::LowEnd low_end;          // of k1; see lowest_k1, low_stable, low_sampled
  std::int64_t rigs{0};           // number of rigs with profiles; 0 without rigs
  Range lowest_k1;                // minimum of the profiles, or the low end of the distribution
  Range low_stable, low_sampled;  // bounds at that k1, gain_unit
  Range slowest;                  // slowest time constant of the loop, s
  Arrival longest;                // slowest move of the trials
  double hold{0.0};               // of the shortest move, s
  std::vector<LoopRanges> loops;  // in the order of measures::trial_loops
};

/// Examines the first trials of the point.
PointTheory examine(const study::Study& study, std::int64_t point);

/// The lines of the point.
std::string describe(const PointTheory& theory);

/// Whether moves may end before the loop has brought them to their targets.
bool may_be_too_slow(const PointTheory& theory);

/// Why so, for a warning: what comes after "the loop's slowest time constant".
std::string slowness_text(const PointTheory& theory);

/// "1 core", "3 cores".
std::string counted(std::int64_t count, std::string_view noun);

}  // namespace zerocount::commands
