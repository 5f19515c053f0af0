#include "analysis/comparison/forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <oneapi/tbb/parallel_for.h>

#include "analysis/comparison/judged_sample.hpp"
#include "analysis/statistics/normal.hpp"
#include "core/random/random_numbers.hpp"
#include "core/random/variates.hpp"

namespace zerocount::comparison {
namespace {

constexpr double factor_step = 1.4;    ///< between the numbers of trials that are tried
constexpr double slab_variance = 9.0;  ///< of effects that are not nil, in units of the standard error
constexpr int expectation_steps = 40;
constexpr double jeffreys_shape = 0.5;  ///< weight of a kind of unit that was not seen, in units

/// An assumption about the true effects.
enum class Truth {
  as_seen,    ///< as seen, with their uncertainty
  some_nil,   ///< likewise, but some are nil
  no_effect,  ///< two studies of one population, and what was seen is of one of them
};

/// A measure or a requirement at a point.
struct Judged {
  std::size_t point{0};
  const TestedMeasure* found{nullptr};  ///< of a measure
  double nil{0.0};                      ///< of a measure: probability that its effect is nil
  const RequirementSample* requirement{nullptr};
};

/// A weight of the gamma distribution of shape ½: the posterior part of a kind of unit that was not seen.
double unseen_weight(std::uint64_t bits) {
  const double z = random::standard_normal(bits);
  return jeffreys_shape * z * z;
}

SampleSums sums_of_requirement(double hits, double events) {
  return {1.0, hits, events, hits * hits, hits * events, events * events};
}

/// The result of a simulated comparison.
struct SimulatedComparison {
  bool decided{false};
  std::vector<bool> each;       ///< [judgement] decided
  std::vector<double> margins;  ///< [measure] that would have decided it
};

class Simulator {
 public:
  Simulator(const std::vector<ForecastPoint>& points, const ForecastOptions& options, bool one_sample)
      : options_(options), one_sample_(one_sample), continuations_(continuations_of(points, one_sample)) {
    for (const ForecastPoint& point : points) {
      trials_ = std::max({trials_, point.baseline_trials, point.current_trials});
      trials_of_[0] = std::max(trials_of_[0], point.baseline_trials);
      trials_of_[1] = std::max(trials_of_[1], point.current_trials);
    }
    add_measures(points);
    add_requirements(points);
  }

  std::int64_t trials() const { return trials_; }
  const std::vector<Judged>& judged() const { return judged_; }
  std::size_t measures() const { return measures_.size(); }

  /// A comparison under each of the assumptions, from the same random numbers.
  std::vector<SimulatedComparison> simulate(double trials, const std::vector<Truth>& truths,
                                            std::uint32_t simulation) const {
    FileWeights population;
    FileWeights further;
    for (std::size_t file = 0; file < 2; ++file) {
      const Continuation& continuation = continuations_[file];
      population[file] = continuations_[one_sample_ ? 1 : file].population(simulation);
      further[file] = continuation.further_units(population[file], more_units(file, trials), simulation);
    }
    const std::vector<FileSums> sums = further_sums(further, simulation, trials);
    const std::vector<GateVerdict> requirements = requirement_verdicts(further, simulation, trials);
    std::vector<SimulatedComparison> outcomes;
    for (const Truth truth : truths) {
      std::vector<TestedMeasure> tested;
      for (std::size_t i = 0; i < measures_.size(); ++i)
        tested.push_back(tested_measure(i, population, sums[i], is_nil(i, truth, simulation)));
      decide(tested, options_.false_discovery_rate);
      outcomes.push_back(outcome_of(tested, requirements, truth));
    }
    return outcomes;
  }

 private:
  static std::array<Continuation, 2> continuations_of(const std::vector<ForecastPoint>& points, bool one) {
    std::array<std::int64_t, 2> units{1, 1};
    for (const ForecastPoint& point : points) {
      for (const MeasureSample& sample : point.measures) {
        units = {std::max(units[0], std::ssize(one ? sample.current : sample.baseline)),
                 std::max(units[1], std::ssize(sample.current))};
      }
      for (const RequirementSample& sample : point.requirements)
        units[1] = std::max(units[1], std::ssize(sample.hits));
    }
    return {Continuation(units[0], 0), Continuation(units[1], 1)};
  }

  void add_measures(const std::vector<ForecastPoint>& points) {
    std::vector<double> z;
    for (std::size_t point = 0; point < points.size(); ++point) {
      for (std::size_t i = 0; i < points[point].measures.size(); ++i) {
        MeasureSample sample = points[point].measures[i];
        if (one_sample_) sample.baseline = sample.current;
        measures_.emplace_back(sample, continuations_);
        const TestedMeasure& found = points[point].found[i];
        judged_.push_back({point, &found, 0.0, nullptr});
        const double error =
            (found.bounds.high - found.bounds.low) / 2.0 / statistics::normal_quantile(options_.confidence);
        z.push_back(error > 0.0 ? found.effect / error : 0.0);
      }
    }
    const std::vector<double> nil = nil_probabilities(z);
    for (std::size_t i = 0; i < nil.size(); ++i) judged_[i].nil = nil[i];
  }

  void add_requirements(const std::vector<ForecastPoint>& points) {
    for (std::size_t point = 0; point < points.size(); ++point) {
      for (const RequirementSample& sample : points[point].requirements) {
        judged_.push_back({point, nullptr, 0.0, &sample});
        std::vector<SampleSums> rows;
        for (std::size_t i = 0; i < sample.hits.size(); ++i)
          rows.push_back(sums_of_requirement(sample.hits[i], sample.events[i]));
        requirements_.emplace_back(rows, continuations_[1]);
      }
    }
  }

  double more_units(std::size_t file, double trials) const {
    const auto units = static_cast<double>(continuations_[file].units());
    const auto there = static_cast<double>(std::max<std::int64_t>(1, trials_of_[file]));
    return one_sample_ ? units * trials / there : std::max(0.0, units * trials / there - units);
  }

  /// Number of further units of a kind that the sample of the file does not have, the same for all measures
  /// of a point.
  double unseen_units(std::size_t file, std::size_t point, std::uint32_t kind, std::uint32_t simulation,
                      double trials) const {
    const auto stream = 2 * kind + static_cast<std::uint32_t>(file);
    const auto population = 2 * kind + static_cast<std::uint32_t>(one_sample_ ? 1 : file);
    const double weight =
        unseen_weight(continuation_bits(simulation, population, point, ContinuationDraw::unseen_kind));
    const double mean = weight * more_units(file, trials) / static_cast<double>(continuations_[file].units());
    return poisson_number(mean, continuation_bits(simulation, stream, point, ContinuationDraw::unseen_units));
  }

  bool is_nil(std::size_t measure, Truth truth, std::uint32_t simulation) const {
    if (truth != Truth::some_nil) return false;
    const double u =
        random::open_uniform(continuation_bits(simulation, 0, measure, ContinuationDraw::nil_effect));
    return u < judged_[measure].nil;
  }

  /// The sums over the further units of each measure.
  std::vector<FileSums> further_sums(const FileWeights& further, std::uint32_t simulation,
                                     double trials) const {
    std::vector<FileSums> all;
    for (std::size_t i = 0; i < measures_.size(); ++i) {
      const JudgedMeasure& measure = measures_[i];
      FileSums& sums = all.emplace_back(measure.weighted(further));
      if (!measure.proportion()) continue;
      for (std::size_t file = 0; file < (measure.paired() ? 1U : 2U); ++file) {
        measure.add_unseen(sums[file], unseen_units(file, judged_[i].point, 0, simulation, trials),
                           unseen_units(file, judged_[i].point, 1, simulation, trials));
      }
    }
    return all;
  }

  TestedMeasure tested_measure(std::size_t i, const FileWeights& population, FileSums sums, bool nil) const {
    const JudgedMeasure& measure = measures_[i];
    if (nil) measure.remove_effect(sums, measure.weighted(population));
    if (!one_sample_) {
      const FileSums seen = measure.seen();
      for (std::size_t file = 0; file < sums.size(); ++file) {
        for (std::size_t k = 0; k < seen[file].size(); ++k) sums[file][k] += seen[file][k];
      }
    }
    TestedMeasure tested = *judged_[i].found;
    const QuickResult result = measure.test(sums, options_.confidence, !nil);
    tested.effect = result.effect;
    tested.bounds = result.bounds;
    tested.p = result.p;
    tested.improvement_p = result.improvement_p;
    return tested;
  }

  std::vector<GateVerdict> requirement_verdicts(const FileWeights& further, std::uint32_t simulation,
                                                double trials) const {
    std::vector<GateVerdict> verdicts;
    for (std::size_t i = 0; i < requirements_.size(); ++i) {
      const Judged& judged = judged_[measures_.size() + i];
      SampleSums sums = requirements_[i].weighted(further[1]);
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += requirements_[i].seen()[k];
      if (judged.requirement->kind != RequirementKind::mean && !judged.requirement->clustered) {
        const double missed = unseen_units(1, judged.point, 0, simulation, trials);
        const double met = unseen_units(1, judged.point, 1, simulation, trials);
        sums[1] += met;
        sums[2] += met + missed;
      }
      verdicts.push_back(requirement_verdict(*judged.requirement,
                                             {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]},
                                             options_.confidence, options_.failing_confidence));
    }
    return verdicts;
  }

  /// Two equal studies are decided if they are found equivalent. A false alarm decides nothing.
  SimulatedComparison outcome_of(const std::vector<TestedMeasure>& tested,
                                 const std::vector<GateVerdict>& requirements, Truth truth) const {
    SimulatedComparison outcome;
    bool failed = false;
    bool all = true;
    for (const TestedMeasure& measure : tested) {
      const GateVerdict verdict = gate_verdict(measure.change, measure.changed_fails);
      const bool decided = truth == Truth::no_effect ? measure.change == ChangeVerdict::equivalent
                                                     : verdict != GateVerdict::inconclusive;
      failed = failed || fails(verdict);
      all = all && decided;
      outcome.each.push_back(decided);
      outcome.margins.push_back(measure.changed_fails ? std::max(measure.bounds.high, -measure.bounds.low)
                                                      : measure.bounds.high);
    }
    for (const GateVerdict verdict : requirements) {
      failed = failed || fails(verdict);
      all = all && verdict != GateVerdict::inconclusive;
      outcome.each.push_back(verdict != GateVerdict::inconclusive);
    }
    outcome.decided = all || (failed && truth != Truth::no_effect);
    return outcome;
  }

  ForecastOptions options_;
  bool one_sample_;
  std::array<Continuation, 2> continuations_;
  std::vector<JudgedMeasure> measures_;
  std::vector<BlockedSums> requirements_;
  std::vector<Judged> judged_;  ///< measures, then requirements
  std::int64_t trials_{1};
  std::array<std::int64_t, 2> trials_of_{1, 1};
};

/// Proportions of the simulations that decide, with so many trials.
struct Chances {
  double whole{1.0};
  std::vector<double> each;     ///< [judgement]
  std::vector<double> margins;  ///< [measure] decided with the stated probability
};

/// The value that a proportion `probability` of `values` do not exceed.
double quantile_of(std::vector<double> values, double probability) {
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(probability * static_cast<double>(values.size()))) - 1;
  const auto place = values.begin() + std::max<std::ptrdiff_t>(0, rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The proportions among simulated comparisons, [simulation][assumption], under one assumption.
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
    chances.margins.push_back(quantile_of(std::move(margins), probability));
  }
  return chances;
}

/// The least favourable of all assumptions.
Chances chances_with(const Simulator& simulator, double trials, const std::vector<Truth>& truths,
                     const ForecastOptions& options) {
  std::vector<std::vector<SimulatedComparison>> outcomes(static_cast<std::size_t>(options.simulations));
  oneapi::tbb::parallel_for(std::size_t{0}, outcomes.size(), [&](std::size_t i) {
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

/// Where a chance that rises with the logarithm of the trials reaches the probability.
double crossing_between(double few, double low, double many, double high, double probability) {
  if (high <= low) return many;
  const double part = std::clamp((probability - low) / (high - low), 0.0, 1.0);
  return std::exp(std::log(few) + part * std::log(many / few));
}

Forecast search(const Simulator& simulator, const std::vector<Truth>& truths,
                const ForecastOptions& options) {
  Forecast forecast;
  forecast.judgements.resize(simulator.judged().size());
  const auto there = static_cast<double>(simulator.trials());
  Chances before{0.0, std::vector<double>(forecast.judgements.size(), 0.0), {}};
  double trials_before = there * options.min_factor;
  for (double factor = options.min_factor;; factor = std::min(factor * factor_step, options.max_factor)) {
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

std::vector<double> nil_probabilities(const std::vector<double>& z) {
  std::vector<double> nil(z.size(), 0.5);
  const auto measures = static_cast<double>(z.size());
  double weight = 0.5;
  for (int step = 0; step < expectation_steps; ++step) {
    double sum = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double none = weight * std::exp(-0.5 * z[i] * z[i]);
      const double some = (1.0 - weight) * std::exp(-0.5 * z[i] * z[i] / (1.0 + slab_variance)) /
                          std::sqrt(1.0 + slab_variance);
      nil[i] = none / (none + some);
      sum += nil[i];
    }
    weight = (sum + 1.0) / (measures + 2.0);
  }
  return nil;
}

Forecast forecast_decision(const std::vector<ForecastPoint>& points, const ForecastOptions& options) {
  return search(Simulator(points, options, false), {Truth::as_seen, Truth::some_nil}, options);
}

Forecast forecast_equivalence(const std::vector<ForecastPoint>& pilot, const ForecastOptions& options) {
  return search(Simulator(pilot, options, true), {Truth::no_effect}, options);
}

}  // namespace zerocount::comparison
