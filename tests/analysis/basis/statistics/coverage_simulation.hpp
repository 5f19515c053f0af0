#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace zerocount::testing {

/// A population of machines and trials with known distributions.
///
/// Machine i holds zero in a move with the probability qᵢ. The qᵢ are beta-distributed with the mean
/// `success_mean` and the standard deviation `success_sd`; if there are weak machines, qᵢ is `weak_success`
/// for these and 1 for all others. Half of the trials decide once for all of their moves, the others for each
/// move. The logarithm of a settling time is the sum of normal effects of machine, trial and move; times are
/// rounded up to samples of 0.5 ms, and a time beyond the hold of 1 s never arrives. The jerks of a trial are
/// Poisson numbers with gamma distributed effects of machine and trial.
struct Population {
  double success_mean{0.9};
  double success_sd{0.0};
  double weak_machines{0.0};  ///< proportion of weak machines; 0: the beta distribution holds
  double weak_success{0.7};
  double machine_effect{0.0};  ///< standard deviation of ln(settling time) between machines
  double trial_effect{0.0};    ///< standard deviation of ln(settling time) between trials of a machine
  double move_effect{0.5};     ///< standard deviation of ln(settling time) between moves of a trial
  double jerks{0.3};           ///< mean number of jerks per trial
  /// Standard deviation of the factor by which a machine's number of jerks differs from the mean; 0: all
  /// machines are alike.
  double jerk_sd{0.0};
};

/// Size of a simulated study of the population.
struct Sample {
  std::int64_t machines{0};  ///< number of machines; 0: every trial has its own machine
  std::int64_t trials{0};    ///< number of trials on all machines
  std::int64_t moves{1};     ///< number of moves per trial
};

/// Observed coverage of a bound with the confidence 95 %.
struct Coverage {
  std::string bound;
  std::int64_t repetitions{0};
  std::int64_t covered{0};
  /// Number of repetitions in which bounds that assume independent moves cover; −1: there are no such bounds.
  std::int64_t plainly{-1};
};

/// Repeats the study with random numbers from `seed`, and counts the coverage of every bound that a summary
/// gives.
std::vector<Coverage> coverage_of(const Population& population, const Sample& sample,
                                  std::int64_t repetitions, std::uint64_t seed);

}  // namespace zerocount::testing
