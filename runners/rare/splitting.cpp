#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/numerics/elementary_functions.hpp"
#include "runners/rare/estimator.hpp"

namespace zerocount::rare {
namespace {

constexpr std::size_t particles_of_level = 600;
constexpr int steps_of_level = 3;  // of the Markov chain between two levels
constexpr double kept_proportion = 0.2;
constexpr double enough_failures = 0.2;  // of the trials of a level
constexpr double min_failures = 10;      // from which copies are made
constexpr double max_proportion = 0.6;   // of trials above a level: otherwise it is no progress
constexpr double wanted_acceptance = 0.35;
constexpr double redrawn_proportion = 0.2;  // of the steps of an unordered coordinate
constexpr double failed_score = std::numeric_limits<double>::infinity();

class Splitting {
 public:
  Splitting(const SplittingSettings& settings, const TrialSpace& space, const Simulation& simulate,
            NumberSource& numbers)
      : settings_(settings),
        space_(space),
        simulate_(simulate),
        numbers_(numbers),
        number_(settings.first_number) {
    result_.search.score = settings.score;
  }

  SplittingResult run(const std::function<bool()>& go_on) {
    ScoreSearch& search = result_.search;
    if (!go_on()) return std::move(result_);
    for (std::size_t i = 0; i < particles_of_level; ++i)
      particles_.push_back({numbers_.normals(space_.coordinates), number_++});
    run_trials(particles_);
    result_.plain = particles_;
    double level = -failed_score;
    while (proportion_from(failed_score) < enough_failures) {
      const double next = next_level(level);
      if (next == failed_score &&
          proportion_from(failed_score) * static_cast<double>(particles_.size()) >= min_failures)
        break;
      if (!(next > level) || next == failed_score || search.probability < settings_.least || !go_on())
        return std::move(result_);
      level = next;
      climb(level);
      result_.above.push_back(particles_);
      ++search.levels;
    }
    if (!go_on()) return std::move(result_);
    climb(failed_score);
    search.reached = true;
    result_.failing = std::move(particles_);
    return std::move(result_);
  }

 private:
  /// Score of a trial that was run, for splitting: the largest possible value for a failure, the lowest for
  /// an unknown score.
  double score_of(const Trial& trial) const {
    if (trial.failed > 0.0) return failed_score;
    const double score = trial.scores[settings_.score];
    return std::isnan(score) ? -failed_score : score;
  }

  void run_trials(std::vector<Trial>& trials) {
    simulate_(trials);
    result_.search.trials += std::ssize(trials);
  }

  double proportion_from(double level) const {
    const auto above =
        std::ranges::count_if(particles_, [&](const Trial& particle) { return score_of(particle) >= level; });
    return static_cast<double>(above) / static_cast<double>(particles_.size());
  }

  /// Next level of splitting: the score that a fifth of the particles (trials) reach. If too many particles
  /// have exactly this score, the next larger score.
  double next_level(double level) const {
    std::vector<double> scores;
    for (const Trial& particle : particles_) scores.push_back(score_of(particle));
    std::ranges::sort(scores, std::greater<>());
    double next = scores[static_cast<std::size_t>(kept_proportion * static_cast<double>(scores.size()))];
    if (next > level && proportion_from(next) <= max_proportion) return next;
    const auto last_above =
        std::ranges::partition_point(scores, [&](double score) { return score > std::max(next, level); });
    return last_above == scores.begin() ? level : *std::prev(last_above);
  }

  /// Raises the population of trials (particles) to a level: removes those below the level, copies the others
  /// until their number is restored, and moves all by steps of a Markov chain that stay at or above the
  /// level.
  void climb(double level) {
    result_.search.probability *= proportion_from(level);
    std::erase_if(particles_, [&](const Trial& particle) { return score_of(particle) < level; });
    const std::vector<Trial> seeds = particles_;
    std::size_t next = 0;
    while (particles_.size() < particles_of_level) particles_.push_back(seeds[next++ % seeds.size()]);
    for (int step = 0; step < steps_of_level; ++step) move_all(level, step % 2 == 1);
  }

  double moved_coordinate(std::size_t i, double z, double kept) {
    if (!std::ranges::binary_search(space_.unordered, i)) return kept * z + step_ * numbers_.normal();
    return numbers_.uniform() < redrawn_proportion ? numbers_.normal() : z;
  }

  void move_all(double level, bool new_numbers) {
    std::vector<Trial> proposed = particles_;
    const double kept = std::sqrt(1.0 - step_ * step_);
    for (Trial& moved : proposed) {
      for (std::size_t i = 0; i < moved.z.size(); ++i) moved.z[i] = moved_coordinate(i, moved.z[i], kept);
      if (new_numbers) moved.number = number_++;
    }
    run_trials(proposed);
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < proposed.size(); ++i) {
      if (score_of(proposed[i]) < level) continue;
      particles_[i] = std::move(proposed[i]);
      ++accepted;
    }
    const double acceptance = static_cast<double>(accepted) / static_cast<double>(proposed.size());
    step_ = std::clamp(step_ * numerics::exp(1.5 * (acceptance - wanted_acceptance)), 0.02, 1.0);
  }

  const SplittingSettings& settings_;
  const TrialSpace& space_;
  const Simulation& simulate_;
  NumberSource& numbers_;
  std::int64_t number_;
  double step_{0.6};
  std::vector<Trial> particles_;
  SplittingResult result_;
};

}  // namespace

SplittingResult split(const SplittingSettings& settings, const TrialSpace& space, const Simulation& simulate,
                      NumberSource& numbers, const std::function<bool()>& go_on) {
  return Splitting(settings, space, simulate, numbers).run(go_on);
}

}  // namespace zerocount::rare
