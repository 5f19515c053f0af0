#include "tests/analysis/pairs/comparison/synthetic_trials.hpp"

#include <cmath>
#include <limits>

namespace zerocount::testing {
namespace {

constexpr int quantities = 4;
constexpr double sample = 0.0005;  // s
constexpr double jerking = 0.2;    // proportion of the trials that jerk at all

std::vector<double> draw_trial(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform;
  std::vector<double> chances;
  while (std::ssize(chances) < quantities) chances.push_back(uniform(random));
  return chances;
}

}  // namespace

TrialChances draw_chances(std::mt19937_64& random, std::int64_t trials) {
  TrialChances chances;
  while (std::ssize(chances) < trials) chances.push_back(draw_trial(random));
  return chances;
}

TrialChances redraw_some(std::mt19937_64& random, const TrialChances& chances, double change) {
  std::bernoulli_distribution changes(change);
  TrialChances some = chances;
  for (std::vector<double>& trial : some) {
    if (changes(random)) trial = draw_trial(random);
  }
  return some;
}

comparison::PointTrials synthetic_trials(const SyntheticPoint& point, const TrialChances& chances) {
  comparison::PointTrials trials;
  trials.trials = std::ssize(chances);
  trials.moves = 1;
  for (const std::vector<double>& trial : chances) {
    const bool success = trial[0] < point.success;
    const bool arrived = trial[0] < point.success + 0.5 * (1.0 - point.success);
    trials.values["success_rate"].push_back(success);
    trials.values["arrival_rate"].push_back(arrived);
    trials.values["stable_rate"].push_back(arrived && trial[1] < 0.97);
    const double time = sample * std::round(-point.settling * std::log1p(-trial[2]) / sample);
    trials.values["arrival_time"].push_back(arrived ? time : std::numeric_limits<double>::quiet_NaN());
    const double rest = trial[3] / jerking;  // uniform among those that jerk
    trials.values["jerk_count"].push_back(rest < 1.0 ? std::ceil(-point.jerks / jerking * std::log1p(-rest))
                                                     : 0.0);
  }
  return trials;
}

}  // namespace zerocount::testing
