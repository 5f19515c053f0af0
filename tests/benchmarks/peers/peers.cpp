#include "tests/benchmarks/peers/peers.hpp"

#include <memory>
#include <stdexcept>

#include "core/loop/controller.hpp"
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

Peer odeint_peer(const std::string& name, const OdeintSettings& settings) {
  const auto run = [settings](const trial::TrialParameters& p) {
    require_plain(p);
    OdeintPlant plant(p, settings);
    return peer_outcome(p, plant);
  };
  const auto record = [settings](const trial::TrialParameters& p) {
    require_plain(p);
    OdeintPlant plant(p, settings);
    return peer_records(p, plant);
  };
  return {name, run, record};
}

#ifdef ZEROCOUNT_HAS_CVODE
Peer cvode_peer(const std::string& name, const CvodeSettings& settings) {
  const auto memory = std::make_shared<CvodeMemory>(settings);
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
  return {name, run, record};
}
#endif

std::vector<Peer> all_peers() {
  std::vector<Peer> peers{odeint_peer("odeint", {})};
#ifdef ZEROCOUNT_HAS_CVODE
  peers.push_back(cvode_peer("cvode", {}));
#endif
  return peers;
}

std::vector<Peer> alternative_peers() {
  std::vector<Peer> peers{odeint_peer("odeint_tolerance_1e-13", {.tolerance = 1e-13}),
                          odeint_peer("odeint_tolerance_1e-12", {.tolerance = 1e-12}),
                          odeint_peer("odeint_rest_8e-14", {.rest = 8e-14}),
                          odeint_peer("odeint_longest_step_1", {.longest_step = 1.0}),
                          odeint_peer("odeint_longest_step_3", {.longest_step = 3.0}),
                          odeint_peer("odeint_ends_at_samples", {.pass_samples = false}),
                          odeint_peer("odeint_never_relaxed", {.after_breakaway = 1.0})};
#ifdef ZEROCOUNT_HAS_CVODE
  peers.push_back(cvode_peer("cvode_tolerance_1e-14", {.tolerance = 1e-14}));
  peers.push_back(cvode_peer("cvode_tolerance_1e-13", {.tolerance = 1e-13}));
  peers.push_back(cvode_peer("cvode_adams_newton", {.solver = CvodeSolver::newton}));
  peers.push_back(cvode_peer("cvode_bdf", {.method = CvodeMethod::bdf, .solver = CvodeSolver::newton}));
  peers.push_back(
      cvode_peer("cvode_bdf_tolerance_1e-14",
                 {.method = CvodeMethod::bdf, .solver = CvodeSolver::newton, .tolerance = 1e-14}));
  peers.push_back(cvode_peer("cvode_ends_at_samples", {.pass_samples = false}));
  peers.push_back(cvode_peer("cvode_never_relaxed", {.after_breakaway = 1.0}));
#endif
  return peers;
}

}  // namespace zerocount::testing
