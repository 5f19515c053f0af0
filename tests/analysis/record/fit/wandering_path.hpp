#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "analysis/record/fit/record.hpp"

namespace zerocount::testing {

/// A random path of `samples` angles that wanders up and down by up to `most` counts per sample.
inline Eigen::VectorXd wandering_path(Eigen::Index samples, double most, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double period = 200.0 * (1.0 + uniform(random));
  const double start = 2.0 * std::numbers::pi * uniform(random);
  Eigen::VectorXd path(samples);
  double at = uniform(random);
  for (Eigen::Index k = 0; k < samples; ++k) {
    path[k] = at;
    at += most * std::sin(start + static_cast<double>(k) / period);
  }
  return path;
}

/// The counts of an encoder with noise (standard deviation in counts) along a path.
inline Eigen::VectorXd read(const Eigen::VectorXd& path, double noise, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return path.unaryExpr([&](double at) { return std::floor(at + noise * normal(random)); });
}

inline fit::TestRecord counted() {
  fit::TestRecord record;
  record.counted = true;
  return record;
}

}  // namespace zerocount::testing
