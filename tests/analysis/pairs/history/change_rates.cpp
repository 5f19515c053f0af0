// Prints how often a history shows changes that are none, and how soon those that are: the tables of
// analysis/pairs/history/README.md.
#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "tests/analysis/pairs/history/change_simulation.hpp"

namespace zerocount::testing {
namespace {

constexpr int nights = 100;

void print_false_alarms(int histories) {
  const auto constant = [](double level) { return [level](int) { return level; }; };
  fmt::print("false alarms in {} nights, % of {} histories (a tenth of them of 30 series)\n", nights,
             histories);
  const auto print = [&](const std::string& name, const SimulatedSeries& series) {
    fmt::print("{:<42}", name);
    for (const int count : {1, 5, 30}) {
      const int tried = count == 30 ? std::max(1000, histories / 10) : histories;
      fmt::print(" {:>3} series {:5.2f}", count, 100.0 * alarms(series, count, tried, 1) / tried);
    }
    fmt::print("\n");
  };
  print("means, normal", normal_series(nights, constant(0.0)));
  print("means of 200 exponential values", exponential_series(nights, 200));
  for (const double p : {0.5, 0.85, 0.98, 0.999})
    print(fmt::format("{} % of 200 trials", 100.0 * p), binomial_series(nights, 200, constant(p)));
  print("the same draws 5 nights at a time", normal_series(nights, constant(0.0), 5));
}

void print_power(int histories) {
  fmt::print("changes found within 100 nights after 30 without one, one of 30 series\n");
  const int change = 30;
  for (const double step : {0.5, 1.0, 2.0, 3.0}) {
    const auto level = [=](int night) { return night < change ? 0.0 : step; };
    const FoundChanges found = found_changes(normal_series(change + 100, level), change, 30, histories, 2);
    fmt::print("step of {} standard errors: {:5.1f} %, median after {:.0f} nights\n", step,
               100.0 * found.found, found.median_delay + 1.0);
  }
  for (const double slope : {0.02, 0.05, 0.1, 0.2}) {
    const auto level = [=](int night) { return slope * std::max(0, night - change + 1); };
    const FoundChanges found = found_changes(normal_series(change + 100, level), change, 30, histories, 3);
    fmt::print("drift of {} standard errors a night: {:5.1f} %, median after {:.0f} nights\n", slope,
               100.0 * found.found, found.median_delay + 1.0);
  }
}

}  // namespace
}  // namespace zerocount::testing

int main(int count, char** words) {
  const int histories = count > 1 ? std::atoi(words[1]) : 2000;
  zerocount::testing::print_false_alarms(histories);
  zerocount::testing::print_power(histories);
}
