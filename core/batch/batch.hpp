#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/batch/instruction_set.hpp"
#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::batch {

class LaneWork;

/// One sampling instant of a trial in a batch, as SampleRecord has it.
struct BatchSample {
  std::size_t trial{0};   ///< number in the batch
  std::int64_t k{0};      ///< sample number from the start of the trial
  std::int64_t count{0};  ///< fine encoder, counts
  std::int64_t code{0};   ///< DAC code
  double theta{0.0};      ///< rotor angle, rad
  double xp{0.0};         ///< plastic extension, rad
  double xh{0.0};         ///< hardening, rad
};

/// Who is told of the trials of a batch while they run; an empty function is not called. The trials run side
/// by side: what belongs to one comes in its order, what belongs to different ones in any.
struct BatchObservers {
  std::function<void(std::size_t trial, const trial::Jerk&)> jerk;  ///< at the end of every jerk
  std::function<void(const BatchSample&)> sample;                   ///< at every sampling instant
};

struct BatchSettings {
  int lanes{128};  ///< trials in work at the same time, 1 to 128
  InstructionSet instructions{widest_instruction_set()};
};

/// Whether the lanes can run such a trial. The others, which have imperfect encoders or converters, an
/// amplifier, two phases of control, a reference with a profile, torque levels, or a friction model without a
/// spring, go to run_trial.
bool runs_in_lanes(const trial::TrialParameters& parameters);

/// Runs trials as run_trial does, many at a time in the lanes of vectors (see core/batch/README.md).
///
/// What comes of a trial depends on its parameters alone: not on the trials beside it, nor on the settings.
/// It is that of run_trial to 3e-8 count as long as the hook sticks, with the same counts and codes.
class BatchEngine {
 public:
  explicit BatchEngine(const BatchSettings& settings = {});
  ~BatchEngine();
  BatchEngine(const BatchEngine&) = delete;
  BatchEngine& operator=(const BatchEngine&) = delete;
  BatchEngine(BatchEngine&&) = delete;
  BatchEngine& operator=(BatchEngine&&) = delete;

  /// @param trials not changed while this runs. @param outcomes [trial], overwritten.
  void run(std::span<const trial::TrialParameters* const> trials, std::span<trial::TrialOutcome> outcomes,
           const BatchObservers& observers = {});

 private:
  std::unique_ptr<LaneWork> work_;
};

}  // namespace zerocount::batch
