// The machines of many candidates run together: each gets the results that it has alone, for any number of
// threads.
#include "runners/tuning/machine_runs/machine_runner.hpp"

#include <oneapi/tbb/task_arena.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::tuning {

bool operator==(const ClaimResult& a, const ClaimResult& b) {
  return a.moves == b.moves && a.met == b.met && a.values == b.values;
}

bool operator==(const MachineResult& a, const MachineResult& b) {
  return a.claims == b.claims && a.slid == b.slid;
}

}  // namespace zerocount::tuning

namespace zerocount::testing {
namespace {

using tuning::MachineResult;
using Results = std::vector<std::vector<MachineResult>>;

/// A study with two conditions.
/// @param section a further section of the manifest
study::Study study_with(double ki, const std::string& section) {
  const std::string text = fmt::format(R"(zerocount: 1
name: units
seed: 5
trials: 400
command: {{targets: [{{integers: [1, 9]}}], hold: 0.05}}
controller: {{ki: {}}}
{}
initial: {{encoder_phase: {{uniform: [0, 1]}}}}
verdict: {{dwell: 0.01, window: 0.01}}
conditions: {{light: {{}}, heavy: {{plant.inertia: 7.0e-4}}}}
goal: {{band: 1, within: 0.03, moves: 0.6}}
)",
                                       ki, section);
  return manifest::parse_study(text, "axis.yaml", {});
}

struct Entries {
  std::vector<study::Study> studies;
  std::vector<std::int64_t> from;
  std::vector<std::int64_t> to;
};

Entries random_entries(std::mt19937_64& random) {
  Entries entries;
  const auto number = [&](std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random);
  };
  for (std::int64_t i = number(1, 6); i > 0; --i) {
    const bool in_lanes = number(0, 3) > 0;
    entries.studies.push_back(
        study_with(1e-5 * static_cast<double>(number(1, 9)),
                   in_lanes ? "friction: {k1: {lognormal: {median: 120, cv: 0.3}}}"
                            : "disturbance: {vibration: [{amplitude: 1.0e-5, frequency: 1100, phase: 0}]}"));
    entries.from.push_back(number(0, 30));
    entries.to.push_back(entries.from.back() + number(0, 40));
  }
  return entries;
}

Results together(const Entries& of, int threads) {
  Results results(of.studies.size());
  std::vector<tuning::MachinesToRun> entries;
  for (std::size_t i = 0; i < results.size(); ++i)
    entries.push_back({&of.studies[i], of.from[i], of.to[i], &results[i], nullptr});
  const parallel::ThreadLimit limit(threads);
  oneapi::tbb::task_arena(threads).execute([&] { tuning::run_machines(entries, {200, 2}, {}); });
  return results;
}

TEST(UnitRunner, ResultsDoNotDependOnThreadsOrOtherCandidates) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 4; ++round) {
    const Entries entries = random_entries(random);
    const Results results = together(entries, 1);
    for (const int threads : {2, 5, 16}) EXPECT_TRUE(together(entries, threads) == results) << threads;
    for (std::size_t i = 0; i < results.size(); ++i) {
      std::vector<MachineResult> alone =
          tuning::results_of(entries.studies[i], {200, 2}, entries.to[i], nullptr, {});
      ASSERT_EQ(std::ssize(results[i]), entries.to[i]);
      for (std::int64_t machine = entries.from[i]; machine < entries.to[i]; ++machine) {
        const auto at = static_cast<std::size_t>(machine);
        ASSERT_TRUE(results[i][at] == alone[at]) << round << " " << i << " " << machine;
        EXPECT_EQ(alone[at].claims.size(), 2);
      }
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
