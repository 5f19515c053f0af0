#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace zerocount::testing {

/// Trials whose machines and trials differ by known laws.
///
/// Machine i holds zero in a move with the probability qᵢ, beta distributed between machines with the mean
/// `success_mean` and the standard deviation `success_sd`, or, where there are weak machines, `weak_success`
/// for these and 1 for all others; half of the trials decide once for all of their moves, the others for
/// each. The logarithm of a settling time is the sum of normal effects of machine, trial and move; times are
/// rounded up to samples of 0.5 ms, and a time beyond the hold of 1 s never arrives. The jerks of a trial are
/// Poisson numbers with gamma distributed effects of machine and trial.
struct Population {
  double success_mean{0.9};
  double success_sd{0.0};
  double weak_machines{0.0};  ///< proportion of all machines; 0: the beta distribution holds
  double weak_success{0.7};
  double machine_effect{0.0};  ///< standard deviation of ln(settling time) between machines
  double trial_effect{0.0};    ///< likewise between trials of a machine
  double move_effect{0.5};     ///< likewise between moves of a trial
  double jerks{0.3};           ///< mean number per trial
  double jerk_sd{0.0};         ///< of the machines' factor of the mean, 0: all alike
};

/// A study of the population.
struct Sample {
  std::int64_t machines{0};  ///< 0: every trial is a machine of its own
  std::int64_t trials{0};    ///< of all machines
  std::int64_t moves{1};     ///< per trial
};

/// How often bounds at 95 % covered what they are bounds of.
struct Coverage {
  std::string bound;
  std::int64_t repetitions{0};
  std::int64_t covered{0};
  std::int64_t plainly{-1};  ///< those that take all trials and moves for independent; −1: there are none
};

/// Repeats the study with the random numbers of `seed` and counts, for every bound that a summary gives.
std::vector<Coverage> coverage_of(const Population& population, const Sample& sample,
                                  std::int64_t repetitions, std::uint64_t seed);

}  // namespace zerocount::testing
