#include <cstdlib>

#include <fmt/core.h>

#include "tests/analysis/basis/statistics/coverage_simulation.hpp"

/// Prints how often every bound of a summary covers the true value, and beside it how often bounds for
/// independent trials and moves do.
/// usage: statistics_coverage [REPETITIONS]
int main(int count, char** words) {
  using namespace zerocount::testing;
  const std::int64_t repetitions = count > 1 ? std::atoll(words[1]) : 500;
  const auto print = [&](const char* name, const Population& population, const Sample& sample) {
    fmt::print("{}, {} trials of {} moves\n", name, sample.trials, sample.moves);
    for (const Coverage& one : coverage_of(population, sample, repetitions, 20021)) {
      const auto percent = [&](std::int64_t covered) {
        return 100.0 * static_cast<double>(covered) / static_cast<double>(one.repetitions);
      };
      fmt::print("  {:<22}{:6.1f} %", one.bound, percent(one.covered));
      if (one.plainly >= 0) fmt::print("   as if independent {:6.1f} %", percent(one.plainly));
      fmt::print("\n");
    }
  };
  for (const std::int64_t moves : {1, 10}) {
    for (const double sd : {0.0, 0.1, 0.3}) {
      Population population{.success_mean = sd < 0.2 ? 0.9 : 0.7, .success_sd = sd};
      population.machine_effect = 2.0 * sd;
      population.trial_effect = 0.4;
      population.jerk_sd = 3.0 * sd;
      print(fmt::format("100 machines, standard deviation {} between them", sd).c_str(), population,
            {.machines = 100, .trials = 2000, .moves = moves});
    }
    print("no machines, trials differ", {.success_mean = 0.9, .trial_effect = 0.8},
          {.trials = 200, .moves = moves});
    print("no machines, few jerks", {.success_mean = 0.99, .trial_effect = 0.3, .jerks = 0.01},
          {.trials = 200, .moves = moves});
  }
  for (const std::int64_t machines : {20, 100}) {
    print(fmt::format("{} machines, 90 % without a failure, the others at 0.7", machines).c_str(),
          {.weak_machines = 0.1, .weak_success = 0.7},
          {.machines = machines, .trials = 20 * machines, .moves = 1});
    print(fmt::format("{} machines, standard deviation 0.1 between them, mean 0.97", machines).c_str(),
          {.success_mean = 0.97, .success_sd = 0.1},
          {.machines = machines, .trials = 20 * machines, .moves = 1});
  }
  return 0;
}
