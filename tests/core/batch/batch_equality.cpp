// How the batch engine agrees with the reference, over many trials of a study, on all cores.
//
// usage: batch_equality MANIFEST TRIALS [FIRST] [POINT]
//   TRIALS, FIRST, POINT  so many trials of this design point, from this one on (default 0, 0); where the
//                         manifest has fewer, as if it had enough
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/core/batch/batch_agreement.hpp"

namespace {

using namespace zerocount;
using namespace zerocount::testing;

/// Samples that a batch keeps until they are compared.
constexpr double max_samples = 1e6;

BatchAgreement agreement_over(const study::Study& study, std::int64_t point, std::int64_t first,
                              std::int64_t trials) {
  const double per_trial =
      static_cast<double>(trial::samples_of_trial(study::study_trial(study, point, first).parameters));
  const auto block = std::clamp(static_cast<std::int64_t>(max_samples / per_trial), std::int64_t{1}, trials);
  std::atomic<std::int64_t> next{first};
  std::mutex adding;
  BatchAgreement agreement;
  const auto work = [&] {
    for (;;) {
      const std::int64_t from = next.fetch_add(block);
      if (from >= first + trials) return;
      std::vector<trial::TrialParameters> some;
      for (std::int64_t i = from; i < std::min(from + block, first + trials); ++i)
        some.push_back(study::study_trial(study, point, i).parameters);
      const BatchAgreement part = agreement_of(some, fmt::format("of {} on, trial", from));
      const std::lock_guard lock(adding);
      agreement.add(part);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return agreement;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    fmt::print(stderr, "usage: {} MANIFEST TRIALS [FIRST] [POINT]\n", words[0]);
    return 2;
  }
  const std::int64_t trials = std::atoll(words[2]);
  const std::int64_t first = count > 3 ? std::atoll(words[3]) : 0;
  const std::int64_t point = count > 4 ? std::atoll(words[4]) : 0;
  try {
    const study::Study study = manifest::load_study(words[1], {fmt::format("trials={}", first + trials)});
    const BatchAgreement agreement = agreement_over(study, point, first, trials);
    constexpr std::size_t max_shown = 20;
    for (std::size_t i = 0; i < std::min(max_shown, agreement.failures.size()); ++i)
      fmt::print(stderr, "{}\n", agreement.failures[i]);
    fmt::print("{}: {}\n", study.name, agreement.figures());
    return agreement.failures.empty() ? 0 : 1;
  } catch (const Failure& failure) {
    fmt::print(stderr, "{}\n", failure.what());
    return 2;
  }
}
