#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/trial/trial.hpp"
#include "tests/core/batch/batched_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {

/// Agreement of a trial of the batch engine with the reference, for trials without a hook, which are not
/// divided into parts before and after a slide.
struct PathAgreement {
  bool parts{false};  ///< a count or a code differs from some sample on; later samples are not compared
  /// θ differs, but by then a reference with a slightly changed inertia already differs from the reference in
  /// a count or a code. Later samples are not compared.
  bool amplifies{false};
  /// Place and size of a difference of θ that rounding does not explain; empty if there is none.
  std::string astray{};
};

/// Compares θ of a trial with the reference. θ must agree to 1e-6 count plus 1e-9 of the travel, or to the
/// difference that a relative change of the inertia by 1e-12 makes in the reference, because a limit cycle
/// may amplify rounding to any size. If that change has already changed a count or a code, no agreement is
/// required.
PathAgreement path_agreement(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                             const BatchedTrial& reference);

/// Agreement of the trials of the batch engine with run_trial().
///
/// A trial slides if its hook slides in the reference. From then on rounding may grow until it decides a
/// count, and the two results differ. Therefore only the samples before the first slide, and the moves that
/// end before it, are compared.
struct BatchAgreement {
  std::int64_t trials{0};
  /// Number of trials that runs_in_lanes() accepts: the batch engine simulates them in SIMD lanes.
  std::int64_t in_lanes{0};
  std::int64_t slides{0};   ///< number of trials in which the contact slides
  std::int64_t samples{0};  ///< number of compared samples

  // Trials, each in one of these at most: by what is found first.
  /// Number of trials that differ because θ is within 1e-6 count of an encoder edge and is read differently.
  std::int64_t on_edge{0};
  std::int64_t other_counts{0};  ///< number of trials with another count or code of the converter
  /// Number of trials with another reversal_depth (number of remembered reversals), and no other difference.
  std::int64_t other_depth{0};
  /// Number of trials that differ only in reversal_depth, which also changes if the reference takes other
  /// steps (see reversal_depths.hpp).
  std::int64_t depth_by_steps{0};
  std::int64_t other_measures{0};  ///< number of trials with another discrete measure, or another jerk

  double theta{0.0};     ///< largest difference of the rotor angle θ before a slide, counts
  double floating{0.0};  ///< largest difference of the measures that are real numbers, counts

  /// Largest difference of reversal_depth in the first move of the trials counted in other_depth.
  std::int64_t depth_apart{0};

  // Of the trials that slide.
  std::int64_t part{0};  ///< number of trials whose counts or codes differ at some time after the slide
  /// Number of trials whose θ differs by more than the promised accuracy after the slide, before or when a
  /// count differs.
  std::int64_t stray{0};
  /// Largest difference of θ after the slide, in trials whose counts and codes stay equal, counts.
  double theta_after{0.0};
  /// Largest ratio of the difference of θ after the slide to the promised accuracy, 1e-3 count + 1e-7 of the
  /// travel.
  double ratio_after{0.0};
  std::vector<std::string>
      failures{};  ///< one line for each trial of other_counts to other_measures, or stray

  void add(const BatchAgreement& other);
  std::string figures() const;  ///< text with all numbers in one line
};

/// The agreement of one trial of the batch engine with the reference.
BatchAgreement compare_with_reference(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                                      const std::string& name);

/// The agreement of the batch engine with the reference on these trials, run as one batch.
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
  EXPECT_LT(agreement.ratio_after, 0.1);
  return agreement;
}

/// Expects that lanes run all of these trials, and that the batch engine agrees with the reference on them.
inline BatchAgreement expect_agreement_in_lanes(const std::vector<trial::TrialParameters>& trials,
                                                const std::string& name) {
  BatchAgreement agreement = expect_agreement(trials, name);
  EXPECT_EQ(agreement.in_lanes, agreement.trials);
  return agreement;
}

/// Expects that every trial gives the same bits as when it runs alone, with few and many lanes and with every
/// instruction set.
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
