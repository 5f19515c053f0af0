#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Which parameter of a simulated study has changed, told from the moves of a machine that changed.
namespace zerocount::monitor {

/// Moves of one machine: the values of `measures` measures, move after move.
using MachineMoves = std::vector<double>;

/// How a parameter changes.
enum class ChangeKind {
  factor,  ///< its value is multiplied
  amount   ///< to its value, which may be 0, something is added
};

/// The moves of simulated machines with a parameter changed; the same machines at every change, of which a
/// change may have the first moves alone.
struct SimulatedChange {
  double change{1.0};  ///< factor, or amount in the unit of the parameter
  std::vector<MachineMoves> machines;
};

/// A parameter that may have changed.
struct ChangeCandidate {
  std::string parameter;                 ///< dotted path
  std::vector<SimulatedChange> changes;  ///< rising, with unchanged_by(kind) among them
  ChangeKind kind{ChangeKind::factor};
  std::string unit{};  ///< of an amount
};

constexpr double unchanged_by(ChangeKind kind) {
  return kind == ChangeKind::factor ? 1.0 : 0.0;
}

/// How well a change of one parameter explains the moves.
struct ParameterChange {
  std::string parameter;
  ChangeKind kind{ChangeKind::factor};
  std::string unit{};  ///< of an amount
  double change{1.0};  ///< most likely factor, or amount
  double low{1.0};     ///< its 95 % interval, by the likelihood; an end of the range where it goes on
  double high{1.0};
  double probability{
      0.0};            ///< that it is this one, where one of the candidates changed and all were alike before
  double misfit{0.0};  ///< squared Mahalanobis distance of the moves from the simulated ones
  bool beyond_low{false};   ///< the interval reaches the lowest simulated change
  bool beyond_high{false};  ///< and the highest
};

enum class ChangeTold {
  one,  ///< one parameter explains the moves, with a probability of at least 0.95, and P ≥ 0.05 of moves
        ///< this far from those simulated
  several,  ///< several do
  none,     ///< no single one does: P < 0.001 of moves this far from those simulated
  unknown   ///< nothing can be said: too few moves, or none of the candidates acts on the measures
};

struct ChangeExplanation {
  ChangeTold told{ChangeTold::unknown};
  std::vector<ParameterChange> parameters{};  ///< those that are plausible, likeliest first
  /// First move of the change, from 1; 1: the machine is from its first move on unlike those simulated.
  std::int64_t since{1};
  double misfit{0.0};                ///< the smallest of all parameters
  double max_misfit{0.0};            ///< that the right one exceeds with the probability 0.001
  std::string reason{};              ///< of `unknown`
  std::vector<std::string> tried{};  ///< names of the parameters that act on the measures
};

inline constexpr double plausible_change = 0.05;  ///< smallest probability
inline constexpr std::size_t min_moves_before = 20;
inline constexpr std::size_t min_moves_after = 20;

/// Tells what changed by a simulated (synthetic) likelihood (Wood, Nature 466 (2010) 1102).
///
/// A value counts by its normal score z = Φ⁻¹(rank/(n + 1)) among the n values of the unchanged machines.
/// The change is where the means before and after it differ most, max over s of s·(N − s)/N·|W^(−1/2)·(z̄₁ −
/// z̄₂)|², if that is significant at 0.001 (Bonferroni over s); otherwise the machine is compared with those
/// simulated, as a whole. The statistic D is the mean z of each measure after the change, less that before
/// it, if there is one. For each factor f of each parameter D is normal, with
///
///     mean μ(f) = mean over machines of z̄(f) − z̄(1);  covariance C(f) = B(f) + W(1)/n_before + W(f)/n_after
///
/// B between machines (less what their few moves add), W within one, enlarged by (1 + ρ)/(1 − ρ) with the
/// serial correlation ρ of the observed moves. Without a change μ(f) is the mean of z̄(f), and B that of z̄(f).
/// Between the factors μ and C are interpolated in log f, between amounts in these. All parameters have the
/// same prior, log f or the amount evenly over the range.
///
/// Of measures that correlate by more than 0.9 the first counts, and none with one value in most moves; at
/// most eight.
/// @param observed the moves of the machine @param measures number of measures of a move, the most telling
/// first @param plausible smallest probability of a parameter to be named
ChangeExplanation explain_change(std::span<const ChangeCandidate> candidates, const MachineMoves& observed,
                                 std::size_t measures, double plausible = plausible_change);

}  // namespace zerocount::monitor
