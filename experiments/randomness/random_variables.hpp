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

/// The factors whose Sobol' indices can be estimated: quantities drawn anew in each trial at some design
/// point. These are all values with a distribution, except those drawn once for the study, in the order of
/// the table of parameters; and as the last factor all random numbers that a trial uses while it runs, if
/// any. A profile is not a factor: all trials use the same rotor, and `initial.position` selects the position
/// on it.
study::TrialFactors find_factors(const study::StudyPlan& plan);

/// The names of the factors (quantities drawn anew in each trial): the dotted paths of the parameters, then
/// within_trial_factor if the random numbers used while a trial runs are a factor.
std::vector<std::string> factor_names(const study::StudyPlan& plan);

/// A random variable of a trial, in the unit of the manifest. Unlike a random coordinate, it has the
/// distribution of the manifest and may be correlated with others.
struct RandomVariable {
  std::string name;  ///< name of the random coordinate that draws the variable (RandomCoordinate::name)
  std::string unit;
  /// Distribution of the values; for joint samples: uniform on the row indices, from 0.
  distributions::Distribution distribution;
  RandomCoordinate coordinate;
};

/// The random variables of the trials of a design point.
struct RandomVariables {
  std::vector<RandomVariable> variables;
  /// [variable][variable] correlations of the variables' normal scores (Gaussian copula).
  study::SquareMatrix correlations;
};

RandomVariables random_variables(const study::Study& study, std::int64_t point);

/// The random numbers that make a trial have the given values. The trial has the distribution of the point if
/// the values have the joint distribution of the variables.
/// @param x [variable] value
/// @param number draw that supplies all other random numbers
/// @throws Failure (bad_input) for a value that its variable cannot have
study::GivenDraws draws_with(const study::Study& study, const RandomVariables& variables,
                             std::span<const double> x, std::int64_t number);

}  // namespace zerocount::randomness
