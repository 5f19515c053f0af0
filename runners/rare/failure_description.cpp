#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string_view>
#include <utility>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "core/numerics/normal_distribution.hpp"
#include "experiments/designs/designs.hpp"
#include "runners/rare/rare_run.hpp"

namespace zerocount::rare {
namespace {

constexpr std::int64_t usual_trials = 2000;
constexpr std::int64_t max_failures = 2000;
constexpr std::int64_t examined_machines = 48;
constexpr std::int64_t moves_of_machine = 64;

/// Chooses `count` of the failed trials with a frequency proportional to weight × failed proportion
/// (systematic sampling: equal steps of the cumulative weight). A trial may be chosen several times.
std::vector<Trial> drawn_failures(const EstimatorState& state, std::int64_t count) {
  double sum = 0.0;
  for (const Trial& trial : state.drawn) sum += trial.weight * trial.failed;
  std::vector<Trial> chosen;
  double passed = 0.0;
  for (const Trial& trial : state.drawn) {
    if (!(trial.failed > 0.0)) continue;
    passed += trial.weight * trial.failed / sum;
    while (std::ssize(chosen) < count &&
           (static_cast<double>(chosen.size()) + 0.5) / static_cast<double>(count) < passed)
      chosen.push_back(trial);
  }
  return chosen;
}

InputRange range_of(const std::vector<double>& sorted) {
  const auto quantile = [&](double probability) { return statistics::sample_quantile(sorted, probability); };
  return {quantile(0.05), quantile(0.5), quantile(0.95)};
}

/// Normal score of a value in a sorted sample: standard normal quantile Φ⁻¹ of its relative rank. Equal
/// values have their mean rank.
double normal_score(const std::vector<double>& sorted, double value) {
  const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
  const double rank = 0.5 * static_cast<double>((first - sorted.begin()) + (last - sorted.begin()));
  const auto size = static_cast<double>(sorted.size());
  return numerics::normal_quantile(std::clamp(rank, 0.5, size - 0.5) / size);
}

template <class Values, class Get>
double mean_of(const Values& values, const Get& get) {
  double sum = 0.0;
  for (const auto& value : values) sum += get(value);
  return sum / static_cast<double>(values.size());
}

/// Mean over the failed trials of the standard normal coordinate that alone decides this input. Nothing if
/// there is no such coordinate, or if the study has correlations.
std::optional<double> mean_coordinate(const Question& question, std::string_view input,
                                      const std::vector<Trial>& failed) {
  if (!question.study.correlations.empty()) return std::nullopt;
  const auto coordinate = std::ranges::find(question.coordinates, input, &randomness::RandomCoordinate::name);
  if (coordinate == question.coordinates.end() ||
      coordinate->kind != randomness::RandomCoordinate::Kind::values)
    return std::nullopt;
  const auto index = static_cast<std::size_t>(coordinate - question.coordinates.begin());
  return mean_of(failed, [&](const Trial& trial) { return trial.z[index]; });
}

/// [input column] Values of this input in all the trials, sorted in ascending order.
std::vector<std::vector<double>> sorted_inputs(const Question& question, const std::vector<Trial>& trials) {
  std::vector<std::vector<double>> inputs(trials.size());
  parallel::for_each_index(
      trials.size(), [&](std::size_t i) { inputs[i] = trial_at(question, trials[i]).inputs; }, "draw");
  std::vector<std::vector<double>> columns(inputs.front().size());
  for (const std::vector<double>& of_trial : inputs) {
    for (std::size_t i = 0; i < of_trial.size(); ++i) columns[i].push_back(of_trial[i]);
  }
  for (std::vector<double>& column : columns) std::ranges::sort(column);
  return columns;
}

/// Whether a value drawn per machine is correlated with a value drawn per move. Then the machine cannot be
/// kept while new moves are drawn.
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

}  // namespace

std::vector<FailureInput> failure_inputs(const Question& question, const EstimatorState& state) {
  const std::vector<Trial> failed = drawn_failures(state, std::min(max_failures, state.failures()));
  std::vector<FailureInput> found;
  if (failed.empty()) return found;
  NumberSource numbers(designs::random_key(question.study.seed, "rare/usual"));
  std::vector<Trial> usual;
  for (std::int64_t i = 0; i < usual_trials; ++i)
    usual.push_back({numbers.normals(question.coordinates.size()), i});
  const std::vector<std::vector<double>> usual_columns = sorted_inputs(question, usual);
  const std::vector<std::vector<double>> columns = sorted_inputs(question, failed);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::vector<double>& all = usual_columns[i];
    if (!(all.front() < all.back())) continue;
    const study::InputColumn& column = question.study.columns.inputs[i];
    const std::optional<double> shift = mean_coordinate(question, column.name, failed);
    found.push_back({column.name, column.unit,
                     shift ? *shift : mean_of(columns[i], [&](double x) { return normal_score(all, x); }),
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
  const std::vector<Trial> failed = drawn_failures(state, examined_machines);
  if (failed.empty() || of_machine == 0 || of_machine == std::ssize(question.coordinates) ||
      correlates_machine_and_move(question))
    return std::nullopt;
  NumberSource numbers(designs::random_key(question.study.seed, "rare/machines"));
  std::vector<Trial> moves;  // of each machine in turn
  std::vector<study::GivenDraws> draws;
  for (const Trial& machine : failed) {
    const double start = trial_at(question, machine).parameters.initial.position;
    for (std::int64_t i = 0; i < moves_of_machine; ++i) {
      Trial& move = moves.emplace_back(machine);
      for (std::size_t k = 0; k < move.z.size(); ++k) {
        if (!question.coordinates[k].of_machine) move.z[k] = numbers.normal();
      }
      move.number = state.trials + std::ssize(draws);
      study::GivenDraws& given = draws.emplace_back(draws_at(question, move));
      given.rotor = machine.number;
      for (auto& [slot, profile] : given.profiles) profile.position = start;
    }
  }
  run_trials(question, moves, effort, std::move(draws));
  const auto count = static_cast<double>(failed.size());
  CarryingMachines machines{std::ssize(failed), moves_of_machine};
  std::vector<double> rates;
  for (std::size_t i = 0; i < failed.size(); ++i) {
    rates.push_back(mean_of(std::span(moves).subspan(i * moves_of_machine, moves_of_machine),
                            std::mem_fn(&Trial::failed)));
    if (rates.back() <= 0.5) continue;
    machines.mostly_failing += 1.0 / count;
    machines.probability_of_one += probability / rates.back() / count;
  }
  std::ranges::sort(rates);
  machines.median_rate = statistics::sample_quantile(rates, 0.5);
  return machines;
}

}  // namespace zerocount::rare
