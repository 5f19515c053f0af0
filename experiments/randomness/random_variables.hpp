#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/distributions/distribution.hpp"
#include "experiments/randomness/random_coordinates.hpp"
#include "experiments/study/copula.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::randomness {

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
