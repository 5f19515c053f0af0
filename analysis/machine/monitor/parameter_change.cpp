#include "analysis/machine/monitor/parameter_change.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/machine/monitor/change_test.hpp"
#include "core/numerics/dense.hpp"
#include "core/numerics/normal_distribution.hpp"

namespace zerocount::monitor {
namespace {

constexpr double improbable = 0.001;              // of moves without a change to show one
constexpr double misfit_of_the_right_one = 0.01;  // probability
constexpr double max_excess = 9.2;                // of a misfit over the least: a likelihood ratio of 1 %

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Coordinate for interpolation between changes of a parameter: the logarithm if the change is a factor, the
/// change itself if it is an amount.
double place_of(ChangeKind kind, double change) {
  return kind == ChangeKind::factor ? std::log(change) : change;
}

double change_at(ChangeKind kind, double place) {
  return kind == ChangeKind::factor ? std::exp(place) : place;
}

/// Aspect of the distribution of a measure's ranks that a feature describes: its location or its width.
enum class Aspect { place, width };

struct Feature {
  std::size_t measure;
  Aspect aspect;
};

double value_of(Aspect aspect, double rank) {
  if (aspect == Aspect::place) return numerics::normal_quantile(rank);
  return std::sqrt(5.0) * (6.0 * rank * (rank - 1.0) + 1.0);
}

/// Computes features of moves (normal scores and second-order Legendre polynomials of ranks), ranking each
/// value among those of the unchanged simulated machines.
class Features {
 public:
  Features(const std::vector<MoveValues>& machines, std::size_t measures) : sorted_(measures) {
    for (const MoveValues& moves : machines)
      for (std::size_t i = 0; i < moves.size(); ++i) sorted_[i % measures].push_back(moves[i]);
    for (std::vector<double>& values : sorted_) std::ranges::sort(values);
  }

  /// Features of the moves, as a matrix with a row for each feature and a column for each move.
  Matrix of(const MoveValues& moves, const std::vector<Feature>& features) const {
    const std::size_t measures = sorted_.size();
    const std::size_t count = moves.size() / measures;
    Matrix values(features.size(), count);
    for (std::size_t row = 0; row < features.size(); ++row) {
      const std::size_t measure = features[row].measure;
      const std::vector<double>& sorted = sorted_[measure];
      for (std::size_t move = 0; move < count; ++move) {
        const double rank = (mid_rank(sorted, moves[move * measures + measure]) + 0.5) /
                            (static_cast<double>(sorted.size()) + 1.0);
        values(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(move)) =
            value_of(features[row].aspect, rank);
      }
    }
    return values;
  }

 private:
  std::vector<std::vector<double>> sorted_;
};

/// Mean over machines of the features of moves, and their covariance between and within machines.
struct Spread {
  Vector mean;
  /// Covariance of the machines' means, without the contribution of their finite numbers of moves.
  Matrix between;
  Matrix within;   ///< Covariance of the moves of one machine about the machine's mean.
  double freedom;  ///< Degrees of freedom of the estimate `within`.
};

Matrix covariance_about(const Matrix& values, const Vector& mean) {
  const Matrix centred = values.colwise() - mean;
  return centred * centred.transpose();
}

/// Mean and covariances of the features of several machines.
/// @param machines [machine] matrix [feature, move]
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
  Spread spread{.mean = means.rowwise().mean(),
                .between = Matrix::Zero(measures, measures),
                .within = {},
                .freedom = 0.0};
  for (const Matrix& machine : machines) total += covariance_about(machine, spread.mean);
  constexpr double enough = 30.0;
  const bool repeated = moves - count >= enough;
  spread.freedom = std::max(repeated ? moves - count : moves - 1.0, 1.0);
  spread.within = Matrix((repeated ? within : total) / spread.freedom);
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

/// Expected distribution (mean and covariance) of the features' means, if a parameter has changed by one
/// certain amount or factor.
struct Expected {
  double place;  ///< Coordinate of the change, see place_of().
  Vector mean;
  Matrix covariance;
  double freedom;  ///< Degrees of freedom of the estimated covariance.
};

struct Distance {
  double misfit;             ///< Squared Mahalanobis distance Q between observed and expected features.
  double log_of_distance;    ///< Natural logarithm of the likelihood's factor (1 + Q/ν)^(−(ν + 1)/2).
  double log_of_covariance;  ///< Natural logarithm of the likelihood's factor |C|^(−1/2), C the covariance.
};

Distance distance_of(const Vector& observed, const Vector& mean, const Matrix& covariance, double freedom) {
  const Vector away = observed - mean;
  const Matrix solved = numerics::solve_positive_definite(covariance, away);
  const double misfit = away.dot(solved.col(0));
  const Matrix factor = numerics::cholesky_factor(covariance);
  return {misfit, -0.5 * (freedom + 1.0) * std::log1p(misfit / freedom),
          -factor.diagonal().array().log().sum()};
}

/// [feature] Factor (1 + ρ)/(1 − ρ) by which the variance of the feature's mean is larger than that of
/// independent moves, because successive moves have the serial correlation ρ.
/// @param values [feature, move]
Vector inflation_of(const Matrix& values) {
  constexpr double most = 0.95;
  Vector inflation = Vector::Ones(values.rows());
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    const Vector centred = (values.row(row).array() - values.row(row).mean()).matrix().transpose();
    const Eigen::Index pairs = centred.size() - 1;
    const double squares = centred.squaredNorm();
    if (pairs < 2 || !(squares > 0.0)) continue;
    const double correlation = std::clamp(centred.head(pairs).dot(centred.tail(pairs)) / squares, 0.0, most);
    inflation(row) = (1.0 + correlation) / (1.0 - correlation);
  }
  return inflation;
}

Matrix inflated(const Matrix& covariance, const Vector& inflation) {
  const Vector root = inflation.cwiseSqrt();
  return root.asDiagonal() * covariance * root.asDiagonal();
}

/// Number of moves before the change, by the split at which the mean scores differ most; 0 if the difference
/// is not significant.
/// @param scores [feature, move]
/// @param within covariance of the features of one machine's moves
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
  const double inflation = std::min(inflation_of(scores.leftCols(found)).maxCoeff(),
                                    inflation_of(scores.rightCols(moves - found)).maxCoeff());
  const double splits = static_cast<double>(last - first + 1);
  const double limit =
      statistics::chi_squared_quantile(static_cast<double>(scores.rows()), 1.0 - improbable / splits);
  return most > inflation * limit ? found : 0;
}

struct Statistic {
  Vector observed;
  double before;  ///< Number of observed moves before the change; 0: none are used.
  double after;   ///< Number of observed moves after the change.
  /// [feature] Factor on the variance of the mean after the change for serial correlation, see
  /// inflation_of().
  Vector inflation;
};

std::vector<Matrix> features_of(const Features& features, const std::vector<Feature>& wanted,
                                const std::vector<MoveValues>& machines) {
  std::vector<Matrix> all;
  for (const MoveValues& moves : machines) all.push_back(features.of(moves, wanted));
  return all;
}

double count_of_moves(const std::vector<Matrix>& machines) {
  double moves = 0.0;
  for (const Matrix& machine : machines) moves += static_cast<double>(machine.cols());
  return moves;
}

Expected expected_at(double place, const std::vector<Matrix>& changed, const std::vector<Matrix>& unchanged,
                     const Statistic& statistic) {
  const double simulated = count_of_moves(changed);
  const auto machines = static_cast<double>(changed.size());
  const Spread after = spread_of(changed);
  Spread mean = after;
  Matrix within = after.within / statistic.after;
  if (statistic.before > 0.0) {
    std::vector<Matrix> differences;
    for (std::size_t i = 0; i < changed.size(); ++i)
      differences.push_back(changed[i] - unchanged[i].leftCols(changed[i].cols()));
    mean = spread_of(differences);
    within += spread_of(unchanged).within / statistic.before;
  }
  within = inflated(within + mean.within / simulated, statistic.inflation);
  // A value that no simulated move has may occur in one move of as many.
  within.diagonal().array() += (1.0 / simulated + 1.0 / statistic.after) / simulated;
  const Matrix between = (1.0 + 1.0 / machines) * mean.between;
  Expected expected{place, mean.mean, between + within, 0.0};
  const double part = numerics::solve_positive_definite(expected.covariance, between).trace() /
                      static_cast<double>(between.rows());
  const double from_machines = machines > 1.0 ? part * part / (machines - 1.0) : 0.0;
  expected.freedom = 1.0 / (from_machines + (1.0 - part) * (1.0 - part) / after.freedom);
  return expected;
}

/// Largest squared Mahalanobis distance Q that is accepted: its 99 % quantile if the parameter is the right
/// one. The quantile is that of Hotelling's T², to the first order in 1/ν.
/// @param features number of features
/// @param freedom degrees of freedom ν of the covariance
double max_misfit(Eigen::Index features, double freedom) {
  const auto count = static_cast<double>(features);
  const double x = statistics::chi_squared_quantile(count, 1.0 - misfit_of_the_right_one);
  return x + x * (x + count) / (2.0 * freedom);
}

/// The most likely change of one parameter, and the logarithm of the parameter's evidence (its likelihood
/// averaged over all simulated changes).
struct Fit {
  ParameterChange change;
  double log_evidence;
};

/// Fits the change of one parameter to the observed features, interpolating between the simulated changes.
/// @param freedom degrees of freedom of all likelihoods; the same for all parameters, so that their
/// likelihoods can be compared
Fit fit_of(const ChangeCandidate& candidate, const std::vector<Expected>& expected, const Vector& observed,
           double freedom) {
  constexpr int parts = 20;  // between two changes
  struct Point {
    double place;
    double freedom;  ///< Degrees of freedom of the covariance at this place.
    Distance distance;
    double log_likelihood() const { return distance.log_of_distance + distance.log_of_covariance; }
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i + 1 < expected.size(); ++i) {
    const Expected& from = expected[i];
    const Expected& to = expected[i + 1];
    for (int step = i == 0 ? 0 : 1; step <= parts; ++step) {
      const double part = static_cast<double>(step) / parts;
      const auto between = [part](const auto& a, const auto& b) {
        return ((1.0 - part) * a + part * b).eval();
      };
      points.push_back({std::lerp(from.place, to.place, part), std::lerp(from.freedom, to.freedom, part),
                        distance_of(observed, between(from.mean, to.mean),
                                    between(from.covariance, to.covariance), freedom)});
    }
  }
  const auto best = std::ranges::max_element(points, {}, &Point::log_likelihood);
  constexpr double drop = 1.920729;  // half of the 95 % quantile of χ² with one degree of freedom
  double area = 0.0;
  const Point* first = nullptr;
  const Point* last = nullptr;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double width =
        0.5 * (points[std::min(i + 1, points.size() - 1)].place - points[i == 0 ? 0 : i - 1].place);
    const double less = best->log_likelihood() - points[i].log_likelihood();
    area += width * std::exp(-less);
    if (less > drop) continue;
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
           .misfit = best->distance.misfit,
           .max_misfit = max_misfit(observed.size(), best->freedom),
           .beyond_low = first == &points.front(),
           .beyond_high = last == &points.back()},
          best->distance.log_of_distance + std::log(area / range)};
}

const SimulatedChange& unchanged_of(const ChangeCandidate& candidate) {
  return *std::ranges::find(candidate.changes, unchanged_by(candidate.kind), &SimulatedChange::change);
}

/// Proportion of the row's elements that have its most frequent value.
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

/// Number of simulated machines that can show differences between machines; 0 if all moves belong to one
/// machine.
std::size_t differing_machines(const std::vector<MoveValues>& unchanged) {
  return unchanged.size() < 2 ? 0 : unchanged.size();
}

/// Chooses the features by which moves are compared: features that vary and that the chosen ones do not
/// already determine. Measures with smaller indices, which are the more informative ones, are preferred.
/// @param unchanged [machine] moves of the unchanged machines
/// @param measures number of measures per move
std::vector<Feature> telling_features(const std::vector<MoveValues>& unchanged, std::size_t measures) {
  constexpr std::size_t most = 16;
  constexpr std::size_t most_measures = 8;
  constexpr std::size_t machines_of_feature = 4;
  constexpr double too_tied = 0.8;
  constexpr double least_residual = 0.19;  // variance that others leave: a correlation below 0.9
  const std::size_t differing = differing_machines(unchanged);
  const std::size_t limit =
      differing == 0 ? most : std::clamp<std::size_t>(differing / machines_of_feature, 2, most);
  MoveValues all;
  for (const MoveValues& moves : unchanged) all.insert(all.end(), moves.begin(), moves.end());
  const Features features(unchanged, measures);
  std::vector<Feature> found;
  std::vector<Vector> basis;  // orthonormal
  const auto add = [&](const Feature& feature) {
    Vector row = features.of(all, {feature}).row(0).transpose();
    row.array() -= row.mean();
    const double norm = row.norm();
    if (!(norm > 0.0)) return false;
    row /= norm;
    for (const Vector& other : basis) row -= row.dot(other) * other;
    if (row.squaredNorm() < least_residual) return false;
    basis.push_back(row / row.norm());
    found.push_back(feature);
    return true;
  };
  std::vector<std::size_t> telling;
  for (std::size_t i = 0; i < measures && telling.size() < most_measures && found.size() < limit; ++i) {
    const Matrix places = features.of(all, {{i, Aspect::place}});
    if (part_tied(places.row(0)) <= too_tied && add({i, Aspect::place})) telling.push_back(i);
  }
  for (const std::size_t i : telling)
    if (found.size() < limit) add({i, Aspect::width});
  return found;
}

/// Sets the probabilities of the parameters that explain the moves or, if none does, of all parameters, so
/// that they sum to 1. Sorts the fits by probability, the most likely first.
void set_probabilities(std::vector<Fit>& fits) {
  double least = std::numeric_limits<double>::max();
  for (const Fit& fit : fits)
    if (fit.change.fits()) least = std::min(least, fit.change.misfit);
  for (Fit& fit : fits) fit.change.explains = fit.change.fits() && fit.change.misfit <= least + max_excess;
  const bool any = std::ranges::any_of(fits, [](const Fit& fit) { return fit.change.explains; });
  double best = -std::numeric_limits<double>::infinity();
  for (const Fit& fit : fits)
    if (fit.change.explains || !any) best = std::max(best, fit.log_evidence);
  double sum = 0.0;
  for (Fit& fit : fits) {
    fit.change.probability = fit.change.explains || !any ? std::exp(fit.log_evidence - best) : 0.0;
    sum += fit.change.probability;
  }
  for (Fit& fit : fits) fit.change.probability /= sum;
  std::ranges::stable_sort(fits, std::greater{}, [](const Fit& fit) {
    return std::pair(fit.change.probability, fit.log_evidence);
  });
}

/// Whether each machine's moves in `these` are the first moves of the same machine in `those`.
bool is_beginning_of(const std::vector<MoveValues>& these, const std::vector<MoveValues>& those) {
  if (these.size() > those.size()) return false;
  return std::ranges::equal(
      these, std::span(those).first(these.size()), [](const MoveValues& some, const MoveValues& all) {
        return some.size() <= all.size() && std::ranges::equal(some, std::span(all).first(some.size()));
      });
}

ChangeExplanation unknown_because(std::string reason) {
  return {.told = ExplanationKind::unknown, .reason = std::move(reason)};
}

}  // namespace

ChangeExplanation explain_change(std::span<const ChangeCandidate> candidates, const MoveValues& observed,
                                 std::size_t measures) {
  if (candidates.empty()) return unknown_because("no parameter of the study can be changed");
  if (observed.size() < min_moves_after * measures)
    return unknown_because(fmt::format("there are fewer than {} moves", min_moves_after));
  const std::vector<MoveValues>& same = unchanged_of(candidates.front()).machines;
  const std::vector<Feature> wanted = telling_features(same, measures);
  if (wanted.empty()) return unknown_because("no measure differs between most simulated moves");
  const Features features(same, measures);
  const std::vector<Matrix> unchanged = features_of(features, wanted, same);
  const Matrix seen = features.of(observed, wanted);
  const Eigen::Index places =
      std::ranges::count(wanted, Aspect::place, &Feature::aspect);  // which come before the widths
  const Eigen::Index before =
      moves_before_change(seen.topRows(places), spread_of(unchanged).within.topLeftCorner(places, places));
  const Eigen::Index after = seen.cols() - before;
  Statistic statistic{.observed = seen.rightCols(after).rowwise().mean(),
                      .before = static_cast<double>(before),
                      .after = static_cast<double>(after),
                      .inflation = inflation_of(seen.rightCols(after))};
  if (before > 0) statistic.observed -= seen.leftCols(before).rowwise().mean();
  std::vector<std::pair<const ChangeCandidate*, std::vector<Expected>>> acting;
  double freedom = std::numeric_limits<double>::max();
  for (const ChangeCandidate& candidate : candidates) {
    const bool acts = std::ranges::any_of(candidate.changes, [&](const SimulatedChange& change) {
      return change.change != unchanged_by(candidate.kind) &&
             !is_beginning_of(change.machines, unchanged_of(candidate).machines);
    });
    if (!acts) continue;
    std::vector<Expected>& expected = acting.emplace_back(&candidate, std::vector<Expected>{}).second;
    for (const SimulatedChange& change : candidate.changes) {
      expected.push_back(expected_at(place_of(candidate.kind, change.change),
                                     features_of(features, wanted, change.machines), unchanged, statistic));
      freedom = std::min(freedom, expected.back().freedom);
    }
  }
  if (acting.empty()) return unknown_because("no parameter acts on these measures");
  std::vector<Fit> fits;
  for (const auto& [candidate, expected] : acting)
    fits.push_back(fit_of(*candidate, expected, statistic.observed, freedom));
  set_probabilities(fits);
  ChangeExplanation explanation;
  explanation.since = before + 1;
  for (const Fit& fit : fits) {
    explanation.tried.push_back(fit.change.parameter);
    explanation.ranked.push_back(fit.change);
    if (fit.change.explains) explanation.parameters.push_back(fit.change);
  }
  const ParameterChange& nearest = *std::ranges::min_element(
      explanation.ranked, {},
      [](const ParameterChange& change) { return change.misfit / change.max_misfit; });
  explanation.misfit = nearest.misfit;
  explanation.max_misfit = nearest.max_misfit;
  explanation.told = explanation.parameters.empty()       ? ExplanationKind::none
                     : explanation.parameters.size() == 1 ? ExplanationKind::one
                                                          : ExplanationKind::several;
  return explanation;
}

}  // namespace zerocount::monitor
