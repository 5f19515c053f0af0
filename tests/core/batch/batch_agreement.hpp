#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"
#include "tests/core/batch/batched_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {

/// How a trial of the batch engine follows the reference, where no hook divides it into parts before and
/// after a slide.
struct PathAgreement {
  bool parts{false};      ///< a count or a code differs from some sample on; what follows is not compared
  bool amplifies{false};  ///< the reference parts from itself first, if it is changed; likewise
  std::string
      astray{};  ///< where θ differs by more than rounding explains, and by how much; empty if nowhere
};

/// θ agrees to 1e-6 count and 1e-9 of the travel, or to what a change of the inertia by 1e-12 makes of the
/// reference: a limit cycle may amplify rounding to any size. Where that change has changed a count or a code
/// before, no agreement can be asked for.
PathAgreement path_agreement(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                             const BatchedTrial& reference);

/// How the trials of the batch engine agree with run_trial.
///
/// A trial slides where the hook does in the reference. From there on rounding may grow until it decides a
/// count, and the two part: then what is compared are its samples before the first slide, and the moves that
/// end before it.
struct BatchAgreement {
  std::int64_t trials{0};
  std::int64_t in_lanes{0};  ///< of them, those that runs_in_lanes() accepts
  std::int64_t slides{0};    ///< of them, those that slide
  std::int64_t samples{0};   ///< compared

  // Trials, each in one of these at most: by what is found first.
  std::int64_t on_edge{0};       ///< θ on an encoder edge within 1e-6 count is read differently
  std::int64_t other_counts{0};  ///< another count or code
  std::int64_t other_depth{0};   ///< another reversal_depth, and nothing else
  /// The same, of a trial whose reversal_depth changes with the steps of the reference, too (see
  /// reversal_depths.hpp).
  std::int64_t depth_by_steps{0};
  std::int64_t other_measures{0};  ///< another discrete measure, or another jerk

  double theta{0.0};     ///< largest difference of θ before a slide, counts
  double floating{0.0};  ///< the same of the floating measures, counts

  std::int64_t depth_apart{
      0};  ///< largest difference of the reversal_depth of other_depth, in a trial's first move

  // Of the trials that slide.
  std::int64_t part{0};     ///< a count or a code of the two differs, some time after the slide
  std::int64_t stray{0};    ///< θ differs by more than promised after the slide, before or when a count does
  double theta_after{0.0};  ///< largest difference of θ after the slide in those that do not part, counts
  double share_after{0.0};  ///< the same over the accuracy promised there, 1e-3 count + 1e-7 of the travel
  std::vector<std::string> failures{};  ///< a line on each trial of other_counts to other_measures, or stray

  void add(const BatchAgreement& other);
  std::string figures() const;  ///< one line
};

/// One trial.
BatchAgreement compare_with_reference(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                                      const std::string& name);

/// All of them, run as one batch.
BatchAgreement agreement_of(const std::vector<trial::TrialParameters>& trials, const std::string& name,
                            const batch::BatchSettings& settings = {});

/// Expects that the batch engine agrees with the reference on these trials, and prints how well.
inline BatchAgreement expect_agreement(const std::vector<trial::TrialParameters>& trials,
                                       const std::string& name) {
  BatchAgreement agreement = agreement_of(trials, name);
  std::cout << name << ": " << agreement.figures() << "\n";
  for (const std::string& failure : agreement.failures) ADD_FAILURE() << failure;
  // What rounding may decide, and that it does so rarely.
  EXPECT_LE(agreement.on_edge, 1 + agreement.trials / 1000);
  EXPECT_LE(agreement.depth_by_steps, 1 + agreement.trials / 100);
  EXPECT_LE(agreement.part, 1 + agreement.slides / 20);
  EXPECT_LT(agreement.theta, 1e-7);
  EXPECT_LT(agreement.share_after, 0.1);
  return agreement;
}

/// The same of trials that lanes run.
inline BatchAgreement expect_agreement_in_lanes(const std::vector<trial::TrialParameters>& trials,
                                                const std::string& name) {
  BatchAgreement agreement = expect_agreement(trials, name);
  EXPECT_EQ(agreement.in_lanes, agreement.trials);
  return agreement;
}

/// Expects that trials come out as alone, to the last bit, in few lanes and many, by every instruction set.
inline void expect_independent(const std::vector<trial::TrialParameters>& trials) {
  std::vector<BatchedTrial> alone;
  for (const trial::TrialParameters& p : trials) alone.push_back(run_batch({p}, {.lanes = 1}).front());
  for (const batch::InstructionSet instructions : available_instruction_sets()) {
    for (const int lanes : {5, 128}) {
      const std::vector<BatchedTrial> few = run_batch(trials, {.lanes = lanes, .instructions = instructions});
      for (std::size_t i = 0; i < trials.size(); ++i)
        EXPECT_EQ(difference_in_bits(few[i], alone[i]), "") << i << " of " << lanes;
    }
  }
}

}  // namespace zerocount::testing
