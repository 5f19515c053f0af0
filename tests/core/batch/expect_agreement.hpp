#pragma once

#include "tests/core/batch/batch_agreement.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {

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
