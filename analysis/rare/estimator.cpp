#include "analysis/rare/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/rare/splitting.hpp"
#include "analysis/statistics/betting_bounds.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::rare {
namespace {

constexpr std::size_t plain_at_first = 1000;
constexpr std::int64_t most_rows = 100'000;  // each of which is tried
constexpr std::int64_t enough_plain_failures = 30;
constexpr int searches_of_first_score = 2;
constexpr double least_probability = 1e-11;
constexpr double least_beside_the_best = 0.05;  // of the best score's probability
constexpr int most_pilots = 8;
constexpr std::size_t pilot_trials = 2000;
constexpr double enough_pilot_failures = 100.0;  // independent ones
constexpr double least_share_of_searched = 0.5;  // of splitting's failures, beside those of pilots
constexpr double cap_of_no_use = 0.5;            // plain trials have 1
constexpr double enough_for_plain = 1e-4;        // of the probability
constexpr double narrow_cap = 30.0;              // of the weights, over the probability
constexpr std::size_t drawn_at_once = 500;
constexpr std::size_t most_drawn = 2'000'000;  // some hundred bytes each
constexpr double natural_share = 0.1;
constexpr double share_of_levels = 0.35;
constexpr double share_of_new = 0.4;  // of the mixture, after a failure that it did not foresee
constexpr double cap_beyond_usual = 2.0;
constexpr double quantile_of_cap = 0.998;  // of the likelihood ratio of failures
constexpr std::int64_t most_learnings = 8;
constexpr double steps_per_independent_point = 5.0;  // of a Markov chain
constexpr double disagreement = 10.0;                // of splitting and the bounds

std::vector<double> positive_values(const EstimatorState& state) {
  std::vector<double> values;
  for (const WeightedTrial& trial : state.drawn) {
    if (trial.failed > 0.0) values.push_back(trial.weight * trial.failed);
  }
  return values;
}

/// Confidence of the bounds of one learned proposal: the error probabilities of all have the sum that is
/// allowed. The first has most of it.
double confidence_of(const EstimatorState& state, double confidence) {
  const double part =
      state.learnings <= 1 ? 0.8 : 0.2 * std::ldexp(1.0, static_cast<int>(1 - state.learnings));
  return 1.0 - (1.0 - confidence) * part;
}

bool is_narrow(const statistics::ConfidenceInterval& bounds, double ratio) {
  return bounds.low > 0.0 && bounds.high <= ratio * bounds.low;
}

/// Whether splitting along the first score found failures of a far larger probability than the bounds allow,
/// each time that it found some. Along the others it may end with copies of a few failures, whose number says
/// little.
bool splitting_disagrees(const EstimatorState& state, double high) {
  const auto is_meant = [](const ScoreSearch& search) { return search.score == 0 && search.reached; };
  return std::ranges::any_of(state.searches, is_meant) &&
         std::ranges::none_of(state.searches, [&](const ScoreSearch& search) {
           return is_meant(search) && search.probability <= disagreement * high;
         });
}

/// Scales the weights of components to a sum.
void scale_weights(std::vector<NormalComponent>& components, double sum) {
  double all = 0.0;
  for (const NormalComponent& one : components) all += one.weight;
  for (NormalComponent& one : components) one.weight *= sum / all;
}

/// The mixture of two fits, of which the second has this share.
Proposal proposal_of(std::vector<NormalComponent> first, std::vector<NormalComponent> second, double share) {
  scale_weights(first, second.empty() ? 1.0 : 1.0 - share);
  scale_weights(second, share);
  std::ranges::move(second, std::back_inserter(first));
  return {natural_share, std::move(first)};
}

class Estimator {
 public:
  Estimator(EstimatorState& state, const EstimatorSettings& settings, const Simulation& simulate,
            const std::function<bool(const EstimatorState&)>& go_on)
      : state_(state), settings_(settings), simulate_(simulate), go_on_(go_on) {}

  Estimate run() {
    if (!state_.learned && !learn()) return answer_of(state_, settings_);
    while (!answer_of(state_, settings_).narrow) {
      if (state_.drawn.size() >= most_drawn || !go_on_(state_)) break;
      draw_more();
      if (!is_covered() && !learn_again()) break;
    }
    return answer_of(state_, settings_);
  }

 private:
  NumberSource numbers_for(std::string_view use, std::uint32_t stream = 0) const {
    return NumberSource(designs::random_key(settings_.seed, fmt::format("rare/{}", use)), stream);
  }

  /// The coordinates that the proposal changes.
  std::vector<double> changed_part(const std::vector<double>& z) const {
    std::vector<double> part;
    for (std::size_t i = 0; i < z.size(); ++i) {
      if (!std::ranges::binary_search(settings_.unordered, i)) part.push_back(z[i]);
    }
    return part;
  }

  /// A point of the proposal.
  std::vector<double> drawn_point(NumberSource& numbers) const {
    const std::vector<double> changed =
        draw(state_.proposal, settings_.coordinates - settings_.unordered.size(), numbers);
    std::vector<double> z;
    std::size_t next = 0;
    for (std::size_t i = 0; i < settings_.coordinates; ++i)
      z.push_back(std::ranges::binary_search(settings_.unordered, i) ? numbers.normal() : changed[next++]);
    return z;
  }

  std::vector<PointResult> run_trials(std::span<const TrialPoint> points) {
    std::vector<PointResult> results = simulate_(points);
    state_.trials += std::ssize(points);
    return results;
  }

  bool learn() {
    if (state_.plain_trials > 0) ++state_.searched;  // a search anew has other random numbers
    state_.searched_all = false;
    state_.searches.clear();
    run_plain();
    if (std::ssize(searched_.z) < enough_plain_failures && !search_all()) return false;
    state_.searched_all = true;
    if (searched_.z.empty()) return false;
    if (settings_.unordered.size() == settings_.coordinates) {
      draw_plainly();
      return true;
    }
    NumberSource numbers = numbers_for("pilot", static_cast<std::uint32_t>(state_.searched));
    fit(numbers);
    double probability = 0.0;
    for (int round = 0; round < most_pilots; ++round) {
      if (!go_on_(state_)) return false;
      probability = run_pilot(numbers);
      fit(numbers);
      state_.cap = cap_beyond_usual * usual_largest(pilots_.z.empty() ? searched_ : pilots_);
      if (state_.cap < narrow_cap * probability) break;
    }
    for (const std::vector<double>& z : plain_failing_)
      state_.cap = std::max(state_.cap, cap_beyond_usual * likelihood_ratio(state_.proposal, z));
    state_.learned = true;
    state_.learnings = 1;
    if (state_.cap >= cap_of_no_use && probability >= enough_for_plain) draw_plainly();
    return true;
  }

  /// Goes on with plain trials.
  void draw_plainly() {
    state_.proposal = {};
    state_.cap = 1.0;
    state_.learned = true;
    state_.learnings = 1;
  }

  /// A trial of its own distribution. Trials that follow each other have the rows of a table in turn, so that
  /// no row stays untried.
  std::vector<double> plain_point(std::size_t index, NumberSource& numbers) const {
    std::vector<double> z = numbers.normals(settings_.coordinates);
    for (std::size_t k = 0; k < settings_.unordered.size(); ++k) {
      const auto rows = static_cast<std::size_t>(settings_.rows[k]);
      const double place = static_cast<double>(index % rows) + numbers.uniform();
      z[settings_.unordered[k]] = numerics::normal_quantile(place / static_cast<double>(rows));
    }
    return z;
  }

  /// Trials of their own distribution, of every row of a table as many: where failures are common, they are
  /// enough to learn from.
  void run_plain() {
    NumberSource numbers = numbers_for("plain", static_cast<std::uint32_t>(state_.searched));
    std::size_t count = plain_at_first;
    for (const std::int64_t rows : settings_.rows) {
      const auto whole = static_cast<std::size_t>(rows);
      if (rows <= most_rows) count = std::max(whole, (plain_at_first + whole - 1) / whole * whole);
    }
    std::vector<TrialPoint> points;
    for (std::size_t i = 0; i < count; ++i)
      points.push_back({plain_point(i, numbers), state_.trials + static_cast<std::int64_t>(i)});
    const std::vector<PointResult> results = run_trials(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (results[i].failed > 0.0) searched_.add(changed_part(points[i].z), results[i].failed);
    }
    state_.plain_trials += std::ssize(points);
    state_.plain_failures += std::ssize(searched_.z);
    plain_failing_ = searched_.z;
  }

  /// Splitting along all scores. @return whether it came to an end in the budget
  bool search_all() {
    double best = 0.0;
    auto stream = static_cast<std::uint32_t>(state_.searched) << 8U;
    for (std::size_t score = 0; score < settings_.scores; ++score) {
      const int repeated = score == 0 ? searches_of_first_score : 1;
      for (int i = 0; i < repeated; ++i) {
        NumberSource numbers = numbers_for("splitting", stream++);
        const SplittingResult found = split(
            {.coordinates = settings_.coordinates,
             .unordered = settings_.unordered,
             .score = score,
             .least = std::max(least_probability, least_beside_the_best * best),
             .first_number = state_.trials},
            [&](std::span<const TrialPoint> points) { return run_trials(points); }, numbers,
            [&] { return go_on_(state_); });
        state_.plain_trials += found.plain_trials;
        state_.plain_failures += std::ssize(found.plain_failing);
        state_.searches.push_back({score, found.reached, found.probability, found.levels, found.trials});
        for (const TrialPoint& point : found.plain_failing) {
          searched_.add(changed_part(point.z), 1.0);
          plain_failing_.push_back(changed_part(point.z));
        }
        if (!go_on_(state_)) return false;
        if (!found.reached) continue;
        best = std::max(best, found.probability);
        add_points(found, numbers);
      }
    }
    return true;
  }

  void add_points(const SplittingResult& found, NumberSource& numbers) {
    const double each = 1.0 / steps_per_independent_point;
    for (const TrialPoint& point : found.failing) searched_.add(changed_part(point.z), each);
    for (const std::vector<TrialPoint>& level : found.above) {
      WeightedPoints points;
      for (const TrialPoint& point : level) points.add(changed_part(point.z), 1.0);
      levels_.push_back(fitted_normal(points, numbers));
    }
  }

  /// Gives the points the sum of weights `size`.
  static void balance(WeightedPoints& points, double size) {
    const double sum = std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
    for (double& weight : points.weights) weight *= size / sum;
  }

  /// The mixture of the failures of the pilots, and those of splitting as far as the pilots have few; and of
  /// the levels.
  void fit(NumberSource& numbers) {
    WeightedPoints points = pilots_;
    const double effective = effective_size(pilots_.weights);
    WeightedPoints searched = searched_;
    balance(searched,
            std::max(least_share_of_searched * effective, std::max(1.0, enough_pilot_failures - effective)));
    for (std::size_t i = 0; i < searched.z.size(); ++i) points.add(searched.z[i], searched.weights[i]);
    state_.proposal = proposal_of(fitted_mixture(points, numbers), levels_, share_of_levels);
  }

  std::vector<WeightedTrial> draw_trials(std::size_t count, NumberSource& numbers) {
    std::vector<TrialPoint> points;
    for (std::size_t i = 0; i < count; ++i)
      points.push_back({drawn_point(numbers), state_.trials + static_cast<std::int64_t>(i)});
    const std::vector<PointResult> results = run_trials(points);
    std::vector<WeightedTrial> drawn;
    for (std::size_t i = 0; i < count; ++i) {
      const double weight = likelihood_ratio(state_.proposal, changed_part(points[i].z));
      drawn.push_back({std::move(points[i]), weight, results[i].failed});
    }
    return drawn;
  }

  /// @return the probability by these trials
  double run_pilot(NumberSource& numbers) {
    WeightedPoints found;
    double sum = 0.0;
    for (const WeightedTrial& trial : draw_trials(pilot_trials, numbers)) {
      if (!(trial.failed > 0.0)) continue;
      found.add(changed_part(trial.point.z), trial.weight * trial.failed);
      sum += trial.weight * trial.failed;
    }
    if (found.z.empty()) return 0.0;
    balance(found, effective_size(found.weights));
    for (std::size_t i = 0; i < found.z.size(); ++i) pilots_.add(found.z[i], found.weights[i]);
    return sum / static_cast<double>(pilot_trials);
  }

  /// A likelihood ratio that 99.8 % of the failures do not exceed, by the weights of these points.
  double usual_largest(const WeightedPoints& points) const {
    std::vector<std::pair<double, double>> ratios;
    for (std::size_t i = 0; i < points.z.size(); ++i)
      ratios.emplace_back(likelihood_ratio(state_.proposal, points.z[i]), points.weights[i]);
    std::ranges::sort(ratios);
    double left = quantile_of_cap * std::accumulate(points.weights.begin(), points.weights.end(), 0.0);
    for (const auto& [ratio, weight] : ratios) {
      left -= weight;
      if (left <= 0.0) return ratio;
    }
    return ratios.back().first;
  }

  void draw_more() {
    NumberSource numbers = numbers_for(fmt::format("drawn/{}", state_.learnings),
                                       static_cast<std::uint32_t>(state_.drawn.size() / drawn_at_once));
    const std::size_t count =
        std::max(drawn_at_once, state_.drawn.size() / drawn_at_once / 8 * drawn_at_once);
    std::ranges::move(draw_trials(count, numbers), std::back_inserter(state_.drawn));
  }

  bool is_covered() const {
    return std::ranges::none_of(
        state_.drawn, [&](const WeightedTrial& trial) { return trial.weight * trial.failed > state_.cap; });
  }

  bool learn_again() {
    if (state_.learnings >= most_learnings) return false;
    WeightedPoints found;
    for (const WeightedTrial& trial : state_.drawn) {
      if (trial.failed > 0.0) found.add(changed_part(trial.point.z), trial.weight * trial.failed);
    }
    NumberSource numbers = numbers_for("again", static_cast<std::uint32_t>(state_.learnings));
    state_.proposal =
        proposal_of(std::move(state_.proposal.components), fitted_mixture(found, numbers), share_of_new);
    for (const std::vector<double>& z : found.z)
      state_.cap = std::max(state_.cap, cap_beyond_usual * likelihood_ratio(state_.proposal, z));
    state_.drawn.clear();
    ++state_.learnings;
    return true;
  }

  EstimatorState& state_;
  const EstimatorSettings& settings_;
  const Simulation& simulate_;
  const std::function<bool(const EstimatorState&)>& go_on_;
  WeightedPoints searched_;                         ///< failures found by plain trials and splitting
  std::vector<std::vector<double>> plain_failing_;  ///< those of plain trials
  WeightedPoints pilots_;                ///< those of pilots; the sum of weights is their effective size
  std::vector<NormalComponent> levels_;  ///< a normal distribution of each level of splitting
};

}  // namespace

Estimate answer_of(const EstimatorState& state, const EstimatorSettings& settings) {
  Estimate answer;
  answer.plain_high =
      statistics::clopper_pearson(state.plain_failures, state.plain_trials, settings.confidence).high;
  answer.bounds = {0.0, answer.plain_high};
  if (!state.learned) {
    const bool none_found =
        state.searched_all && state.plain_failures == 0 &&
        std::ranges::none_of(state.searches, [](const ScoreSearch& search) { return search.reached; });
    answer.status = none_found ? EstimateStatus::no_failure : EstimateStatus::budget;
    return answer;
  }
  const std::vector<double> values = positive_values(state);
  if (state.drawn.empty()) return answer;
  answer.bounds = statistics::betting_bounds(values, std::ssize(state.drawn), state.cap,
                                             confidence_of(state, settings.confidence));
  answer.probability =
      std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(state.drawn.size());
  answer.bounds.high = std::min(answer.bounds.high, 1.0);
  const bool exceeds = std::ranges::any_of(values, [&](double value) { return value > state.cap; });
  answer.narrow = !exceeds && is_narrow(answer.bounds, settings.ratio);
  if (exceeds || (answer.narrow && splitting_disagrees(state, answer.bounds.high))) {
    answer.status = EstimateStatus::not_covered;
  } else if (answer.narrow) {
    answer.status = EstimateStatus::estimated;
  } else if (state.drawn.size() >= most_drawn) {
    answer.status = EstimateStatus::too_many;
  }
  if (answer.status != EstimateStatus::estimated)
    answer.bounds.high = std::max(answer.bounds.high, answer.plain_high);
  return answer;
}

Estimate estimate(EstimatorState& state, const EstimatorSettings& settings, const Simulation& simulate,
                  const std::function<bool(const EstimatorState&)>& go_on) {
  return Estimator(state, settings, simulate, go_on).run();
}

}  // namespace zerocount::rare
