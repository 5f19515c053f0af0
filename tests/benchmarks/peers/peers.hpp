#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

/// A way to simulate trials with the integrator of another library, for one thread.
struct Peer {
  std::string name;
  /// Simulates a trial; this function is timed.
  std::function<trial::TrialOutcome(const trial::TrialParameters&)> run;
  /// Simulates a trial and returns all its samples.
  std::function<std::vector<trial::SampleRecord>(const trial::TrialParameters&)> record;
};

/// The engine that uses Boost.odeint.
/// @param tolerance largest local error of a step before the first breakaway, rad
Peer odeint_peer(double tolerance = 2.5e-13);

/// The other libraries that the program was built with, each with its best settings.
std::vector<Peer> all_peers();

}  // namespace zerocount::testing
