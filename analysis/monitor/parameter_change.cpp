#include "analysis/monitor/parameter_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "analysis/statistics/distributions.hpp"
#include "core/numerics/dense.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::monitor {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Normal scores among the values of the unchanged machines.
class NormalScores {
 public:
  NormalScores(const std::vector<MachineMoves>& machines, std::size_t measures) : sorted_(measures) {
    for (const MachineMoves& moves : machines)
      for (std::size_t i = 0; i < moves.size(); ++i) sorted_[i % measures].push_back(moves[i]);
    for (std::vector<double>& values : sorted_) std::ranges::sort(values);
  }

  /// [measure, move]
  Matrix of(const MachineMoves& moves) const {
    const std::size_t measures = sorted_.size();
    Matrix scores(measures, moves.size() / measures);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const std::vector<double>& values = sorted_[i % measures];
      const auto [first, last] = std::ranges::equal_range(values, moves[i]);
      const auto below = static_cast<double>(first - values.begin());
      const auto equal = static_cast<double>(last - first);
      const double part = (below + 0.5 * equal + 0.5) / (static_cast<double>(values.size()) + 1.0);
      scores(static_cast<Eigen::Index>(i % measures), static_cast<Eigen::Index>(i / measures)) =
          numerics::normal_quantile(part);
    }
    return scores;
  }

 private:
  std::vector<std::vector<double>> sorted_;
};

/// What machines have in common, and how they differ.
struct Spread {
  Vector mean;
  Matrix between;  ///< covariance of the machines' means, less what their few moves add
  Matrix within;   ///< of a move of one machine
};

Matrix covariance_about(const Matrix& values, const Vector& mean) {
  const Matrix centred = values.colwise() - mean;
  return centred * centred.transpose();
}

/// @param machines scores of the moves of each
Spread spread_of(const std::vector<Matrix>& machines) {
  const Eigen::Index measures = machines.front().rows();
  Matrix means(measures, static_cast<Eigen::Index>(machines.size()));
  Matrix within = Matrix::Zero(measures, measures);
  Matrix total = Matrix::Zero(measures, measures);
  double moves = 0.0;
  for (std::size_t i = 0; i < machines.size(); ++i) {
    const Vector mean = machines[i].rowwise().mean();
    means.col(static_cast<Eigen::Index>(i)) = mean;
    within += covariance_about(machines[i], mean);
    moves += static_cast<double>(machines[i].cols());
  }
  const auto count = static_cast<double>(machines.size());
  Spread spread{.mean = means.rowwise().mean(), .between = Matrix::Zero(measures, measures), .within = {}};
  for (const Matrix& machine : machines) total += covariance_about(machine, spread.mean);
  constexpr double enough = 30.0;
  const bool repeated = moves - count >= enough;
  spread.within = repeated ? Matrix(within / (moves - count)) : Matrix(total / std::max(moves - 1.0, 1.0));
  if (machines.size() < 2) return spread;
  spread.between = covariance_about(means, spread.mean) / (count - 1.0);
  const double of_moves = spread.within.trace() / (moves / count);
  spread.between *= std::max(0.0, 1.0 - of_moves / std::max(spread.between.trace(), 1e-300));
  return spread;
}

/// The statistic at one factor: normal.
struct Expected {
  double log_factor;
  Vector mean;
  Matrix covariance;
};

double log_likelihood(const Vector& observed, const Vector& mean, const Matrix& covariance, double& misfit) {
  const Vector away = observed - mean;
  const Matrix solved = numerics::solve_positive_definite(covariance, away);
  misfit = away.dot(solved.col(0));
  const Matrix factor = numerics::cholesky_factor(covariance);
  return -0.5 * misfit - factor.diagonal().array().log().sum();
}

/// How much more the observed moves vary in their mean than independent ones, for their serial correlation.
double inflation_of(const Matrix& scores) {
  double largest = 0.0;
  for (Eigen::Index row = 0; row < scores.rows(); ++row) {
    const Vector centred = (scores.row(row).array() - scores.row(row).mean()).matrix().transpose();
    const Eigen::Index pairs = centred.size() - 1;
    const double squares = centred.squaredNorm();
    if (pairs < 2 || !(squares > 0.0)) continue;
    largest = std::max(largest, centred.head(pairs).dot(centred.tail(pairs)) / squares);
  }
  constexpr double most = 0.95;
  const double correlation = std::min(largest, most);
  return (1.0 + correlation) / (1.0 - correlation);
}

struct Statistic {
  Vector observed;
  bool has_before;
  double per_move_before;  ///< of a covariance within: 1/moves, enlarged
  double per_move_after;
};

std::vector<Matrix> scored(const NormalScores& scores, const std::vector<MachineMoves>& machines) {
  std::vector<Matrix> all;
  for (const MachineMoves& moves : machines) all.push_back(scores.of(moves));
  return all;
}

Expected expected_at(const SimulatedFactor& simulated, const NormalScores& scores,
                     const std::vector<Matrix>& unchanged, const Statistic& statistic) {
  const std::vector<Matrix> changed = scored(scores, simulated.machines);
  const Spread after = spread_of(changed);
  Expected expected{std::log(simulated.factor), after.mean,
                    after.between + statistic.per_move_after * after.within};
  if (statistic.has_before) {
    std::vector<Matrix> differences;
    for (std::size_t i = 0; i < changed.size(); ++i) differences.push_back(changed[i] - unchanged[i]);
    const Spread difference = spread_of(differences);
    const Spread before = spread_of(unchanged);
    expected.mean = difference.mean;
    expected.covariance = difference.between + statistic.per_move_before * before.within +
                          statistic.per_move_after * after.within;
  }
  constexpr double rounding = 1e-6;
  expected.covariance.diagonal().array() += rounding;
  return expected;
}

/// The change of one parameter, and the logarithm of its likelihood averaged over the range.
struct Fit {
  ParameterChange change;
  double log_evidence;
};

Fit fit_of(const ChangeCandidate& candidate, const std::vector<Expected>& expected, const Vector& observed) {
  constexpr int parts = 20;  // between two factors
  struct Point {
    double log_factor;
    double likelihood;
    double misfit;
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i + 1 < expected.size(); ++i) {
    for (int step = i == 0 ? 0 : 1; step <= parts; ++step) {
      const double part = static_cast<double>(step) / parts;
      const auto between = [part](const auto& a, const auto& b) {
        return ((1.0 - part) * a + part * b).eval();
      };
      Point point{std::lerp(expected[i].log_factor, expected[i + 1].log_factor, part), 0.0, 0.0};
      point.likelihood =
          log_likelihood(observed, between(expected[i].mean, expected[i + 1].mean),
                         between(expected[i].covariance, expected[i + 1].covariance), point.misfit);
      points.push_back(point);
    }
  }
  const auto best = std::ranges::max_element(points, {}, &Point::likelihood);
  constexpr double drop = 1.920729;  // half of the 95 % quantile of χ² with one degree of freedom
  double area = 0.0;
  const Point* first = nullptr;
  const Point* last = nullptr;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double width =
        0.5 * (points[std::min(i + 1, points.size() - 1)].log_factor - points[i == 0 ? 0 : i - 1].log_factor);
    area += width * std::exp(points[i].likelihood - best->likelihood);
    if (points[i].likelihood < best->likelihood - drop) continue;
    if (first == nullptr) first = &points[i];
    last = &points[i];
  }
  const double range = points.back().log_factor - points.front().log_factor;
  return {{.parameter = candidate.parameter,
           .factor = std::exp(best->log_factor),
           .low = std::exp(first->log_factor),
           .high = std::exp(last->log_factor),
           .misfit = best->misfit,
           .beyond_low = first == &points.front(),
           .beyond_high = last == &points.back()},
          best->likelihood + std::log(area / range)};
}

/// The measures of which the unchanged machines have more than one value.
std::vector<std::size_t> varying_measures(const ChangeCandidate& any, std::size_t measures) {
  std::vector<double> low(measures, std::numeric_limits<double>::infinity());
  std::vector<double> high(measures, -std::numeric_limits<double>::infinity());
  for (const SimulatedFactor& factor : any.factors) {
    for (const MachineMoves& moves : factor.machines) {
      for (std::size_t i = 0; i < moves.size(); ++i) {
        low[i % measures] = std::min(low[i % measures], moves[i]);
        high[i % measures] = std::max(high[i % measures], moves[i]);
      }
    }
  }
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < measures; ++i)
    if (low[i] < high[i]) found.push_back(i);
  return found;
}

MachineMoves picked(const MachineMoves& moves, const std::vector<std::size_t>& wanted, std::size_t measures) {
  MachineMoves result;
  for (std::size_t move = 0; move < moves.size() / measures; ++move)
    for (const std::size_t measure : wanted) result.push_back(moves[move * measures + measure]);
  return result;
}

const SimulatedFactor& unchanged_of(const ChangeCandidate& candidate) {
  return *std::ranges::find(candidate.factors, 1.0, &SimulatedFactor::factor);
}

void set_probabilities(std::vector<Fit>& fits) {
  const double best = std::ranges::max_element(fits, {}, &Fit::log_evidence)->log_evidence;
  double sum = 0.0;
  for (const Fit& fit : fits) sum += std::exp(fit.log_evidence - best);
  for (Fit& fit : fits) fit.change.probability = std::exp(fit.log_evidence - best) / sum;
  std::ranges::sort(fits, std::greater{}, [](const Fit& fit) { return fit.change.probability; });
}

ChangeExplanation unknown_because(std::string reason) {
  return {.told = ChangeTold::unknown, .reason = std::move(reason)};
}

}  // namespace

ChangeExplanation explain_change(std::span<const ChangeCandidate> given, const ObservedMoves& observed,
                                 std::size_t measures) {
  if (given.empty()) return unknown_because("no parameter of the study can be changed");
  if (observed.after.size() < min_moves_after * measures)
    return unknown_because("there are too few moves since the change");
  const std::vector<std::size_t> wanted = varying_measures(given.front(), measures);
  if (wanted.empty()) return unknown_because("no measure differs between simulated moves");
  std::vector<ChangeCandidate> candidates(given.begin(), given.end());
  for (ChangeCandidate& candidate : candidates)
    for (SimulatedFactor& factor : candidate.factors)
      for (MachineMoves& moves : factor.machines) moves = picked(moves, wanted, measures);
  const std::vector<MachineMoves>& same = unchanged_of(candidates.front()).machines;
  const NormalScores scores(same, wanted.size());
  const std::vector<Matrix> unchanged = scored(scores, same);
  const Matrix before = scores.of(picked(observed.before, wanted, measures));
  const Matrix after = scores.of(picked(observed.after, wanted, measures));
  const double inflation = inflation_of(after);
  Statistic statistic{.observed = after.rowwise().mean(),
                      .has_before = before.cols() >= static_cast<Eigen::Index>(min_moves_before),
                      .per_move_before = 0.0,
                      .per_move_after = inflation / static_cast<double>(after.cols())};
  if (statistic.has_before) {
    statistic.observed -= before.rowwise().mean();
    statistic.per_move_before = inflation / static_cast<double>(before.cols());
  }
  std::vector<Fit> fits;
  for (const ChangeCandidate& candidate : candidates) {
    const bool acts = std::ranges::any_of(candidate.factors, [&](const SimulatedFactor& factor) {
      return factor.machines != unchanged_of(candidate).machines;
    });
    if (!acts) continue;
    std::vector<Expected> expected;
    for (const SimulatedFactor& factor : candidate.factors)
      expected.push_back(expected_at(factor, scores, unchanged, statistic));
    fits.push_back(fit_of(candidate, expected, statistic.observed));
  }
  if (fits.empty()) return unknown_because("no parameter acts on these measures");
  set_probabilities(fits);
  ChangeExplanation explanation;
  for (const Fit& fit : fits) explanation.tried.push_back(fit.change.parameter);
  const double misfit =
      std::ranges::min_element(fits, {}, [](const Fit& fit) { return fit.change.misfit; })->change.misfit;
  explanation.misfit = misfit;
  constexpr double improbable = 0.01;
  explanation.max_misfit =
      statistics::chi_squared_quantile(static_cast<double>(wanted.size()), 1.0 - improbable);
  constexpr double plausible = 0.05;
  for (const Fit& fit : fits)
    if (fit.change.probability >= plausible) explanation.parameters.push_back(fit.change);
  constexpr double sure = 0.95;
  explanation.told = misfit > explanation.max_misfit                      ? ChangeTold::none
                     : explanation.parameters.front().probability >= sure ? ChangeTold::one
                                                                          : ChangeTold::several;
  return explanation;
}

}  // namespace zerocount::monitor
