#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"
#include "tests/benchmarks/peers/odeint_plant.hpp"
#ifdef ZEROCOUNT_HAS_CVODE
#include "tests/benchmarks/peers/cvode_memory.hpp"
#endif

namespace zerocount::testing {

/// A way of running trials by a library's integrator, for one thread.
struct Peer {
  std::string name;
  std::function<trial::TrialOutcome(const trial::TrialParameters&)> run;  ///< what is timed
  std::function<std::vector<trial::SampleRecord>(const trial::TrialParameters&)>
      record;  ///< the same with all samples
};

Peer odeint_peer(const std::string& name, const OdeintSettings& settings);
#ifdef ZEROCOUNT_HAS_CVODE
Peer cvode_peer(const std::string& name, const CvodeSettings& settings);
#endif

/// The peers whose libraries this was built with, each at its best settings.
std::vector<Peer> all_peers();

/// Other settings of the same libraries: what all_peers() was chosen from.
std::vector<Peer> alternative_peers();

}  // namespace zerocount::testing
