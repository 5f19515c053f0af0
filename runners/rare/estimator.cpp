#include "runners/rare/estimator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/statistics/unknown.hpp"
#include "experiments/designs/designs.hpp"

namespace zerocount::rare {
namespace {

constexpr std::size_t plain_at_first = 1000;
constexpr double common_value = 0.01;              // more probable ones are drawn often enough
constexpr std::int64_t trials_of_values = 40'000;  // of a discrete draw, shared by its values
constexpr std::int64_t max_trials_of_value = 10;
constexpr std::int64_t trials_of_values_at_once = 2000;
/// One more round of trials at the values of a discrete draw that look most likely to fail: the number of
/// values that get it, and the number of trials at each.
struct Retrial {
  std::size_t values;
  std::int64_t trials;
};
constexpr std::array<Retrial, 2> retrials{{{200, 50}, {20, 500}}};
constexpr std::int64_t min_failures_of_pinned = 2;
constexpr double enrichment_of_pinned = 5.0;  // of failures at a value, over those of plain trials
constexpr double proportion_of_pinned = 0.5;  // weight in the proposal, beside a mixture
constexpr std::int64_t enough_plain_failures = 30;
constexpr int searches_of_first_score = 2;
constexpr double min_probability = 1e-11;
constexpr double min_beside_the_best = 0.05;  // of the best score's probability
constexpr int max_pilots = 8;
constexpr std::size_t pilot_trials = 2000;
constexpr double enough_pilot_failures = 100.0;     // independent ones
constexpr double min_proportion_of_searched = 0.5;  // of splitting's failures, beside those of pilots
constexpr double cap_of_no_use = 0.5;               // plain trials have 1
constexpr double narrow_cap = 30.0;                 // of the weights, over the probability
constexpr std::size_t drawn_at_once = 500;
constexpr double natural_proportion = 0.1;
constexpr double proportion_of_levels = 0.35;
constexpr double proportion_of_new = 0.4;  // weight in the mixture, after a failure that it did not foresee
constexpr double cap_beyond_usual = 2.0;
constexpr double quantile_of_cap = 0.998;  // of the likelihood ratio of failures
constexpr std::int64_t max_learnings = 8;
constexpr double steps_per_independent_point = 5.0;  // of a Markov chain
constexpr double disagreement = 10.0;                // of splitting and the bounds

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Multiplies the weights of the points by a common factor, so that their sum is `size`.
void balance(WeightedPoints& points, double size) {
  const double sum = sum_of(points.weights);
  for (double& weight : points.weights) weight *= size / sum;
}

/// Mixture of normal distributions from the components of two fits. Those of the second fit have the
/// proportion `proportion` together, or 1 if the first is empty.
std::vector<NormalComponent> mixed(std::vector<NormalComponent> first, std::vector<NormalComponent> second,
                                   double proportion) {
  const auto scale_weights = [](std::vector<NormalComponent>& components, double sum) {
    double all = 0.0;
    for (const NormalComponent& one : components) all += one.weight;
    for (NormalComponent& one : components) one.weight *= sum / all;
  };
  scale_weights(first, second.empty() ? 1.0 : 1.0 - proportion);
  scale_weights(second, first.empty() ? 1.0 : proportion);
  std::ranges::move(second, std::back_inserter(first));
  return first;
}

/// A value of a discrete draw, with the results of the trials run at it. `scores` is [score] the largest
/// score among its last trials; −∞: no trial had a known score.
struct TriedValue {
  PinnedValue value;
  std::vector<double> scores;

  void take(std::span<const Trial> trials) {
    value.trials = std::ssize(trials);
    value.failures = std::ranges::count_if(trials, [](const Trial& one) { return one.failed > 0.0; });
    scores.assign(trials.front().scores.size(), -std::numeric_limits<double>::infinity());
    for (const Trial& one : trials) {
      for (std::size_t i = 0; i < scores.size(); ++i) scores[i] = std::fmax(scores[i], one.scores[i]);
    }
  }
};

/// Chooses at most `count` of the tried values for more trials: first the values with most failures; then,
/// for each score, equally many values with the largest score. All values, if these are at most `count`.
std::vector<TriedValue> most_suspicious(const std::vector<TriedValue>& tried, std::size_t count,
                                        std::size_t scores) {
  if (tried.size() <= count) return tried;
  std::vector<std::size_t> order(tried.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<bool> chosen(tried.size(), false);
  std::vector<TriedValue> found;
  const auto take_first = [&](std::size_t most, const auto& is_wanted) {
    for (std::size_t i = 0; i < order.size() && most > 0 && found.size() < count; ++i) {
      if (chosen[order[i]] || !is_wanted(tried[order[i]])) continue;
      chosen[order[i]] = true;
      found.push_back(tried[order[i]]);
      --most;
    }
  };
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return tried[i].value.failures; });
  take_first(count, [](const TriedValue& one) { return one.value.failures > 0; });
  const std::size_t of_each = (count - found.size() + scores - 1) / scores;
  for (std::size_t score = 0; score < scores; ++score) {
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return tried[i].scores[score]; });
    take_first(of_each, [](const TriedValue&) { return true; });
  }
  return found;
}

class Estimator {
 public:
  Estimator(EstimatorState& state, const EstimatorSettings& settings, const Simulation& simulate,
            const std::function<bool(const EstimatorState&)>& go_on)
      : state_(state), settings_(settings), simulate_(simulate), go_on_(go_on) {}

  ProbabilityEstimate run() {
    if (!state_.learned && !learn()) return answer_of(state_, settings_);
    estimate_by_drawing();
    const EstimateStatus status = answer_of(state_, settings_).status;
    const bool is_of_no_use = status == EstimateStatus::not_covered || status == EstimateStatus::too_many;
    if (!state_.proposal.is_natural() && is_of_no_use && go_on_(state_)) {
      draw_plainly();
      state_.drawn.clear();
      ++state_.learnings;
      estimate_by_drawing();
    }
    return answer_of(state_, settings_);
  }

 private:
  // Learning.

  bool learn() {
    if (state_.plain_trials > 0) ++state_.searched;  // a search anew has other random numbers
    state_.searches.clear();
    state_.proposal = {};
    state_.learnings = 0;
    run_plain();
    if (!try_values()) return false;
    if (std::ssize(searched_.z) < enough_plain_failures && !search_all()) return false;
    const bool nothing_to_change = settings_.space.unordered.size() == settings_.space.coordinates;
    if (state_.proposal.values.empty() && (searched_.z.empty() || nothing_to_change)) {
      draw_plainly();
      return true;
    }
    NumberSource numbers = numbers_for("pilot", static_cast<std::uint32_t>(state_.searched));
    fit(numbers);
    double probability = 0.0;
    for (int round = 0; round < max_pilots; ++round) {
      if (!go_on_(state_)) return false;
      probability = run_pilot(numbers);
      fit(numbers);
      state_.cap = cap_beyond_usual * std::max(usual_largest(pilots_.z.empty() ? searched_ : pilots_),
                                               max_ratio_of_pinned(state_.proposal));
      if (state_.cap < narrow_cap * probability) break;
    }
    raise_cap(plain_failing_);
    state_.learned = true;
    state_.learnings = 1;
    if (state_.cap >= cap_of_no_use) draw_plainly();
    return true;
  }

  /// Replaces the learned proposal by the trials' own distribution, so that the estimation goes on with plain
  /// Monte-Carlo trials.
  void draw_plainly() {
    state_.proposal = {};
    state_.cap = 1.0;
    state_.learned = true;
    state_.learnings = std::max<std::int64_t>(state_.learnings, 1);
  }

  /// Runs the first plain trials, which are drawn from their own distribution, and keeps their failures. If
  /// failures are common, the proposal is learned from these failures alone.
  void run_plain() {
    NumberSource numbers = numbers_for("plain", static_cast<std::uint32_t>(state_.searched));
    std::vector<std::vector<double>> points;
    for (std::size_t i = 0; i < plain_at_first; ++i)
      points.push_back(numbers.normals(settings_.space.coordinates));
    for (const Trial& trial : run_at(std::move(points))) {
      count_plain(trial);
      if (trial.failed > 0.0) add_plain_failure(trial, trial.failed);
    }
  }

  /// Runs trials at every value of each discrete draw, whatever its probability, because a value that fails
  /// need not be near other such values. Values with frequent failures become pinned values of the proposal.
  /// @return whether the budget was enough
  bool try_values() {
    if (std::ssize(searched_.z) >= enough_plain_failures) return true;
    for (std::size_t draw = 0; draw < settings_.space.discrete.size(); ++draw) {
      if (settings_.space.discrete[draw].values() <= max_tried_values && !try_values_of(draw)) return false;
    }
    double sum = 0.0;
    for (const PinnedValue& one : state_.proposal.values) sum += one.weight;
    for (PinnedValue& one : state_.proposal.values) one.weight /= sum;
    return true;
  }

  /// Runs trials at each value of one discrete draw that has a probability below 1 %. The values that look
  /// worst get two more rounds of more trials each. Values with frequent failures become pinned values of the
  /// proposal.
  /// @return whether the budget was enough
  bool try_values_of(std::size_t draw) {
    NumberSource numbers =
        numbers_for(fmt::format("values/{}", draw), static_cast<std::uint32_t>(state_.searched));
    std::vector<TriedValue> tried;
    for (PinnedValue& value : pinned_values(settings_.space, draw)) {
      if (value.probability < common_value) tried.push_back({std::move(value), {}});
    }
    if (tried.empty()) return true;
    const std::int64_t each =
        std::clamp<std::int64_t>(trials_of_values / std::ssize(tried), 1, max_trials_of_value);
    if (!run_tried(tried, each, numbers)) return false;
    for (const Retrial& retrial : retrials) {
      tried = most_suspicious(tried, retrial.values, settings_.scores);
      if (!run_tried(tried, retrial.trials, numbers)) return false;
    }
    const double usual =
        static_cast<double>(state_.plain_failures) / static_cast<double>(state_.plain_trials);
    for (TriedValue& one : tried) {
      PinnedValue& value = one.value;
      const double rate = static_cast<double>(value.failures) / static_cast<double>(value.trials);
      if (value.failures < min_failures_of_pinned || rate < enrichment_of_pinned * usual) continue;
      value.weight = rate * value.probability;
      state_.proposal.values.push_back(std::move(value));
    }
    return true;
  }

  /// Runs `trials_of_each` new trials at each value, which replace the value's earlier results.
  /// @return whether the budget was enough
  bool run_tried(std::vector<TriedValue>& values, std::int64_t trials_of_each, NumberSource& numbers) {
    const auto at_once =
        static_cast<std::size_t>(std::max<std::int64_t>(trials_of_values_at_once / trials_of_each, 1));
    const auto each = static_cast<std::size_t>(trials_of_each);
    for (std::size_t first = 0; first < values.size(); first += at_once) {
      if (!go_on_(state_)) return false;
      const std::span part = std::span(values).subspan(first, std::min(at_once, values.size() - first));
      std::vector<std::vector<double>> points;
      for (const TriedValue& one : part) {
        for (std::size_t i = 0; i < each; ++i)
          points.push_back(draw_pinned(settings_.space, one.value, numbers));
      }
      const std::vector<Trial> trials = run_at(std::move(points));
      for (std::size_t i = 0; i < part.size(); ++i) part[i].take(std::span(trials).subspan(i * each, each));
    }
    return true;
  }

  /// Runs multilevel splitting along each score, twice along the first, and keeps the failures that it finds.
  /// @return whether the budget was enough
  bool search_all() {
    double best = 0.0;
    auto stream = static_cast<std::uint32_t>(state_.searched) << 8U;
    for (std::size_t score = 0; score < settings_.scores; ++score) {
      const int repeated = score == 0 ? searches_of_first_score : 1;
      for (int i = 0; i < repeated; ++i) {
        NumberSource numbers = numbers_for("splitting", stream++);
        const SplittingResult found = split(
            {score, std::max(min_probability, min_beside_the_best * best), state_.trials}, settings_.space,
            [&, plain = true](std::span<Trial> trials) mutable {
              run_beside_pinned(trials, std::exchange(plain, false));
            },
            numbers, [&] { return go_on_(state_); });
        state_.searches.push_back(found.search);
        for (const Trial& trial : found.plain) {
          count_plain(trial);
          if (trial.failed > 0.0) add_plain_failure(trial, 1.0);
        }
        if (!go_on_(state_)) return false;
        if (!found.search.reached) continue;
        best = std::max(best, found.search.probability);
        add_points(found, numbers);
      }
    }
    return true;
  }

  /// Runs trials of splitting, which seeks failures apart from the pinned values. Failures at pinned values
  /// lead nowhere and count as no failures here.
  /// @param plain whether the trials are drawn from their own distribution
  void run_beside_pinned(std::span<Trial> trials, bool plain) {
    run_trials(trials);
    for (Trial& trial : trials) {
      if (!is_pinned(settings_.space, state_.proposal, trial.z)) continue;
      if (plain && trial.failed > 0.0) {
        ++state_.plain_failures;
        plain_failing_.push_back(trial.z);
      }
      trial.failed = 0.0;
      trial.scores.assign(settings_.scores, statistics::unknown);
    }
  }

  void add_points(const SplittingResult& found, NumberSource& numbers) {
    for (const Trial& trial : found.failing) searched_.add(trial.z, 1.0 / steps_per_independent_point);
    for (const std::vector<Trial>& level : found.above) {
      WeightedPoints points;
      for (const Trial& trial : level) points.add(proposal_coordinates(settings_.space, trial.z), 1.0);
      levels_.push_back(fitted_normal(points, numbers));
    }
  }

  // The proposal.

  /// The points at which no discrete draw has a pinned value of the proposal, in the coordinates of the
  /// normal components (proposal_coordinates()).
  WeightedPoints unexplained(const WeightedPoints& points) const {
    WeightedPoints found;
    for (std::size_t i = 0; i < points.z.size(); ++i) {
      if (!is_pinned(settings_.space, state_.proposal, points.z[i]))
        found.add(proposal_coordinates(settings_.space, points.z[i]), points.weights[i]);
    }
    return found;
  }

  /// Fits the normal components of the proposal: a mixture fitted to the failures found so far, and a normal
  /// distribution for each level of splitting. The failures are those drawn from earlier proposals (pilots)
  /// and those found by splitting. The latter get more weight if the pilots found few.
  void fit(NumberSource& numbers) {
    WeightedPoints points = unexplained(pilots_);
    WeightedPoints searched = unexplained(searched_);
    const double effective = effective_size(points.weights);
    if (!searched.z.empty())
      balance(searched, std::max(min_proportion_of_searched * effective,
                                 std::max(1.0, enough_pilot_failures - effective)));
    for (std::size_t i = 0; i < searched.z.size(); ++i) points.add(searched.z[i], searched.weights[i]);
    set_components(points.z.empty() ? levels_
                                    : mixed(fitted_mixture(points, numbers), levels_, proportion_of_levels));
  }

  /// Sets the normal components of the proposal. Also sets the proportions of draws from the trials' own
  /// distribution, from the pinned values and from the components. There are no components if every failure
  /// is at a pinned value.
  void set_components(std::vector<NormalComponent> components) {
    Proposal& proposal = state_.proposal;
    proposal.natural = natural_proportion;
    proposal.components = std::move(components);
    proposal.pinned = proposal.values.empty()       ? 0.0
                      : proposal.components.empty() ? 1.0
                                                    : proportion_of_pinned;
  }

  double ratio_at(std::span<const double> z) const {
    return likelihood_ratio(settings_.space, state_.proposal, z);
  }

  /// Draws a batch of trials from the proposal, and adds their failures to pilots_, from which the next
  /// proposal is fitted.
  /// @return the probability of a failing move, estimated from these trials
  double run_pilot(NumberSource& numbers) {
    WeightedPoints found;
    double sum = 0.0;
    for (const Trial& trial : draw_trials(pilot_trials, numbers)) {
      const double part = trial.weight * trial.failed;
      sum += part;
      if (part > 0.0 && !is_pinned(settings_.space, state_.proposal, trial.z)) found.add(trial.z, part);
    }
    if (!found.z.empty()) balance(found, effective_size(found.weights));
    for (std::size_t i = 0; i < found.z.size(); ++i) pilots_.add(found.z[i], found.weights[i]);
    return sum / static_cast<double>(pilot_trials);
  }

  /// Weighted 99.8 % quantile of the likelihood ratio at these points (weights: WeightedPoints::weights); 0
  /// without points. EstimatorState::cap is at least twice this value.
  double usual_largest(const WeightedPoints& points) const {
    std::vector<std::pair<double, double>> ratios;
    for (std::size_t i = 0; i < points.z.size(); ++i)
      ratios.emplace_back(ratio_at(points.z[i]), points.weights[i]);
    std::ranges::sort(ratios);
    double remaining = quantile_of_cap * sum_of(points.weights);
    for (const auto& [ratio, weight] : ratios) {
      remaining -= weight;
      if (remaining <= 0.0) return ratio;
    }
    return ratios.empty() ? 0.0 : ratios.back().first;
  }

  /// Raises EstimatorState::cap, the largest weight of a failure that the bounds allow for, to at least twice
  /// the likelihood ratio at each of these points.
  void raise_cap(const std::vector<std::vector<double>>& points) {
    for (const std::vector<double>& z : points)
      state_.cap = std::max(state_.cap, cap_beyond_usual * ratio_at(z));
  }

  // Estimation.

  void estimate_by_drawing() {
    while (!answer_of(state_, settings_).narrow) {
      if (state_.drawn.size() >= max_drawn || !go_on_(state_)) return;
      NumberSource numbers = numbers_for(fmt::format("drawn/{}", state_.learnings),
                                         static_cast<std::uint32_t>(state_.drawn.size() / drawn_at_once));
      const std::size_t count =
          std::max(drawn_at_once, state_.drawn.size() / drawn_at_once / 8 * drawn_at_once);
      std::ranges::move(draw_trials(count, numbers), std::back_inserter(state_.drawn));
      const bool is_covered = std::ranges::none_of(
          state_.drawn, [&](const Trial& trial) { return trial.weight * trial.failed > state_.cap; });
      if (!is_covered && !learn_again()) return;
    }
  }

  bool learn_again() {
    if (state_.learnings >= max_learnings) return false;
    WeightedPoints found;
    for (const Trial& trial : state_.drawn) {
      if (trial.failed > 0.0) found.add(trial.z, trial.weight * trial.failed);
    }
    const WeightedPoints unforeseen = unexplained(found);
    if (unforeseen.z.empty()) return false;
    NumberSource numbers = numbers_for("again", static_cast<std::uint32_t>(state_.learnings));
    set_components(
        mixed(std::move(state_.proposal.components), fitted_mixture(unforeseen, numbers), proportion_of_new));
    raise_cap(found.z);
    state_.drawn.clear();
    ++state_.learnings;
    return true;
  }

  // Trials.

  NumberSource numbers_for(std::string_view use, std::uint32_t stream) const {
    return NumberSource(designs::random_key(settings_.seed, fmt::format("rare/{}", use)), stream);
  }

  void run_trials(std::span<Trial> trials) {
    simulate_(trials);
    state_.trials += std::ssize(trials);
  }

  /// Runs a trial at each of these points, which are standard normal coordinates. Each trial gets a new
  /// Trial::number.
  std::vector<Trial> run_at(std::vector<std::vector<double>> points) {
    std::vector<Trial> trials;
    trials.reserve(points.size());
    for (std::vector<double>& z : points)
      trials.push_back({std::move(z), state_.trials + std::ssize(trials)});
    run_trials(trials);
    return trials;
  }

  /// Draws `count` trials from the proposal and runs them. Returns them with their weights (likelihood
  /// ratios) and without scores.
  std::vector<Trial> draw_trials(std::size_t count, NumberSource& numbers) {
    std::vector<std::vector<double>> points;
    std::vector<bool> natural;
    for (std::size_t i = 0; i < count; ++i) {
      DrawnPoint point = draw(settings_.space, state_.proposal, numbers);
      points.push_back(std::move(point.z));
      natural.push_back(point.natural);
    }
    std::vector<Trial> trials = run_at(std::move(points));
    for (std::size_t i = 0; i < count; ++i) {
      if (natural[i]) count_plain(trials[i]);
      trials[i].weight = ratio_at(trials[i].z);
      trials[i].scores = {};
    }
    return trials;
  }

  /// Adds a trial that was drawn from its own distribution to the counts of plain trials and plain failures.
  void count_plain(const Trial& trial) {
    ++state_.plain_trials;
    if (trial.failed > 0.0) ++state_.plain_failures;
  }
  void add_plain_failure(const Trial& trial, double weight) {
    searched_.add(trial.z, weight);
    plain_failing_.push_back(trial.z);
  }

  EstimatorState& state_;
  const EstimatorSettings& settings_;
  const Simulation& simulate_;
  const std::function<bool(const EstimatorState&)>& go_on_;
  /// Coordinates and weights of the failures found by plain trials and by splitting.
  WeightedPoints searched_;
  /// Coordinates of the failures found by trials that were drawn from their own distribution.
  std::vector<std::vector<double>> plain_failing_;
  /// Failures found among the trials of run_pilot(), without those at pinned values. Their weights sum to
  /// their effective sample size.
  WeightedPoints pilots_;
  /// Normal distributions fitted to the trials above each level of splitting, for all runs of splitting.
  std::vector<NormalComponent> levels_;
};

/// Confidence level of the bounds from the current proposal. The allowed error probability 1 − `confidence`
/// is divided among all proposals that may be learned in turn: 0.7 of it for the first, 0.2 for the plain
/// trials that follow a useless proposal, the rest for the others.
double confidence_of(const EstimatorState& state, double confidence) {
  const double part = state.learnings <= 1 ? 0.7
                      : state.proposal.is_natural()
                          ? 0.2
                          : 0.1 * std::ldexp(1.0, static_cast<int>(1 - state.learnings));
  return 1.0 - (1.0 - confidence) * part;
}

/// Whether splitting along the first score estimated a failure probability more than ten times the upper
/// bound `high`, in every run that reached failures. False if no run reached them. Splitting along the other
/// scores is ignored, because it may end with copies of a few failures, whose number says little.
bool splitting_disagrees(const EstimatorState& state, double high) {
  const auto is_meant = [](const ScoreSearch& search) { return search.score == 0 && search.reached; };
  return std::ranges::any_of(state.searches, is_meant) &&
         std::ranges::none_of(state.searches, [&](const ScoreSearch& search) {
           return is_meant(search) && search.probability <= disagreement * high;
         });
}

}  // namespace

ProbabilityEstimate estimate(EstimatorState& state, const EstimatorSettings& settings,
                             const Simulation& simulate,
                             const std::function<bool(const EstimatorState&)>& go_on) {
  return Estimator(state, settings, simulate, go_on).run();
}

ProbabilityEstimate answer_of(const EstimatorState& state, const EstimatorSettings& settings) {
  ProbabilityEstimate answer;
  answer.plain_high =
      statistics::clopper_pearson(state.plain_failures, state.plain_trials, settings.confidence).high;
  answer.bounds = {0.0, answer.plain_high};
  if (!state.learned || state.drawn.empty()) return answer;
  std::vector<double> values;
  for (const Trial& trial : state.drawn) {
    if (trial.failed > 0.0) values.push_back(trial.weight * trial.failed);
  }
  answer.bounds = statistics::betting_bounds(values, std::ssize(state.drawn), state.cap,
                                             confidence_of(state, settings.confidence));
  answer.probability = sum_of(values) / static_cast<double>(state.drawn.size());
  answer.bounds.high = std::min(answer.bounds.high, 1.0);
  const bool exceeds = std::ranges::any_of(values, [&](double value) { return value > state.cap; });
  answer.narrow =
      !exceeds && answer.bounds.low > 0.0 && answer.bounds.high <= settings.ratio * answer.bounds.low;
  const bool natural = state.proposal.is_natural();
  if (exceeds || (!natural && answer.narrow && splitting_disagrees(state, answer.bounds.high))) {
    answer.status = EstimateStatus::not_covered;
  } else if (answer.narrow) {
    answer.status = EstimateStatus::estimated;
  } else if (natural && state.plain_failures == 0) {
    answer.status = EstimateStatus::no_failure;
  } else if (state.drawn.size() >= max_drawn) {
    answer.status = EstimateStatus::too_many;
  }
  if (answer.status != EstimateStatus::estimated)
    answer.bounds.high = std::max(answer.bounds.high, answer.plain_high);
  return answer;
}

}  // namespace zerocount::rare
