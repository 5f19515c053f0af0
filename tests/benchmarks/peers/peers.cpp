#include "tests/benchmarks/peers/peers.hpp"

#include <memory>
#include <stdexcept>

#include "core/loop/controller/controller.hpp"
#include "tests/benchmarks/peers/odeint_plant.hpp"
#include "tests/benchmarks/peers/peer_trial.hpp"
#ifdef ZEROCOUNT_HAS_CVODE
#include "tests/benchmarks/peers/cvode_plant.hpp"
#endif

namespace zerocount::testing {
namespace {

bool is_ideal(const loop::EncoderErrors& errors) {
  return errors.eccentricity == 0.0 && errors.interpolation == 0.0 && errors.noise == 0.0 &&
         errors.missed == 0.0;
}

#ifdef ZEROCOUNT_HAS_CVODE
Peer cvode_peer() {
  const auto memory = std::make_shared<CvodeMemory>();
  const auto run = [memory](const trial::TrialParameters& p) {
    require_plain(p);
    CvodePlant plant(p, *memory);
    return peer_outcome(p, plant);
  };
  const auto record = [memory](const trial::TrialParameters& p) {
    require_plain(p);
    CvodePlant plant(p, *memory);
    return peer_records(p, plant);
  };
  return {"cvode", run, record};
}
#endif

}  // namespace

void require_plain(const trial::TrialParameters& p) {
  const bool ideal_loop = is_ideal(p.encoder.fine_errors) && is_ideal(p.encoder.coarse_errors) &&
                          !loop::has_errors(p.dac) && p.amplifier.bandwidth == 0.0;
  const bool one_phase =
      !loop::has_coarse_phase(p.controller) && p.controller.encoder == loop::EncoderChoice::fine;
  const bool stepwise = p.command.torque.levels.empty() &&
                        p.command.profile.shape == loop::ReferenceShape::step && !p.verdict.stop;
  const bool stands =
      p.initial.velocity == 0.0 && p.initial.history.reversals == 0 && friction::has_spring(p.friction.model);
  if (ideal_loop && one_phase && stepwise && stands) return;
  throw std::invalid_argument(
      "the peers know only ideal encoders and converters, one control phase, stepwise "
      "targets, and a rotor that stands at the start on a pre-sliding contact");
}

Peer odeint_peer(double tolerance) {
  const auto run = [tolerance](const trial::TrialParameters& p) {
    require_plain(p);
    OdeintPlant plant(p, tolerance);
    return peer_outcome(p, plant);
  };
  const auto record = [tolerance](const trial::TrialParameters& p) {
    require_plain(p);
    OdeintPlant plant(p, tolerance);
    return peer_records(p, plant);
  };
  return {"odeint", run, record};
}

std::vector<Peer> all_peers() {
  std::vector<Peer> peers{odeint_peer()};
#ifdef ZEROCOUNT_HAS_CVODE
  peers.push_back(cvode_peer());
#endif
  return peers;
}

}  // namespace zerocount::testing
