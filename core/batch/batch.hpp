#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/outcome.hpp"
#include "core/trial/parameters.hpp"

namespace zerocount::batch {

struct RunningBatch;

/// Instruction sets of the kernels of the batch engine. All give the same results.
enum class InstructionSet { portable, avx2, avx512 };

/// Whether this processor has the instruction set and the kernels were built for it.
bool is_available(InstructionSet instructions);

/// The widest available instruction set.
InstructionSet widest_instruction_set();

std::string_view name_of(InstructionSet instructions);

/// One sampling instant of a trial in a batch, as SampleRecord has it.
struct BatchSample {
  std::size_t trial{0};   ///< Index of the trial in the batch.
  std::int64_t k{0};      ///< Sample number from the start of the trial
  std::int64_t count{0};  ///< Fine encoder, counts
  std::int64_t code{0};   ///< DAC code
  double theta{0.0};      ///< Rotor angle, rad
  double xp{0.0};         ///< Plastic extension, rad
  double xh{0.0};         ///< hardening, rad
};

/// Callbacks while a batch runs; an empty function is not called. Calls for one trial come in order of time,
/// interleaved with those for other trials.
struct BatchObservers {
  std::function<void(std::size_t trial, const trial::Jerk&)> jerk;  ///< Called at the end of every jerk
  std::function<void(const BatchSample&)> sample;                   ///< Called at every sampling instant
  std::stop_token stop{};  ///< A request to stop ends the batch by trial::Interrupted.
};

/// Gives the parameters of a trial of a batch when a lane begins it. They stay as they are until the next
/// call with the same `slot`, a number below BatchSettings::lanes.
using TrialSource = std::function<const trial::TrialParameters&(std::size_t trial, std::size_t slot)>;

struct BatchSettings {
  int lanes{128};  ///< Trials in work at the same time, 1 to 128
  InstructionSet instructions{widest_instruction_set()};
};

/// The features of a trial that lanes lack, as noun phrases; empty if lanes run the trial. The engine runs
/// such trials by run_trial.
std::vector<std::string> lacking_in_lanes(const trial::TrialParameters& parameters);

/// Whether the lanes run such a trial.
bool runs_in_lanes(const trial::TrialParameters& parameters);

/// Runs trials as run_trial does, many at a time in the lanes of vectors (see core/batch/README.md).
///
/// The outcome of a trial depends on its parameters alone, neither on the other trials nor on the settings.
/// While the hook sticks, counts and codes equal those of run_trial, and θ differs by less than 1e-7 count.
class BatchEngine {
 public:
  explicit BatchEngine(const BatchSettings& settings = {});
  ~BatchEngine();
  BatchEngine(const BatchEngine&) = delete;
  BatchEngine& operator=(const BatchEngine&) = delete;
  BatchEngine(BatchEngine&&) = delete;
  BatchEngine& operator=(BatchEngine&&) = delete;

  /// @param source called once for each trial, in order. @param outcomes [trial], overwritten.
  /// @throws trial::Interrupted if a stop is requested before the last trial ends. Then the outcomes of the
  /// trials that have ended are complete, and the others have no moves.
  void run(const TrialSource& source, std::span<trial::TrialOutcome> outcomes,
           const BatchObservers& observers = {});
  /// Runs these trials. @param trials must not change during the run.
  void run(std::span<const trial::TrialParameters* const> trials, std::span<trial::TrialOutcome> outcomes,
           const BatchObservers& observers = {});

  /// Number of rounds of the last run. With one lane, rounds measure the work: steps of its trials, and
  /// samples that no step passes over.
  std::int64_t rounds() const;

 private:
  std::unique_ptr<RunningBatch> running_;
};

}  // namespace zerocount::batch
