#include "runners/tuning/worst_in_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "analysis/measures/move_event.hpp"
#include "analysis/statistics/distributions.hpp"
#include "analysis/tuning/search_space.hpp"
#include "core/batch/batch.hpp"
#include "core/failure/failure.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "core/random/number_source.hpp"
#include "experiments/designs/random_key.hpp"
#include "experiments/study/machine_inputs.hpp"
#include "runners/study_run/parallel_trials.hpp"
#include "runners/tuning/tuned_study.hpp"

namespace zerocount::tuning {
namespace {

constexpr double tail = 0.0005;  // beyond each end of the box
constexpr std::int64_t trials_of_search = 128;
constexpr std::int64_t trials_of_verdict = 256;
constexpr std::size_t worst_rigs = 4;
constexpr std::size_t most_corners = 64;
constexpr std::size_t filling_points = 128;
constexpr int generations = 8;
constexpr std::size_t survivors = 8;
constexpr std::size_t children = 32;

/// A machine of the box: a rig, and [machine input] the place in the box, 0 to 1.
struct BoxPoint {
  std::int64_t rig{0};
  std::vector<double> place;
  UnitResult result{};
};

/// Mean of the criterion's values, where one that is never reached counts as `late`.
double lateness(const UnitResult& unit, double late) {
  double sum = 0.0;
  for (const double value : unit.values) sum += std::min(value, late);
  return sum;
}

class BoxSearch {
 public:
  BoxSearch(const study::Study& study, const Units& units, MachineRegion region, const std::stop_token& stop)
      : region_(region),
        units_(units),
        study_(variant_of(study, sizes(study, units))),
        inputs_(study::machine_inputs(study_, units.point)),
        numbers_{designs::random_key(study.seed, "worst machine"), 0},
        event_(measures::missed_goal(study_).value()),
        stop_(stop) {
    if (inputs_.empty())
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: it draws nothing that differs between machines; expected distributions, "
                                "such as friction.k1: {{lognormal: {{median: 110, cv: 0.1}}}}",
                                study.name));
  }

  WorstInBox run(std::span<const UnitResult> results) {
    std::vector<BoxPoint> population = first_points(results);
    simulate(population, 0, trials_of_search);
    keep_worst(population);
    double step = 0.25;
    for (int generation = 0; generation < generations; ++generation) {
      std::vector<BoxPoint> born;
      for (std::size_t i = 0; i < children; ++i)
        born.push_back(child_of(population[i % population.size()], step));
      simulate(born, 0, trials_of_search);
      std::ranges::move(born, std::back_inserter(population));
      keep_worst(population);
      step *= 0.7;
    }
    BoxPoint worst = population.front();
    std::vector<BoxPoint> judged{worst};
    judged.front().result = {};
    simulate(judged, trials_of_search, trials_of_search + trials_of_verdict);
    return answer_of(judged.front());
  }

 private:
  static std::vector<std::string> sizes(const study::Study& study, const Units& units) {
    const std::int64_t trials = (trials_of_search + trials_of_verdict) * (study.rigs > 0 ? units.count : 1);
    std::vector<std::string> overrides = overrides_for(study, {in_equal_worlds(study, trials), 1});
    if (study.rigs > 0) overrides.push_back(fmt::format("rigs={}", units.count));
    return overrides;
  }

  std::vector<std::int64_t> rigs_of(std::span<const UnitResult> results) const {
    if (study_.rigs == 0) return {0};
    std::vector<std::int64_t> order(results.size());
    std::iota(order.begin(), order.end(), std::int64_t{0});
    std::ranges::stable_sort(order, [&](std::int64_t a, std::int64_t b) {
      return met_share(results[static_cast<std::size_t>(a)]) <
             met_share(results[static_cast<std::size_t>(b)]);
    });
    order.resize(std::min(order.size(), worst_rigs));
    return order;
  }

  std::vector<BoxPoint> first_points(std::span<const UnitResult> results) {
    const std::vector<std::int64_t> rigs = rigs_of(results);
    const std::size_t size = inputs_.size();
    std::vector<BoxPoint> points;
    const auto add = [&](std::vector<double> place) {
      points.push_back({rigs[points.size() % rigs.size()], inside(std::move(place)), {}});
    };
    const bool all_corners = size < 16 && (std::size_t{1} << size) <= most_corners;
    const std::size_t corners = all_corners ? std::size_t{1} << size : most_corners;
    for (std::size_t corner = 0; corner < corners; ++corner) {
      std::vector<double> place;
      for (std::size_t i = 0; i < size; ++i)
        place.push_back((all_corners ? ((corner >> i) & 1U) == 1U : numbers_.uniform() < 0.5) ? 1.0 : 0.0);
      add(std::move(place));
    }
    const std::vector<double> start(size, 0.5);
    for (std::size_t i = 0; i < filling_points; ++i) add(spread_place(start, static_cast<std::int64_t>(i)));
    return points;
  }

  BoxPoint child_of(const BoxPoint& parent, double step) {
    BoxPoint child{parent.rig, parent.place, {}};
    for (double& place : child.place) {
      if (numbers_.uniform() < 0.5) place = std::clamp(place + step * numbers_.normal(), 0.0, 1.0);
    }
    child.place = inside(std::move(child.place));
    return child;
  }

  /// The place itself, or of the likely machines the nearest on the way to the median.
  std::vector<double> inside(std::vector<double> place) const {
    if (region_ == MachineRegion::box) return place;
    double square = 0.0;
    int scores = 0;
    const auto is_row = [&](std::size_t i) { return inputs_[i].slots.size() > 1; };  // of joint samples
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (is_row(i)) continue;
      const double z = numerics::normal_quantile(quantile_at(place[i]));
      square += z * z;
      ++scores;
    }
    if (scores == 0) return place;
    const double radius = std::sqrt(statistics::chi_squared_quantile(scores, 1.0 - 2.0 * tail));
    if (square <= radius * radius) return place;
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (is_row(i)) continue;
      double& one = place[i];
      const double z = numerics::normal_quantile(quantile_at(one)) * radius / std::sqrt(square);
      one = std::clamp((numerics::normal_probability(z) - tail) / (1.0 - 2.0 * tail), 0.0, 1.0);
    }
    return place;
  }

  double quantile_at(double place) const { return tail + (1.0 - 2.0 * tail) * place; }

  study::GivenDraws given_of(const BoxPoint& point) const {
    study::GivenDraws given;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      for (const std::uint32_t slot : inputs_[i].slots) given.uniforms[slot] = quantile_at(point.place[i]);
    }
    return given;
  }

  /// Number of trial i of a machine with the profiles of this rig.
  std::int64_t trial_of(std::int64_t rig, std::int64_t i) const {
    return study_.rigs > 0 ? rig + i * study_.rigs : i;
  }

  void simulate(std::vector<BoxPoint>& points, std::int64_t from, std::int64_t to) const {
    study_run::for_each_with_engine(points.size(), [&](std::size_t p, batch::BatchEngine& engine) {
      const study::GivenDraws given = given_of(points[p]);
      std::vector<trial::TrialParameters> trials;
      for (std::int64_t i = from; i < to; ++i)
        trials.push_back(
            study::study_trial(study_, units_.point, trial_of(points[p].rig, i), given).parameters);
      points[p].result = result_of(trials, engine);
    });
  }

  /// The moves that meet the goal, and the score of each; the largest double where it was never reached.
  UnitResult result_of(std::span<const trial::TrialParameters> trials, batch::BatchEngine& engine) const {
    UnitResult result;
    for (const trial::TrialOutcome& outcome : study_run::outcomes_of(trials, engine, stop_)) {
      for (const trial::MoveOutcome& move : outcome.moves) {
        const double score = measures::score_of(measures::MoveScore::event, event_, move);
        ++result.moves;
        result.met += measures::happens(event_, move) ? 0 : 1;
        result.values.push_back(std::isnan(score) ? std::numeric_limits<double>::max() : score);
      }
    }
    return result;
  }

  void keep_worst(std::vector<BoxPoint>& points) const {
    const double late = study_.goal->within * 10.0;
    std::ranges::stable_sort(points, [&](const BoxPoint& a, const BoxPoint& b) {
      if (met_share(a.result) != met_share(b.result)) return met_share(a.result) < met_share(b.result);
      return lateness(a.result, late) > lateness(b.result, late);
    });
    if (points.size() > survivors) points.resize(survivors);
  }

  WorstInBox answer_of(const BoxPoint& worst) const {
    WorstInBox answer;
    answer.rig = worst.rig;
    answer.moves = worst.result.moves;
    answer.met = met_share(worst.result);
    const auto latest = std::ranges::max_element(worst.result.values) - worst.result.values.begin();
    answer.trial = trial_of(worst.rig, trials_of_search + latest / study_.moves);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      answer.quantiles.push_back(quantile_at(worst.place[i]));
      for (const auto& one :
           study::values_at_quantile(study_, units_.point, inputs_[i], answer.quantiles.back()))
        answer.inputs.push_back(one);
    }
    answer.searched = study_;
    return answer;
  }

  MachineRegion region_;
  Units units_;
  study::Study study_;
  std::vector<study::MachineInput> inputs_;
  random::NumberSource numbers_;
  measures::MoveEvent event_;
  std::stop_token stop_;
};

}  // namespace

WorstInBox worst_in_box(const study::Study& study, const Units& units, std::span<const UnitResult> results,
                        MachineRegion region, const std::stop_token& stop) {
  return BoxSearch(study, units, region, stop).run(results);
}

study::Study replay_of(const WorstInBox& worst) {
  std::vector<std::string> values;
  for (const auto& [name, value] : worst.inputs) values.push_back(fmt::format("{}={}", name, value));
  if (!worst.searched.correlations.empty()) values.emplace_back("correlation=[]");
  return with_values_in_text(worst.searched, values);
}

}  // namespace zerocount::tuning
