#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/distributions/distribution.hpp"
#include "experiments/randomness/random_coordinates.hpp"
#include "experiments/study/draws.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::randomness {

/// The factors: quantities drawn anew in each trial at some design point. These are all values with a
/// distribution, except those drawn once for the study, in the order of the table of parameters; and as the
/// last factor all random numbers that a trial uses while it runs, if any. A profile is not a factor: all
/// trials use the same rotor, and `initial.position` selects the position on it.
study::TrialFactors find_factors(const study::StudyPlan& plan);

/// The names of the factors: the dotted paths of the parameters, and within_trial_factor.
std::vector<std::string> factor_names(const study::StudyPlan& plan);

/// A random variable of a trial, in the unit of the manifest: as a random coordinate, but before it is made
/// standard normal and independent of the others.
struct RandomVariable {
  std::string name;  ///< of its coordinate
  std::string unit;
  distributions::Distribution distribution;  ///< of joint samples: their rows, from 0
  RandomCoordinate coordinate;
};

/// The random variables of the trials of a design point.
struct RandomVariables {
  std::vector<RandomVariable> variables;
  study::SquareMatrix correlations;  ///< of their normal scores: a Gaussian copula
};

RandomVariables random_variables(const study::Study& study, std::int64_t point);

/// The random numbers of a trial with these values. The trial has the point's distribution if the values have
/// that of the variables.
/// @param x [variable] @param number of the trial, for all random numbers beside the variables
/// @throws Failure (bad_input) for a value that its variable cannot have.
study::GivenDraws draws_with(const study::Study& study, const RandomVariables& variables,
                             std::span<const double> x, std::int64_t number);

}  // namespace zerocount::randomness
