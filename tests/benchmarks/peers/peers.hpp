#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"

namespace zerocount::testing {

/// A way of running trials by a library's integrator, for one thread.
struct Peer {
  std::string name;
  std::function<trial::TrialOutcome(const trial::TrialParameters&)> run;  ///< runs a trial; this is timed
  /// Runs a trial and returns all its samples.
  std::function<std::vector<trial::SampleRecord>(const trial::TrialParameters&)> record;
};

/// The engine that uses Boost.odeint.
/// @param tolerance largest local error of a step before the first breakaway, rad
Peer odeint_peer(double tolerance = 2.5e-13);

/// The peers whose libraries this was built with, each at its best settings.
std::vector<Peer> all_peers();

}  // namespace zerocount::testing
