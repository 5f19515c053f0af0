#include "analysis/monitor/parameter_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "analysis/monitor/change_test.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/numerics/dense.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::monitor {
namespace {

constexpr double improbable = 0.001;

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Where a change lies between others.
double place_of(ChangeKind kind, double change) {
  return kind == ChangeKind::factor ? std::log(change) : change;
}

double change_at(ChangeKind kind, double place) {
  return kind == ChangeKind::factor ? std::exp(place) : place;
}

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
      const double part = (mid_rank(values, moves[i]) + 0.5) / (static_cast<double>(values.size()) + 1.0);
      scores(static_cast<Eigen::Index>(i % measures), static_cast<Eigen::Index>(i / measures)) =
          numerics::normal_quantile(part);
    }
    return scores;
  }

 private:
  std::vector<std::vector<double>> sorted_;
};

/// Mean of machines, and the covariances between and within them.
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
  // The difference of a machine's halves shows how well its moves tell its mean.
  double of_moves = 0.0;
  for (const Matrix& machine : machines) {
    const Eigen::Index half = machine.cols() / 2;
    if (half == 0) continue;
    const Vector difference =
        machine.leftCols(half).rowwise().mean() - machine.rightCols(half).rowwise().mean();
    of_moves += 0.25 * difference.squaredNorm() / count;
  }
  spread.between *= std::max(0.0, 1.0 - of_moves / std::max(spread.between.trace(), 1e-300));
  return spread;
}

/// The statistic at one change: normal.
struct Expected {
  double place;  ///< place_of() the change
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

/// How much more the mean of moves in parts varies than of independent ones, for their serial correlation.
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

/// Number of moves before the change; 0 if they show none.
Eigen::Index moves_before_change(const Matrix& scores, const Matrix& within) {
  const Eigen::Index moves = scores.cols();
  const auto first = static_cast<Eigen::Index>(min_moves_before);
  const auto last = moves - static_cast<Eigen::Index>(min_moves_after);
  if (last < first) return 0;
  Matrix covariance = within;
  constexpr double rounding = 1e-6;
  covariance.diagonal().array() += rounding;
  const Matrix precision = numerics::inverse_of_positive_definite(covariance);
  const Vector total = scores.rowwise().sum();
  Vector sum = scores.leftCols(first - 1).rowwise().sum();
  double most = 0.0;
  Eigen::Index found = 0;
  for (Eigen::Index split = first; split <= last; ++split) {
    sum += scores.col(split - 1);
    const auto before = static_cast<double>(split);
    const auto after = static_cast<double>(moves - split);
    const Vector away = sum / before - (total - sum) / after;
    const double contrast = before * after / (before + after) * away.dot(precision * away);
    if (contrast <= most) continue;
    most = contrast;
    found = split;
  }
  if (found == 0) return 0;
  const double inflation =
      std::min(inflation_of(scores.leftCols(found)), inflation_of(scores.rightCols(moves - found)));
  const double splits = static_cast<double>(last - first + 1);
  const double limit =
      statistics::chi_squared_quantile(static_cast<double>(scores.rows()), 1.0 - improbable / splits);
  return most > inflation * limit ? found : 0;
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

Expected expected_at(const SimulatedChange& simulated, ChangeKind kind, const NormalScores& scores,
                     const std::vector<Matrix>& unchanged, const Statistic& statistic) {
  const std::vector<Matrix> changed = scored(scores, simulated.machines);
  const Spread after = spread_of(changed);
  Expected expected{place_of(kind, simulated.change), after.mean,
                    after.between + statistic.per_move_after * after.within};
  if (statistic.has_before) {
    std::vector<Matrix> differences;
    for (std::size_t i = 0; i < changed.size(); ++i)
      differences.push_back(changed[i] - unchanged[i].leftCols(changed[i].cols()));
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
  constexpr int parts = 20;  // between two changes
  struct Point {
    double place;
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
      Point point{std::lerp(expected[i].place, expected[i + 1].place, part), 0.0, 0.0};
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
        0.5 * (points[std::min(i + 1, points.size() - 1)].place - points[i == 0 ? 0 : i - 1].place);
    area += width * std::exp(points[i].likelihood - best->likelihood);
    if (points[i].likelihood < best->likelihood - drop) continue;
    if (first == nullptr) first = &points[i];
    last = &points[i];
  }
  const double range = points.back().place - points.front().place;
  return {{.parameter = candidate.parameter,
           .kind = candidate.kind,
           .unit = candidate.unit,
           .change = change_at(candidate.kind, best->place),
           .low = change_at(candidate.kind, first->place),
           .high = change_at(candidate.kind, last->place),
           .misfit = best->misfit,
           .beyond_low = first == &points.front(),
           .beyond_high = last == &points.back()},
          best->likelihood + std::log(area / range)};
}

const SimulatedChange& unchanged_of(const ChangeCandidate& candidate) {
  return *std::ranges::find(candidate.changes, unchanged_by(candidate.kind), &SimulatedChange::change);
}

/// The part of a row that has its most frequent value.
double part_tied(const Eigen::MatrixXd::ConstRowXpr& row) {
  std::vector<double> values(row.begin(), row.end());
  std::ranges::sort(values);
  std::size_t most = 0;
  for (std::size_t first = 0, end = 0; first < values.size(); first = end) {
    while (end < values.size() && values[end] == values[first]) ++end;
    most = std::max(most, end - first);
  }
  return static_cast<double>(most) / static_cast<double>(values.size());
}

/// The measures to go by, in their order: at most eight whose mean is nearly normal, of which none says what
/// another says.
std::vector<std::size_t> telling_measures(const std::vector<MachineMoves>& unchanged, std::size_t measures) {
  constexpr std::size_t most = 8;
  constexpr double too_tied = 0.8;
  constexpr double alike = 0.9;  // correlation
  const NormalScores scores(unchanged, measures);
  MachineMoves all;
  for (const MachineMoves& moves : unchanged) all.insert(all.end(), moves.begin(), moves.end());
  Matrix rows = scores.of(all);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < measures && found.size() < most; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (part_tied(std::as_const(rows).row(row)) > too_tied) continue;
    rows.row(row).array() -= rows.row(row).mean();
    rows.row(row) /= rows.row(row).norm();
    const bool repeats = std::ranges::any_of(found, [&](std::size_t other) {
      return std::abs(rows.row(row).dot(rows.row(static_cast<Eigen::Index>(other)))) > alike;
    });
    if (!repeats) found.push_back(i);
  }
  return found;
}

MachineMoves picked(const MachineMoves& moves, const std::vector<std::size_t>& wanted, std::size_t measures) {
  MachineMoves result;
  for (std::size_t move = 0; move < moves.size() / measures; ++move)
    for (const std::size_t measure : wanted) result.push_back(moves[move * measures + measure]);
  return result;
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

ChangeExplanation explain_change(std::span<const ChangeCandidate> given, const MachineMoves& observed,
                                 std::size_t measures, double plausible) {
  if (given.empty()) return unknown_because("no parameter of the study can be changed");
  if (observed.size() < min_moves_after * measures)
    return unknown_because(fmt::format("there are fewer than {} moves", min_moves_after));
  const std::vector<std::size_t> wanted = telling_measures(unchanged_of(given.front()).machines, measures);
  if (wanted.empty()) return unknown_because("no measure differs between most simulated moves");
  std::vector<ChangeCandidate> candidates(given.begin(), given.end());
  for (ChangeCandidate& candidate : candidates)
    for (SimulatedChange& change : candidate.changes)
      for (MachineMoves& moves : change.machines) moves = picked(moves, wanted, measures);
  const std::vector<MachineMoves>& same = unchanged_of(candidates.front()).machines;
  const NormalScores scores(same, wanted.size());
  const std::vector<Matrix> unchanged = scored(scores, same);
  const Matrix seen = scores.of(picked(observed, wanted, measures));
  const Eigen::Index before = moves_before_change(seen, spread_of(unchanged).within);
  const Eigen::Index after = seen.cols() - before;
  const double inflation = inflation_of(seen.rightCols(after));
  Statistic statistic{.observed = seen.rightCols(after).rowwise().mean(),
                      .has_before = before > 0,
                      .per_move_before = 0.0,
                      .per_move_after = inflation / static_cast<double>(after)};
  if (statistic.has_before) {
    statistic.observed -= seen.leftCols(before).rowwise().mean();
    statistic.per_move_before = inflation / static_cast<double>(before);
  }
  std::vector<Fit> fits;
  for (const ChangeCandidate& candidate : candidates) {
    const bool acts = std::ranges::any_of(candidate.changes, [&](const SimulatedChange& change) {
      return change.machines != unchanged_of(candidate).machines;
    });
    if (!acts) continue;
    std::vector<Expected> expected;
    for (const SimulatedChange& change : candidate.changes)
      expected.push_back(expected_at(change, candidate.kind, scores, unchanged, statistic));
    fits.push_back(fit_of(candidate, expected, statistic.observed));
  }
  if (fits.empty()) return unknown_because("no parameter acts on these measures");
  set_probabilities(fits);
  ChangeExplanation explanation;
  explanation.since = before + 1;
  for (const Fit& fit : fits) explanation.tried.push_back(fit.change.parameter);
  const double misfit =
      std::ranges::min_element(fits, {}, [](const Fit& fit) { return fit.change.misfit; })->change.misfit;
  explanation.misfit = misfit;
  explanation.max_misfit =
      statistics::chi_squared_quantile(static_cast<double>(wanted.size()), 1.0 - improbable);
  for (const Fit& fit : fits)
    if (fit.change.probability >= plausible) explanation.parameters.push_back(fit.change);
  // A cause that none of the candidates is may move the measures nearly as one of them does.
  constexpr double sure = 0.95;
  constexpr double doubtful = 0.05;
  const ParameterChange& likeliest = explanation.parameters.front();
  const bool fits_well = likeliest.misfit <=
                         statistics::chi_squared_quantile(static_cast<double>(wanted.size()), 1.0 - doubtful);
  explanation.told = misfit > explanation.max_misfit              ? ChangeTold::none
                     : likeliest.probability >= sure && fits_well ? ChangeTold::one
                                                                  : ChangeTold::several;
  return explanation;
}

}  // namespace zerocount::monitor
