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

/// Processor instruction sets for which the batch engine's inner loops (kernels) are compiled. The results of
/// all three are bitwise equal.
enum class InstructionSet { portable, avx2, avx512 };

/// Whether this processor has the instruction set and the program contains kernels compiled for it.
bool is_available(InstructionSet instructions);

/// The instruction set with the widest vectors that is_available() on this processor.
InstructionSet widest_instruction_set();

std::string_view name_of(InstructionSet instructions);

/// State of one trial of the batch at one sampling instant; a subset of trial::SampleRecord.
struct BatchSample {
  std::size_t trial{0};   ///< Index of the trial in the batch.
  std::int64_t k{0};      ///< Number of the sample, counted from 0 at the start of the trial
  std::int64_t count{0};  ///< Reading of the fine encoder, counts
  std::int64_t code{0};   ///< Code that the controller sends to the digital-to-analogue converter
  double theta{0.0};      ///< Rotor angle, rad
  double xp{0.0};         ///< Plastic extension xp of the contact by creep, rad
  double xh{0.0};         ///< Hardening xh of the contact by creep, rad
};

/// Callbacks while a batch runs; an empty function is not called. Calls for one trial come in order of time,
/// interleaved with those for other trials.
struct BatchObservers {
  /// Called at the end of every jerk, an excursion of the error from zero after arrival.
  std::function<void(std::size_t trial, const trial::Jerk&)> jerk;
  /// Called at every sampling instant of every trial.
  std::function<void(const BatchSample&)> sample;
  std::stop_token stop{};  ///< Stops the batch when a stop is requested: run() then throws
                           /// < trial::Interrupted.
};

/// Function that returns the parameters of the trial with index `trial` when the batch engine starts to run
/// it. The returned parameters must stay unchanged until the next call with the same `slot`, a number below
/// BatchSettings::lanes.
using TrialSource = std::function<const trial::TrialParameters&(std::size_t trial, std::size_t slot)>;

struct BatchSettings {
  int lanes{128};  ///< Number of trials that are run side by side, 1 to 128
  InstructionSet instructions{widest_instruction_set()};
};

/// The features of a trial that the vectorised engine does not support, as noun phrases for a message; empty
/// if it supports all of them. The engine runs unsupported trials one by one with run_trial().
std::vector<std::string> lacking_in_lanes(const trial::TrialParameters& parameters);

/// Whether the vectorised engine supports all features of this trial (see lacking_in_lanes()). Otherwise it
/// runs the trial with run_trial().
bool runs_in_lanes(const trial::TrialParameters& parameters);

/// Runs trials as run_trial does, many at a time in the lanes of vectors (see core/batch/README.md).
///
/// The outcome of a trial depends on its parameters alone, neither on the other trials nor on the settings.
/// While the friction contact sticks, counts and codes equal those of run_trial, and θ differs by less than
/// 1e-7 count.
class BatchEngine {
 public:
  explicit BatchEngine(const BatchSettings& settings = {});
  ~BatchEngine();
  BatchEngine(const BatchEngine&) = delete;
  BatchEngine& operator=(const BatchEngine&) = delete;
  BatchEngine(BatchEngine&&) = delete;
  BatchEngine& operator=(BatchEngine&&) = delete;

  /// Runs the trials 0 to outcomes.size() − 1 and stores their outcomes.
  /// @param source returns the parameters of a trial; called once for each trial, in order.
  /// @param outcomes [trial], overwritten.
  /// @throws trial::Interrupted if a stop is requested before the last trial ends. The outcomes of the trials
  /// that have ended are then complete, and the other outcomes have no moves.
  void run(const TrialSource& source, std::span<trial::TrialOutcome> outcomes,
           const BatchObservers& observers = {});
  /// Runs these trials and stores their outcomes.
  /// @param trials parameters of the trials; they must not change during the run.
  /// @param outcomes [trial], overwritten.
  void run(std::span<const trial::TrialParameters* const> trials, std::span<trial::TrialOutcome> outcomes,
           const BatchObservers& observers = {});

  /// Number of rounds of the last run. In each round every lane (a slot that runs one trial) takes at most
  /// one sample and one integration step. With one lane, the rounds measure the work: the steps of its
  /// trials, plus the samples that no step passes over.
  std::int64_t rounds() const;

 private:
  std::unique_ptr<RunningBatch> running_;
};

}  // namespace zerocount::batch
