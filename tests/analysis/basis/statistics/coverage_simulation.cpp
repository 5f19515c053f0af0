#include "tests/analysis/basis/statistics/coverage_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/random/beta_distribution.hpp>

#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/trials/measures/point_accumulator.hpp"

namespace zerocount::testing {
namespace {

constexpr double sample_time = 0.5e-3;
constexpr double hold = 1.0;
constexpr double median_time = 0.06;
constexpr double alike = 0.5;  // probability that a trial decides once for all of its moves

/// The distribution of the probabilities with which the machines of a population end their moves at zero
/// error.
class SuccessLaw {
 public:
  explicit SuccessLaw(const Population& population)
      : mean_(population.success_mean),
        weak_machines_(population.weak_machines),
        weak_success_(population.weak_success) {
    if (population.success_sd == 0.0) return;
    const double size = mean_ * (1.0 - mean_) / (population.success_sd * population.success_sd) - 1.0;
    a_ = mean_ * size;
    b_ = (1.0 - mean_) * size;
  }
  template <class Random>
  double draw(Random& random) const {
    if (weak_machines_ > 0.0)
      return std::bernoulli_distribution(weak_machines_)(random) ? weak_success_ : 1.0;
    return a_ > 0.0 ? boost::random::beta_distribution<double>(a_, b_)(random) : mean_;
  }
  /// Probability that a trial succeeds in all its moves, on a machine that succeeds in a move with
  /// probability q.
  static double of_trial(double q, std::int64_t moves) {
    return alike * q + (1.0 - alike) * std::pow(q, static_cast<double>(moves));
  }
  /// Mean of a function of the success probability over all machines.
  template <class Function>
  double mean_over_machines(Function function) const {
    if (weak_machines_ > 0.0)
      return weak_machines_ * function(weak_success_) + (1.0 - weak_machines_) * function(1.0);
    if (a_ == 0.0) return function(mean_);
    constexpr int nodes = 4000;
    const boost::math::beta_distribution<double> beta(a_, b_);
    double sum = 0.0;
    for (int i = 0; i < nodes; ++i) sum += function(boost::math::quantile(beta, (i + 0.5) / nodes));
    return sum / nodes;
  }
  /// Proportion of machines whose success probability q is at least `bound`.
  double machines_at_least(double bound) const {
    if (bound <= 0.0) return 1.0;
    if (weak_machines_ > 0.0) return bound <= weak_success_ ? 1.0 : 1.0 - weak_machines_;
    if (a_ == 0.0) return mean_ >= bound ? 1.0 : 0.0;
    return boost::math::cdf(
        boost::math::complement(boost::math::beta_distribution<double>(a_, b_), std::min(bound, 1.0)));
  }

 private:
  double mean_, weak_machines_, weak_success_, a_{0.0}, b_{0.0};
};

/// The distribution of the settling times of all moves of all machines.
class TimeLaw {
 public:
  explicit TimeLaw(const Population& population)
      : spread_(std::sqrt(population.machine_effect * population.machine_effect +
                          population.trial_effect * population.trial_effect +
                          population.move_effect * population.move_effect)) {}
  double within(double time) const {
    return boost::math::cdf(boost::math::normal_distribution<double>(),
                            std::log(time / median_time) / spread_);
  }
  double quantile(double probability) const {
    std::int64_t k = 1;
    while (within(static_cast<double>(k) * sample_time) < probability) ++k;
    return static_cast<double>(k) * sample_time;
  }
  double mean_of_arrived() const {
    const auto last = static_cast<std::int64_t>(std::llround(hold / sample_time));
    double sum = 0.0, before = 0.0;
    for (std::int64_t k = 1; k <= last; ++k) {
      const double time = static_cast<double>(k) * sample_time;
      const double now = within(time);
      sum += time * (now - before);
      before = now;
    }
    return sum / before;
  }

 private:
  double spread_;
};

/// True values of the quantities for which bounds are given.
struct Truth {
  double success, without_failure, mean_time, median, p95, jerks;
};

Truth truth_of(const Population& population, const Sample& sample) {
  const SuccessLaw success(population);
  const TimeLaw times(population);
  const double of_machine =
      sample.machines > 0 ? static_cast<double>(sample.trials) / static_cast<double>(sample.machines) : 1.0;
  return {success.mean_over_machines([&](double q) { return SuccessLaw::of_trial(q, sample.moves); }),
          success.mean_over_machines(
              [&](double q) { return std::pow(SuccessLaw::of_trial(q, sample.moves), of_machine); }),
          times.mean_of_arrived(),
          times.quantile(0.5),
          times.quantile(0.95),
          population.jerks};
}

/// One machine of the population.
struct SimulatedMachine {
  double q{0.0};
  double time_factor{1.0};
  double jerk_factor{1.0};
};

class Simulation {
 public:
  Simulation(const Population& population, std::uint64_t seed)
      : population_(population), success_(population), random_(seed) {}

  SimulatedMachine machine() {
    SimulatedMachine machine{success_.draw(random_), std::exp(population_.machine_effect * normal_(random_)),
                             1.0};
    if (population_.jerk_sd > 0.0) {
      const double shape = 1.0 / (population_.jerk_sd * population_.jerk_sd);
      machine.jerk_factor = std::gamma_distribution<double>(shape, 1.0 / shape)(random_);
    }
    return machine;
  }

  trial::TrialOutcome trial(const SimulatedMachine& machine, std::int64_t moves) {
    trial::TrialOutcome trial;
    const bool decided_once = uniform_(random_) < alike;
    const bool all_zero = uniform_(random_) < machine.q;
    const double time =
        median_time * machine.time_factor * std::exp(population_.trial_effect * normal_(random_));
    for (std::int64_t i = 0; i < moves; ++i) {
      trial::MoveOutcome move;
      const bool zero = decided_once ? all_zero : uniform_(random_) < machine.q;
      move.outcome = zero ? trial::Outcome::zero_count : trial::Outcome::one_count;
      move.stable = zero;
      const double settled = time * std::exp(population_.move_effect * normal_(random_));
      move.arrival_time = std::ceil(settled / sample_time) * sample_time;
      move.arrived = move.arrival_time <= hold;
      move.final_position = 0.0;
      trial.moves.push_back(move);
    }
    const double factor = machine.jerk_factor * std::gamma_distribution<double>(2.0, 0.5)(random_);
    trial.moves[0].jerk_count = std::poisson_distribution<std::int64_t>(population_.jerks * factor)(random_);
    return trial;
  }

 private:
  const Population& population_;
  SuccessLaw success_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

std::vector<trial::Jerk> jerks_of(const trial::MoveOutcome& move) {
  std::vector<trial::Jerk> jerks;
  for (std::int64_t i = 0; i < move.jerk_count; ++i)
    jerks.push_back({0, 0.1 * static_cast<double>(i + 1), 0.01, 1, 1});
  return jerks;
}

void add_to(measures::PointAccumulator& point, const trial::TrialOutcome& trial) {
  point.add(trial, jerks_of(trial.moves[0]));
}

/// Adds every move as a trial of its own to the statistics. The bounds then take moves for independent.
void add_moves_to(measures::PointAccumulator& point, const trial::TrialOutcome& trial) {
  for (const trial::MoveOutcome& move : trial.moves) point.add(trial::TrialOutcome{{move}}, jerks_of(move));
}

bool is_inside(const statistics::ConfidenceInterval& bounds, double truth) {
  return !(bounds.low > truth) && !(bounds.high < truth);  // NaN: no bound on that side
}
bool is_inside(const statistics::Quantile& quantile, double truth) {
  return is_inside(statistics::ConfidenceInterval{quantile.low, quantile.high}, truth);
}

class Counter {
 public:
  void count(const std::string& bound, bool covered) {
    at(bound).covered += covered;
    ++at(bound).repetitions;
  }
  void count(const std::string& bound, bool covered, bool plainly) {
    count(bound, covered);
    if (at(bound).plainly < 0) at(bound).plainly = 0;
    at(bound).plainly += plainly;
  }
  const std::vector<Coverage>& found() const { return found_; }

 private:
  Coverage& at(const std::string& bound) {
    const auto place =
        std::find_if(found_.begin(), found_.end(), [&](const Coverage& one) { return one.bound == bound; });
    if (place != found_.end()) return *place;
    found_.push_back({bound, 0, 0, -1});
    return found_.back();
  }
  std::vector<Coverage> found_;
};

}  // namespace

std::vector<Coverage> coverage_of(const Population& population, const Sample& sample,
                                  std::int64_t repetitions, std::uint64_t seed) {
  const Truth truth = truth_of(population, sample);
  const SuccessLaw success(population);
  Simulation simulation(population, seed);
  Counter counter;
  for (std::int64_t repetition = 0; repetition < repetitions; ++repetition) {
    std::vector<SimulatedMachine> machines;
    for (std::int64_t machine = 0; machine < std::max<std::int64_t>(sample.machines, 1); ++machine)
      machines.push_back(simulation.machine());
    measures::PointAccumulator clustered({.shape = {.machines = sample.machines}});
    measures::PointAccumulator trials;
    measures::PointAccumulator moves;
    statistics::Moments times, jerks;
    for (std::int64_t i = 0; i < sample.trials; ++i) {
      const SimulatedMachine machine = sample.machines > 0
                                           ? machines[static_cast<std::size_t>(i % sample.machines)]
                                           : simulation.machine();
      const trial::TrialOutcome trial = simulation.trial(machine, sample.moves);
      add_to(clustered, trial);
      add_to(trials, trial);
      add_moves_to(moves, trial);
      for (const trial::MoveOutcome& move : trial.moves)
        if (move.arrived) times.add(move.arrival_time);
      jerks.add(static_cast<double>(trial.moves[0].jerk_count));
    }
    const auto stream = static_cast<std::uint32_t>(repetition);
    const measures::PointSummary found =
        clustered.statistics({.bootstrap = measures::BootstrapDraws{seed, stream}});
    const measures::PointSummary of_trials = trials.statistics();
    const measures::PointSummary of_moves = moves.statistics();
    counter.count("success", is_inside(found.success_rate().clopper_pearson, truth.success),
                  is_inside(of_trials.success_rate().clopper_pearson, truth.success));
    counter.count("stable",
                  is_inside(found.of(&trial::MoveOutcome::stable).rate.clopper_pearson, truth.success),
                  is_inside(of_trials.of(&trial::MoveOutcome::stable).rate.clopper_pearson, truth.success));
    counter.count("settling mean",
                  is_inside(found.of(&trial::MoveOutcome::arrival_time).mean_bounds, truth.mean_time),
                  is_inside(statistics::student_t(times), truth.mean_time));
    counter.count("settling median",
                  is_inside(found.of(&trial::MoveOutcome::arrival_time).median, truth.median),
                  is_inside(of_moves.of(&trial::MoveOutcome::arrival_time).median, truth.median));
    counter.count("settling p95", is_inside(found.of(&trial::MoveOutcome::arrival_time).p95, truth.p95),
                  is_inside(of_moves.of(&trial::MoveOutcome::arrival_time).p95, truth.p95));
    counter.count("jerk mean", is_inside(found.of(&trial::MoveOutcome::jerk_count).mean_bounds, truth.jerks),
                  is_inside(statistics::student_t(jerks), truth.jerks));
    if (sample.machines == 0) continue;
    counter.count("machines without failure",
                  is_inside(found.machines.without_failure_bounds, truth.without_failure));
    const double bound = found.machines.tolerance.zero_at_least;
    counter.count("tolerance", std::isnan(bound) || success.machines_at_least(bound) >= 0.9);
  }
  return counter.found();
}

}  // namespace zerocount::testing
