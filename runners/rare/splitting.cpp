#include "runners/rare/splitting.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/numerics/elementary_functions.hpp"

namespace zerocount::rare {
namespace {

constexpr double kept_proportion = 0.2;
constexpr double enough_failures = 0.2;  // of the trials of a level
constexpr double min_failures = 10;      // from which copies are made
constexpr double max_proportion = 0.6;   // of trials above a level: otherwise it is no progress
constexpr double wanted_acceptance = 0.35;
constexpr double redrawn_proportion = 0.2;  // of the steps of an unordered coordinate
constexpr double failed_score = std::numeric_limits<double>::infinity();

/// A trial with its score; a failure has the largest.
struct Particle {
  TrialPoint point;
  double score;
};

class Splitting {
 public:
  Splitting(const SplittingSettings& settings, const Simulation& simulate, NumberSource& numbers)
      : settings_(settings), simulate_(simulate), numbers_(numbers), number_(settings.first_number) {}

  SplittingResult run(const std::function<bool()>& go_on) {
    if (!go_on()) return std::move(result_);
    start();
    double level = -failed_score;
    while (failing_proportion() < enough_failures) {
      const double next = next_level(level);
      if (next == failed_score &&
          failing_proportion() * static_cast<double>(particles_.size()) >= min_failures)
        break;
      if (!(next > level) || next == failed_score || result_.probability < settings_.least || !go_on())
        return std::move(result_);
      level = next;
      climb(level);
      result_.above.push_back(points());
      ++result_.levels;
    }
    if (!go_on()) return std::move(result_);
    climb(failed_score);
    result_.reached = true;
    result_.failing = points();
    return std::move(result_);
  }

 private:
  std::vector<TrialPoint> points() const {
    std::vector<TrialPoint> all;
    for (const Particle& particle : particles_) all.push_back(particle.point);
    return all;
  }

  double failing_proportion() const {
    const auto failing = std::ranges::count_if(
        particles_, [](const Particle& particle) { return particle.score == failed_score; });
    return static_cast<double>(failing) / static_cast<double>(particles_.size());
  }

  double proportion_from(double level) const {
    const auto above =
        std::ranges::count_if(particles_, [&](const Particle& particle) { return particle.score >= level; });
    return static_cast<double>(above) / static_cast<double>(particles_.size());
  }

  std::vector<double> scores_of(const std::vector<TrialPoint>& trials) {
    std::vector<double> scores;
    for (const PointResult& result : simulate_(trials)) {
      const double score = result.scores[settings_.score];
      scores.push_back(result.failed > 0.0 ? failed_score : std::isnan(score) ? -failed_score : score);
    }
    result_.trials += std::ssize(trials);
    return scores;
  }

  void start() {
    std::vector<TrialPoint> trials;
    for (std::size_t i = 0; i < settings_.particles; ++i)
      trials.push_back({numbers_.normals(settings_.coordinates), number_++});
    const std::vector<double> scores = scores_of(trials);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (scores[i] == failed_score) result_.plain_failing.push_back(trials[i]);
      particles_.push_back({std::move(trials[i]), scores[i]});
    }
    result_.plain_trials = std::ssize(scores);
  }

  /// The score that a fifth of the trials reach; where many trials have the same one, the next larger.
  double next_level(double level) const {
    std::vector<double> scores;
    for (const Particle& particle : particles_) scores.push_back(particle.score);
    std::ranges::sort(scores, std::greater<>());
    double next = scores[static_cast<std::size_t>(kept_proportion * static_cast<double>(scores.size()))];
    if (next > level && proportion_from(next) <= max_proportion) return next;
    const auto last_above =
        std::ranges::partition_point(scores, [&](double score) { return score > std::max(next, level); });
    return last_above == scores.begin() ? level : *std::prev(last_above);
  }

  /// Moves the particles at or above the level, copied to all places, in it.
  void climb(double level) {
    result_.probability *= proportion_from(level);
    std::erase_if(particles_, [&](const Particle& particle) { return particle.score < level; });
    const std::vector<Particle> seeds = particles_;
    std::size_t next = 0;
    while (particles_.size() < settings_.particles) particles_.push_back(seeds[next++ % seeds.size()]);
    for (int step = 0; step < settings_.steps; ++step) move_all(level, step % 2 == 1);
  }

  double moved_coordinate(std::size_t i, double z, double kept) {
    if (!std::ranges::binary_search(settings_.unordered, i)) return kept * z + step_ * numbers_.normal();
    return numbers_.uniform() < redrawn_proportion ? numbers_.normal() : z;
  }

  void move_all(double level, bool new_numbers) {
    std::vector<TrialPoint> proposed;
    const double kept = std::sqrt(1.0 - step_ * step_);
    for (const Particle& particle : particles_) {
      TrialPoint moved = particle.point;
      for (std::size_t i = 0; i < moved.z.size(); ++i) moved.z[i] = moved_coordinate(i, moved.z[i], kept);
      if (new_numbers) moved.number = number_++;
      proposed.push_back(std::move(moved));
    }
    const std::vector<double> scores = scores_of(proposed);
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < proposed.size(); ++i) {
      if (scores[i] < level) continue;
      particles_[i] = {std::move(proposed[i]), scores[i]};
      ++accepted;
    }
    const double acceptance = static_cast<double>(accepted) / static_cast<double>(proposed.size());
    step_ = std::clamp(step_ * numerics::exp(1.5 * (acceptance - wanted_acceptance)), 0.02, 1.0);
  }

  SplittingSettings settings_;
  const Simulation& simulate_;
  NumberSource& numbers_;
  std::int64_t number_;
  double step_{0.6};
  std::vector<Particle> particles_;
  SplittingResult result_;
};

}  // namespace

SplittingResult split(const SplittingSettings& settings, const Simulation& simulate, NumberSource& numbers,
                      const std::function<bool()>& go_on) {
  return Splitting(settings, simulate, numbers).run(go_on);
}

}  // namespace zerocount::rare
