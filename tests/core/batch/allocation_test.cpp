// The lanes do not allocate while they run.
#include "core/batch/batch.hpp"
#include "tests/core/batch/allocation_count.hpp"
#include "tests/core/batch/bench_trials.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

class BatchAllocation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!allocations_are_counted()) GTEST_SKIP() << "the sanitizer has its own malloc";
  }
};

/// Trials to be run as one batch, with memory for their outcomes.
struct Batch {
  explicit Batch(std::vector<trial::TrialParameters> all) : trials(std::move(all)), outcomes(trials.size()) {
    for (const trial::TrialParameters& trial : trials) pointers.push_back(&trial);
  }

  std::vector<trial::TrialParameters> trials;
  std::vector<trial::TrialOutcome> outcomes;
  std::vector<const trial::TrialParameters*> pointers;
};

/// Number of memory allocations in a run of the batch.
std::int64_t allocations_in(batch::BatchEngine& engine, Batch& batch,
                            const batch::BatchObservers& observers = {}) {
  const std::int64_t before = allocations_so_far();
  engine.run(batch.pointers, batch.outcomes, observers);
  return allocations_so_far() - before;
}

std::string hold_of(double samples) {
  return "command.hold=" + std::to_string(samples / 2000.0);
}

/// Each lane needs memory for the rises of the count in the last half of a move, once (see LastHalf).
const std::int64_t lanes = batch::BatchSettings{}.lanes;

TEST_F(BatchAllocation, IsDetectedByTheCounter) {
  const std::int64_t before = allocations_so_far();
  std::vector<int> numbers(100);
  EXPECT_EQ(allocations_so_far() - before, 1) << numbers.size();
}

TEST_F(BatchAllocation, DoesNotHappenOnceTheOutcomesAreAllocated) {
  for (const char* name : {"bench-transient", "bench-marginal", "bench-creep"}) {
    Batch batch(bench_trials(name, 0, 400, {hold_of(600)}));
    batch::BatchEngine engine;
    const std::int64_t first = allocations_in(engine, batch);
    const std::int64_t second = allocations_in(engine, batch);
    std::cout << name << ": " << first << " allocations in the first run of 400 trials, " << second
              << " in the second\n";
    EXPECT_EQ(second, 0) << name;
  }
}

TEST_F(BatchAllocation, HappensOncePerTrialIfItsOutcomeIsNotAllocated) {
  Batch warm(bench_trials("bench-transient", 0, 400));
  batch::BatchEngine engine;
  allocations_in(engine, warm);
  Batch fresh(bench_trials("bench-transient", 400, 1000));
  EXPECT_LE(allocations_in(engine, fresh), 1000 + lanes);
}

/// Number of trials of the batch whose springs remember more reversals than fit into the fixed memory of a
/// spring.
std::int64_t long_memories(const Batch& batch) {
  std::int64_t trials = 0;
  for (const trial::TrialOutcome& outcome : batch.outcomes)
    trials += outcome.moves.front().reversal_depth > 48;
  return trials;
}

TEST_F(BatchAllocation, DoesNotGrowWithTheNumberOfSamplesButForLongMemories) {
  for (const char* name : {"bench-transient", "bench-creep"}) {
    for (const double samples : {300.0, 1200.0, 4800.0}) {
      Batch batch(bench_trials(name, 0, 300, {hold_of(samples)}));
      batch::BatchEngine engine;
      const std::int64_t allocations = allocations_in(engine, batch);
      std::cout << name << ", " << samples << " samples: " << allocations << " allocations in 300 trials, "
                << long_memories(batch) << " of them with long memories\n";
      EXPECT_LE(allocations, 300 + lanes + 2 * long_memories(batch));
    }
  }
}

TEST_F(BatchAllocation, DoesNotComeWithTheJerks) {
  Batch batch(bench_trials("bench-creep", 0, 50));
  batch::BatchEngine engine;
  std::int64_t jerks = 0;
  batch::BatchObservers observers;
  observers.jerk = [&jerks](std::size_t, const trial::Jerk&) { ++jerks; };
  allocations_in(engine, batch, observers);
  EXPECT_EQ(allocations_in(engine, batch, observers), 0);
  EXPECT_GT(jerks, 100);
}

TEST_F(BatchAllocation, HappensLessThanOncePerObservedSample) {
  Batch batch(bench_trials("bench-creep", 0, 50));
  batch::BatchEngine engine;
  std::int64_t samples = 0;
  batch::BatchObservers observers;
  observers.sample = [&samples](const batch::BatchSample&) { ++samples; };
  allocations_in(engine, batch, observers);
  samples = 0;
  const std::int64_t allocations = allocations_in(engine, batch, observers);
  std::cout << allocations << " allocations with " << samples << " samples observed\n";
  EXPECT_LT(allocations, samples / 20);
}

}  // namespace
}  // namespace zerocount::testing
