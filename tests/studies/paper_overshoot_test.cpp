// What docs/the-paper.md says of the overshoot in paper-fig7 and paper-fig8: the simulated moves reach beyond
// the axes of the figures, and with a k1 of 150 N m/rad they do not.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/studies/shipped_study.hpp"

namespace zerocount::testing {
namespace {

/// Highest counts that the 200 trials of a move reach.
struct Peaks {
  double median{0.0};
  std::int64_t max{0};
};

Peaks peaks(const study::Study& study, const std::string& label) {
  std::vector<std::int64_t> highest;
  const std::int64_t target = trial_of(study, label, 0).command.targets.back();
  for (const trial::TrialOutcome& trial : outcomes_of(study, label, study.trials))
    highest.push_back(target + trial.moves.back().overshoot);
  std::sort(highest.begin(), highest.end());
  const std::size_t half = highest.size() / 2;
  return {0.5 * static_cast<double>(highest[half - 1] + highest[half]), highest.back()};
}

/// Of the move of 10 counts in paper-fig7, whose axis ends at 12 counts.
Peaks peaks_of_fig7(const std::vector<std::string>& settings) {
  return peaks(shipped_study("paper-fig7", settings), "command.targets.0=10");
}

/// Of the move of 30 counts in paper-fig8, whose axis ends at 40 counts. Its jerks, which come later, are of
/// one count and do not reach beyond the first swing.
Peaks peaks_of_fig8(std::vector<std::string> settings) {
  settings.insert(settings.end(), {"command.hold=0.3", "retain={}"});
  return peaks(shipped_study("paper-fig8", settings), "all");
}

void expect_peaks(const Peaks& found, double median, std::int64_t max) {
  EXPECT_EQ(found.median, median);
  EXPECT_EQ(found.max, max);
}

TEST(PaperOvershoot, MovesReachBeyondTheAxesOfTheFigures) {
  expect_peaks(peaks_of_fig7({}), 13.0, 15);
  expect_peaks(peaks_of_fig8({}), 47.0, 53);
}

TEST(PaperOvershoot, WithAStifferContactAllMovesFitTheAxes) {
  expect_peaks(peaks_of_fig7({"friction.k1=150"}), 11.0, 11);
  expect_peaks(peaks_of_fig8({"friction.k1=150"}), 38.0, 39);
}

TEST(PaperOvershoot, WithASpringThatSoftensLaterOnlyTheShortMovesFit) {
  expect_peaks(peaks_of_fig7({"friction.beta=5e4"}), 11.0, 12);
  expect_peaks(peaks_of_fig8({"friction.beta=5e4"}), 43.0, 49);
}

}  // namespace
}  // namespace zerocount::testing
