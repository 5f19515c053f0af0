// Prints a hash of the bits of random trials of every kind, by both engines: the same on every processor.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"
#include "tests/support/random_trials.hpp"

namespace zerocount::testing {
namespace {

constexpr std::uint64_t trials_of_a_kind = 20;

constexpr std::pair<TrialKind, const char*> kinds[] = {
    {TrialKind::calm, "calm"},
    {TrialKind::ringing, "ringing"},
    {TrialKind::breaking_away, "breaking away"},
    {TrialKind::unlike_the_paper, "unlike the paper"},
    {TrialKind::spring_alone, "spring alone"},
    {TrialKind::coulomb, "coulomb"},
    {TrialKind::amplified, "amplified"},
    {TrialKind::arriving, "arriving"},
    {TrialKind::remembering, "remembering"},
    {TrialKind::loaded, "loaded"},
};

/// A hash of the bits of results: FNV-1a (Fowler, Noll, Vo) over words of 64 bits.
class BitHash {
 public:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3; }
  /// Adds a number. All NaNs count as equal, because processors differ in the sign of the NaN that they make.
  void add(double number) {
    add(std::isnan(number) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(number));
  }
  void add(std::int64_t number) { add(static_cast<std::uint64_t>(number)); }

  void add(const trial::MoveOutcome& move) {
    add(static_cast<std::int64_t>(move.outcome));
    for (const double measure : {move.arrival_time, move.zero_fraction, move.oscillation_period,
                                 move.true_error, move.final_position, move.holding_torque, move.peak_torque,
                                 move.creep, move.rest_error_rms, move.rest_torque_noise, move.step_motion}) {
      add(measure);
    }
    for (const std::int64_t measure : {move.arrival, move.overshoot, move.reversal_depth, move.jerk_count})
      add(measure);
  }
  void add(const trial::TrialOutcome& outcome) {
    for (const trial::MoveOutcome& move : outcome.moves) add(move);
  }
  /// Adds one sample of a trial, of the batch engine or of the reference.
  void add_sample(std::int64_t count, std::int64_t code, double theta, double xp, double xh) {
    add(count);
    add(code);
    for (const double coordinate : {theta, xp, xh}) add(coordinate);
  }

  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_{0xcbf29ce484222325};
};

std::uint64_t of_reference(const std::vector<trial::TrialParameters>& trials) {
  BitHash hash;
  for (const trial::TrialParameters& parameters : trials) {
    trial::TrialObservers observers;
    observers.sample = [&](const trial::SampleRecord& s) {
      hash.add_sample(s.count, s.code, s.theta, s.xp, s.xh);
    };
    hash.add(trial::run_trial(parameters, observers));
  }
  return hash.value();
}

std::uint64_t of_lanes(const std::vector<trial::TrialParameters>& trials) {
  std::vector<const trial::TrialParameters*> pointers;
  for (const trial::TrialParameters& parameters : trials) pointers.push_back(&parameters);
  std::vector<BitHash> hashes(trials.size());  // samples of different trials come interleaved
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  batch::BatchObservers observers;
  observers.sample = [&](const batch::BatchSample& s) {
    hashes[s.trial].add_sample(s.count, s.code, s.theta, s.xp, s.xh);
  };
  batch::BatchEngine().run(pointers, outcomes, observers);
  BitHash hash;
  for (std::size_t trial = 0; trial < trials.size(); ++trial) {
    hash.add(hashes[trial].value());
    hash.add(outcomes[trial]);
  }
  return hash.value();
}

}  // namespace
}  // namespace zerocount::testing

int main() {
  using namespace zerocount::testing;
  for (const auto& [kind, name] : kinds) {
    std::vector<zerocount::trial::TrialParameters> trials;
    for (std::uint64_t index = 0; index < trials_of_a_kind; ++index)
      trials.push_back(random_trial(kind, index));
    std::printf("%-16s  reference %016llx  lanes %016llx\n", name,
                static_cast<unsigned long long>(of_reference(trials)),
                static_cast<unsigned long long>(of_lanes(trials)));
  }
}
