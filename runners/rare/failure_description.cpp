#include "runners/rare/failure_description.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "analysis/parallel/parallel.hpp"
#include "analysis/statistics/quantile.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/designs/random_key.hpp"

namespace zerocount::rare {
namespace {

constexpr std::size_t usual_trials = 2000;
constexpr std::size_t max_failures = 2000;
constexpr std::size_t examined_machines = 48;
constexpr std::size_t moves_of_machine = 64;

/// A failure, and its part of the probability.
struct Failed {
  const WeightedTrial* trial;
  double weight;
};

std::vector<Failed> failures_of(const EstimatorState& state) {
  std::vector<Failed> failures;
  for (const WeightedTrial& trial : state.drawn) {
    if (trial.failed > 0.0) failures.push_back({&trial, trial.weight * trial.failed});
  }
  return failures;
}

/// So many failures drawn by their weights, at equal steps of the cumulative weight.
std::vector<const WeightedTrial*> drawn_failures(const EstimatorState& state, std::size_t count) {
  const std::vector<Failed> failures = failures_of(state);
  double sum = 0.0;
  for (const Failed& one : failures) sum += one.weight;
  std::vector<const WeightedTrial*> chosen;
  double passed = 0.0;
  for (const Failed& one : failures) {
    passed += one.weight / sum;
    while (chosen.size() < count &&
           (static_cast<double>(chosen.size()) + 0.5) / static_cast<double>(count) < passed)
      chosen.push_back(one.trial);
  }
  return chosen;
}

InputRange range_of(const std::vector<double>& sorted) {
  const auto quantile = [&](double probability) { return statistics::sample_quantile(sorted, probability); };
  return {quantile(0.05), quantile(0.5), quantile(0.95)};
}

/// Φ⁻¹ of the rank of a value in a sorted sample, with equal values in the middle.
double normal_score(const std::vector<double>& sorted, double value) {
  const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
  const double rank = 0.5 * static_cast<double>((first - sorted.begin()) + (last - sorted.begin()));
  const auto size = static_cast<double>(sorted.size());
  return numerics::normal_quantile(std::clamp(rank, 0.5, size - 0.5) / size);
}

double mean_score(const std::vector<double>& sorted, const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += normal_score(sorted, value);
  return sum / static_cast<double>(values.size());
}

/// Mean of the random coordinate that alone decides this input; nothing if there is none.
std::optional<double> mean_coordinate(const Question& question, std::string_view input,
                                      const std::vector<const WeightedTrial*>& failed) {
  if (!question.study.correlations.empty()) return std::nullopt;
  const auto coordinate = std::ranges::find(question.coordinates, input, &randomness::RandomCoordinate::name);
  if (coordinate == question.coordinates.end() ||
      coordinate->kind != randomness::RandomCoordinate::Kind::values)
    return std::nullopt;
  double sum = 0.0;
  for (const WeightedTrial* trial : failed)
    sum += trial->point.z[static_cast<std::size_t>(coordinate - question.coordinates.begin())];
  return sum / static_cast<double>(failed.size());
}

/// [input column][trial], each sorted.
std::vector<std::vector<double>> sorted_columns(const std::vector<std::vector<double>>& trials) {
  std::vector<std::vector<double>> columns(trials.front().size());
  for (const std::vector<double>& inputs : trials) {
    for (std::size_t i = 0; i < inputs.size(); ++i) columns[i].push_back(inputs[i]);
  }
  for (std::vector<double>& column : columns) std::ranges::sort(column);
  return columns;
}

/// Whether a value of the machine and one of the move are correlated, so that neither is drawn alone.
bool correlates_machine_and_move(const Question& question) {
  const auto is_of_machine = [&](const std::string& name) {
    return std::ranges::any_of(question.coordinates, [&](const randomness::RandomCoordinate& one) {
      return one.name == name && one.of_machine;
    });
  };
  return std::ranges::any_of(question.study.correlations, [&](const study::Correlation& pair) {
    return is_of_machine(pair.first) != is_of_machine(pair.second);
  });
}

/// Trials of the machine that failed, with moves of their own.
void add_moves(const Question& question, const WeightedTrial& failed, std::int64_t first_number,
               NumberSource& numbers, std::vector<study::GivenDraws>& draws) {
  const double start = trial_at(question, failed.point).parameters.initial.position;
  for (std::size_t move = 0; move < moves_of_machine; ++move) {
    TrialPoint point = failed.point;
    for (std::size_t i = 0; i < point.z.size(); ++i) {
      if (!question.coordinates[i].of_machine) point.z[i] = numbers.normal();
    }
    point.number = first_number + static_cast<std::int64_t>(draws.size());
    study::GivenDraws& one = draws.emplace_back(draws_at(question, point));
    one.rotor = failed.point.number;
    for (auto& [slot, profile] : one.profiles) profile.position = start;
  }
}

/// [point] what its trial has drawn.
std::vector<std::vector<double>> inputs_at(const Question& question, std::span<const TrialPoint> points) {
  std::vector<std::vector<double>> inputs(points.size());
  parallel::for_each_index(
      points.size(), [&](std::size_t i) { inputs[i] = trial_at(question, points[i]).inputs; }, "draw");
  return inputs;
}

}  // namespace

std::vector<FailureInput> failure_inputs(const Question& question, const EstimatorState& state) {
  const std::vector<const WeightedTrial*> failed =
      drawn_failures(state, std::min(max_failures, failures_of(state).size()));
  std::vector<FailureInput> found;
  if (failed.empty()) return found;
  NumberSource numbers(designs::random_key(question.study.seed, "rare/usual"));
  std::vector<TrialPoint> usual;
  for (std::size_t i = 0; i < usual_trials; ++i)
    usual.push_back({numbers.normals(question.coordinates.size()), static_cast<std::int64_t>(i)});
  std::vector<TrialPoint> failing;
  failing.reserve(failed.size());
  for (const WeightedTrial* trial : failed) failing.push_back(trial->point);
  const std::vector<std::vector<double>> usual_columns = sorted_columns(inputs_at(question, usual));
  const std::vector<std::vector<double>> columns = sorted_columns(inputs_at(question, failing));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::vector<double>& all = usual_columns[i];
    if (!(all.front() < all.back())) continue;
    const study::InputColumn& column = question.study.columns.inputs[i];
    found.push_back({column.name, column.unit,
                     mean_coordinate(question, column.name, failed).value_or(mean_score(all, columns[i])),
                     range_of(all), range_of(columns[i])});
  }
  std::ranges::stable_sort(found, [](const FailureInput& a, const FailureInput& b) {
    return std::abs(a.shift) > std::abs(b.shift);
  });
  return found;
}

std::optional<CarryingMachines> carrying_machines(const Question& question, const EstimatorState& state,
                                                  double probability, const trials::Effort& effort) {
  const auto of_machine =
      std::ranges::count_if(question.coordinates, &randomness::RandomCoordinate::of_machine);
  const std::vector<const WeightedTrial*> failed = drawn_failures(state, examined_machines);
  if (failed.empty() || of_machine == 0 || of_machine == std::ssize(question.coordinates) ||
      correlates_machine_and_move(question))
    return std::nullopt;
  NumberSource numbers(designs::random_key(question.study.seed, "rare/machines"));
  std::vector<study::GivenDraws> draws;
  for (const WeightedTrial* trial : failed) add_moves(question, *trial, state.trials, numbers, draws);
  const std::vector<PointResult> results = run_trials(question, draws, effort);
  std::vector<double> rates;
  CarryingMachines machines{std::ssize(failed), static_cast<std::int64_t>(moves_of_machine)};
  for (std::size_t i = 0; i < failed.size(); ++i) {
    double sum = 0.0;
    for (std::size_t move = 0; move < moves_of_machine; ++move)
      sum += results[i * moves_of_machine + move].failed;
    rates.push_back(sum / static_cast<double>(moves_of_machine));
    if (rates.back() <= 0.5) continue;
    machines.mostly_failing += 1.0 / static_cast<double>(failed.size());
    machines.probability_of_one += probability / rates.back() / static_cast<double>(failed.size());
  }
  std::ranges::sort(rates);
  machines.median_rate = statistics::sample_quantile(rates, 0.5);
  return machines;
}

}  // namespace zerocount::rare
