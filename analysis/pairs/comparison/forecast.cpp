#include "analysis/pairs/comparison/forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/statistics/quantile.hpp"
#include "core/random/random_numbers.hpp"

namespace zerocount::comparison {
namespace {

using two_samples::ContinuationDraw;
using two_samples::FileSums;
using two_samples::FileWeights;

/// Variance of those effects of measures that are not zero, in units of the squared standard error of the
/// effect.
constexpr double slab_variance = 9.0;
constexpr int expectation_steps = 40;
/// Shape of the gamma prior (Jeffreys) for the number of units of a kind that the sample does not contain,
/// such as trials that fail if all succeeded.
constexpr double jeffreys_shape = 0.5;

/// Assumption of a simulation about the true effects (differences between the two studies).
enum class Truth {
  as_seen,    ///< The true effects are the estimated ones, with their uncertainty.
  some_zero,  ///< The true effects are the estimated ones, but each is zero with its posterior probability.
  /// There is no effect: both studies are from one population, and the sample is from one of them.
  no_effect,
};

/// Random weight of a kind of unit that the sample does not contain, drawn from its posterior, the gamma
/// distribution of shape ½.
/// @param bits 64 random bits
double unseen_weight(std::uint64_t bits) {
  const double z = random::standard_normal(bits);
  return jeffreys_shape * z * z;
}

/// Result of one simulated comparison with more trials: whether it is decided, as a whole and in each
/// judgement.
struct SimulatedComparison {
  bool decided{false};
  std::vector<bool> each;       ///< [judgement] Whether the judgement is decided (not inconclusive).
  std::vector<double> margins;  ///< [measure] Margin above which the measure would be decided, in its unit.
};

class Simulator {
 public:
  Simulator(const ForecastSamples& samples, const ForecastOptions& options)
      : samples_(samples), options_(options) {
    std::vector<double> z;
    for (const ForecastSamples::SampledMeasure& measure : samples.measures()) {
      const double error = standard_error_of(measure.found.bounds, options.confidence);
      z.push_back(error > 0.0 ? measure.found.effect / error : 0.0);
    }
    zero_probabilities_ = zero_difference_probabilities(z);
  }

  double trials() const {
    return static_cast<double>(std::max(samples_.trials_of(0), samples_.trials_of(1)));
  }
  std::size_t judgements() const { return samples_.measures().size() + samples_.requirements().size(); }

  /// [assumption] One simulated comparison under each assumption in `truths`; all of them use the same random
  /// numbers.
  /// @param trials number of trials per design point
  /// @param simulation number of the simulation, which selects the random numbers
  std::vector<SimulatedComparison> simulate(double trials, const std::vector<Truth>& truths,
                                            std::uint32_t simulation) const {
    FileWeights population;
    FileWeights further;
    for (std::size_t file = 0; file < 2; ++file) {
      const two_samples::Continuation& continuation = samples_.continuations()[file];
      population[file] = samples_.continuations()[population_of(file)].population(simulation);
      further[file] = continuation.further_units(population[file], more_units(file, trials), simulation);
    }
    const std::vector<FileSums> sums = further_sums(further, simulation, trials);
    const std::vector<GateVerdict> requirements = requirement_verdicts(further, simulation, trials);
    std::vector<SimulatedComparison> outcomes;
    for (const Truth truth : truths) {
      std::vector<TestedMeasure> tested;
      for (std::size_t i = 0; i < sums.size(); ++i)
        tested.push_back(tested_measure(i, population, sums[i], is_zero(i, truth, simulation)));
      decide(tested, options_.false_discovery_rate);
      outcomes.push_back(outcome_of(tested, requirements, truth));
    }
    return outcomes;
  }

 private:
  /// Index of the file (0: baseline, 1: current) whose sample represents the population of the file `file`.
  std::uint32_t population_of(std::size_t file) const {
    return samples_.one_sample() ? 1 : static_cast<std::uint32_t>(file);
  }

  double more_units(std::size_t file, double trials) const {
    const auto units = static_cast<double>(samples_.continuations()[file].units());
    const auto there = static_cast<double>(samples_.trials_of(file));
    return samples_.one_sample() ? units * trials / there : std::max(0.0, units * trials / there - units);
  }

  /// Random number of units of a kind that the sample of the file does not contain but further trials bring.
  /// The number is the same for all measures of a point.
  /// @param kind 0: units that fail, 1: units that succeed; for pairs, those of which only one fails, in the
  /// two directions
  /// @param trials number of trials per design point
  double unseen_units(std::size_t file, std::size_t point, std::uint32_t kind, std::uint32_t simulation,
                      double trials) const {
    const double weight = unseen_weight(two_samples::continuation_bits(
        simulation, 2 * kind + population_of(file), point, ContinuationDraw::unseen_kind));
    const double mean =
        weight * more_units(file, trials) / static_cast<double>(samples_.continuations()[file].units());
    return two_samples::poisson_number(
        mean, two_samples::continuation_bits(simulation, 2 * kind + static_cast<std::uint32_t>(file), point,
                                             ContinuationDraw::unseen_units));
  }

  bool is_zero(std::size_t measure, Truth truth, std::uint32_t simulation) const {
    if (truth != Truth::some_zero) return false;
    const double u = random::open_uniform(
        two_samples::continuation_bits(simulation, 0, measure, ContinuationDraw::nil_effect));
    return u < zero_probabilities_[measure];
  }

  /// [measure] Sums over the units that the further trials bring, for both files.
  std::vector<FileSums> further_sums(const FileWeights& further, std::uint32_t simulation,
                                     double trials) const {
    std::vector<FileSums> all;
    for (const auto& [point, found, sample] : samples_.measures()) {
      FileSums& sums = all.emplace_back(sample.weighted(further));
      for (std::size_t file = 0; sample.failures() && file < (sample.paired() ? 1U : 2U); ++file)
        sample.add_unseen(sums[file], unseen_units(file, point, 0, simulation, trials),
                          unseen_units(file, point, 1, simulation, trials));
    }
    return all;
  }

  TestedMeasure tested_measure(std::size_t i, const FileWeights& population, FileSums sums, bool zero) const {
    const auto& [point, found, sample] = samples_.measures()[i];
    if (zero) sample.remove_effect(sums, sample.weighted(population));
    if (!samples_.one_sample()) {
      const FileSums seen = sample.seen();
      for (std::size_t file = 0; file < sums.size(); ++file) two_samples::add(sums[file], seen[file]);
    }
    TestedMeasure tested = found;
    static_cast<two_samples::Change&>(tested) =
        sample.change_of(sums, options_.confidence, !zero, found.margin);
    return tested;
  }

  std::vector<GateVerdict> requirement_verdicts(const FileWeights& further, std::uint32_t simulation,
                                                double trials) const {
    std::vector<GateVerdict> verdicts;
    for (const auto& [point, asked, seen] : samples_.requirements()) {
      two_samples::Sums sums = seen.weighted(further[1]);
      two_samples::add(sums, seen.seen());
      if (asked.kind != RequirementKind::mean && !asked.clustered) {
        const double missed = unseen_units(1, point, 0, simulation, trials);
        const double met = unseen_units(1, point, 1, simulation, trials);
        sums[1] += met;
        sums[2] += met + missed;
      }
      verdicts.push_back(requirement_verdict(asked, sums, options_.confidence, options_.failing_confidence));
    }
    return verdicts;
  }

  /// The result of a simulated comparison, from its tested measures and its verdicts on requirements. Under
  /// Truth::no_effect it is decided only if all measures are found equivalent; a false alarm does not decide
  /// it.
  SimulatedComparison outcome_of(const std::vector<TestedMeasure>& tested,
                                 const std::vector<GateVerdict>& requirements, Truth truth) const {
    SimulatedComparison outcome;
    bool failed = false;
    const auto add = [&](GateVerdict verdict, bool decided) {
      failed = failed || fails(verdict);
      outcome.each.push_back(decided);
    };
    for (const TestedMeasure& measure : tested) {
      const GateVerdict verdict = gate_verdict(measure.change, measure.changed_fails);
      add(verdict, truth == Truth::no_effect ? measure.change == ChangeVerdict::equivalent
                                             : verdict != GateVerdict::inconclusive);
      outcome.margins.push_back(largest_possible_change(measure));
    }
    for (const GateVerdict verdict : requirements) add(verdict, verdict != GateVerdict::inconclusive);
    outcome.decided =
        std::ranges::find(outcome.each, false) == outcome.each.end() || (failed && truth != Truth::no_effect);
    return outcome;
  }

  const ForecastSamples& samples_;
  ForecastOptions options_;
  std::vector<double> zero_probabilities_;  ///< [measure] Posterior probability that the true effect is zero.
};

/// Results of the simulations with one number of trials: proportions of them that decide, and decided
/// margins.
struct Chances {
  double whole{1.0};         ///< Proportion of the simulations that decide the whole comparison.
  std::vector<double> each;  ///< [judgement] Proportion of the simulations that decide the judgement.
  /// [measure] Smallest margin that is decided with the stated probability, in the measure's unit.
  std::vector<double> margins;
};

/// The proportions and margins under one assumption about the true effects.
/// @param outcomes [simulation][assumption] simulated comparisons
/// @param assumption index of the assumption
/// @param probability probability with which a margin must be decided
Chances chances_under(const std::vector<std::vector<SimulatedComparison>>& outcomes, std::size_t assumption,
                      double probability) {
  const auto proportion = [&](const auto& is) {
    const auto count = std::count_if(outcomes.begin(), outcomes.end(),
                                     [&](const auto& simulation) { return is(simulation[assumption]); });
    return static_cast<double>(count) / static_cast<double>(outcomes.size());
  };
  Chances chances;
  chances.whole = proportion([](const SimulatedComparison& one) { return one.decided; });
  const SimulatedComparison& first = outcomes.front()[assumption];
  for (std::size_t k = 0; k < first.each.size(); ++k)
    chances.each.push_back(proportion([&](const SimulatedComparison& one) { return one.each[k]; }));
  for (std::size_t k = 0; k < first.margins.size(); ++k) {
    std::vector<double> margins;
    margins.reserve(outcomes.size());
    for (const auto& simulation : outcomes) margins.push_back(simulation[assumption].margins[k]);
    chances.margins.push_back(statistics::sample_quantile(std::move(margins), probability));
  }
  return chances;
}

/// The results of the simulations with `trials` trials per design point. Each proportion and margin is the
/// least favourable one over all assumptions in `truths`.
Chances chances_with(const Simulator& simulator, double trials, const std::vector<Truth>& truths,
                     const ForecastOptions& options) {
  std::vector<std::vector<SimulatedComparison>> outcomes(static_cast<std::size_t>(options.simulations));
  parallel::for_each_index(outcomes.size(), [&](std::size_t i) {
    outcomes[i] = simulator.simulate(trials, truths, static_cast<std::uint32_t>(i));
  });
  Chances lowest = chances_under(outcomes, 0, options.probability);
  for (std::size_t i = 1; i < truths.size(); ++i) {
    const Chances other = chances_under(outcomes, i, options.probability);
    lowest.whole = std::min(lowest.whole, other.whole);
    for (std::size_t k = 0; k < lowest.each.size(); ++k)
      lowest.each[k] = std::min(lowest.each[k], other.each[k]);
    for (std::size_t k = 0; k < lowest.margins.size(); ++k)
      lowest.margins[k] = std::max(lowest.margins[k], other.margins[k]);
  }
  return lowest;
}

/// Number of trials at which the probability of a decision reaches `probability`, by interpolation that is
/// linear in the logarithm of the number of trials.
/// @param few, low a number of trials, and the probability of a decision with it
/// @param many, high a larger number of trials, and the probability of a decision with it
double crossing_between(double few, double low, double many, double high, double probability) {
  if (high <= low) return many;
  const double part = std::clamp((probability - low) / (high - low), 0.0, 1.0);
  return std::exp(std::log(few) + part * std::log(many / few));
}

Forecast search(const Simulator& simulator, const std::vector<Truth>& truths,
                const ForecastOptions& options) {
  Forecast forecast;
  forecast.judgements.resize(simulator.judgements());
  const double there = simulator.trials();
  Chances before{0.0, std::vector<double>(forecast.judgements.size(), 0.0), {}};
  double trials_before = there * options.min_factor;
  for (double factor = options.min_factor;;
       factor = std::min(factor * options.factor_step, options.max_factor)) {
    const double trials = there * factor;
    const Chances now = chances_with(simulator, trials, truths, options);
    const auto take = [&](std::optional<double>& found, double low, double high) {
      if (!found && high >= options.probability)
        found = std::ceil(crossing_between(trials_before, low, trials, high, options.probability));
    };
    take(forecast.trials, before.whole, now.whole);
    bool open = !forecast.trials;
    for (std::size_t k = 0; k < now.each.size(); ++k) {
      JudgementForecast& one = forecast.judgements[k];
      take(one.trials, before.each[k], now.each[k]);
      if (k < now.margins.size()) one.margin = now.margins[k];
      open = open || !one.trials;
    }
    forecast.max_trials = trials;
    if (!open || factor >= options.max_factor) return forecast;
    before = now;
    trials_before = trials;
  }
}

}  // namespace

std::vector<double> zero_difference_probabilities(const std::vector<double>& z) {
  std::vector<double> zero(z.size(), 0.5);
  const auto measures = static_cast<double>(z.size());
  double weight = 0.5;
  for (int step = 0; step < expectation_steps; ++step) {
    double sum = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double none = weight * std::exp(-0.5 * z[i] * z[i]);
      const double some = (1.0 - weight) * std::exp(-0.5 * z[i] * z[i] / (1.0 + slab_variance)) /
                          std::sqrt(1.0 + slab_variance);
      zero[i] = none / (none + some);
      sum += zero[i];
    }
    weight = (sum + 1.0) / (measures + 2.0);
  }
  return zero;
}

void limit_work(ForecastOptions& options, std::size_t judgements) {
  constexpr double max_simulated = 1e6;  // judgements, in all simulations of one number of trials
  const int affordable =
      static_cast<int>(max_simulated / static_cast<double>(std::max<std::size_t>(judgements, 1)));
  if (affordable >= options.simulations) return;
  options.simulations = std::max(affordable, options.simulations / 8);
  options.factor_step *= options.factor_step;
}

ForecastSamples::ForecastSamples(std::array<std::int64_t, 2> units, bool one_sample)
    : one_sample_(one_sample),
      continuations_{two_samples::Continuation(units[0], 0), two_samples::Continuation(units[1], 1)} {}

void ForecastSamples::add_point(std::int64_t baseline_trials, std::int64_t current_trials) {
  trials_ = {std::max(trials_[0], baseline_trials), std::max(trials_[1], current_trials)};
  ++points_;
}

void ForecastSamples::add(const TestedMeasure& found, two_samples::Sample sample) {
  if (one_sample_) sample.baseline = sample.current;
  measures_.push_back({points_ - 1, found, two_samples::ContinuedSample(sample, continuations_)});
}

void ForecastSamples::add(RequirementSample requirement) {
  std::vector<two_samples::Sums> units;
  for (std::size_t i = 0; i < requirement.hits.size(); ++i)
    units.push_back(sums_of_unit(requirement.hits[i], requirement.events[i]));
  requirement.hits = requirement.events = {};
  requirements_.push_back(
      {points_ - 1, std::move(requirement), two_samples::BlockedSums(units, continuations_[1])});
}

Forecast forecast_decision(const ForecastSamples& samples, const ForecastOptions& options) {
  return search(Simulator(samples, options), {Truth::as_seen, Truth::some_zero}, options);
}

Forecast forecast_equivalence(const ForecastSamples& pilot, const ForecastOptions& options) {
  return search(Simulator(pilot, options), {Truth::no_effect}, options);
}

}  // namespace zerocount::comparison
