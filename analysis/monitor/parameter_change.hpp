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
  std::string unit{};  ///< unit of an amount
  double change{1.0};  ///< most likely factor, or amount
  double low{1.0};     ///< low end of its 95 % interval by the likelihood, or of the range where it goes on
  double high{1.0};    ///< high end
  /// Probability that this parameter changed, if one of those that explain the moves did and all were alike
  /// before.
  double probability{0.0};
  /// Squared Mahalanobis distance of the moves from those simulated with the most likely change.
  double misfit{0.0};
  double max_misfit{0.0};   ///< misfit that the right parameter exceeds with the probability 0.01
  bool explains{false};     ///< Whether it explains the moves, as explain_change() says.
  bool beyond_low{false};   ///< The interval reaches the lowest simulated change.
  bool beyond_high{false};  ///< The interval reaches the highest simulated change.

  bool fits() const { return misfit <= max_misfit; }
};

enum class ChangeTold {
  one,      ///< One parameter explains the moves.
  several,  ///< Several explain them, or one does and others were not tried.
  none,     ///< No single one explains them.
  unknown   ///< There are too few moves, no candidate acts on the measures, or none was tried.
};

struct ChangeExplanation {
  ChangeTold told{ChangeTold::unknown};
  std::vector<ParameterChange> parameters{};  ///< those that explain the moves, likeliest first
  std::vector<ParameterChange> ranked{};      ///< all that act on the measures, likeliest first
  /// First move of the change, from 1; 1: the machine is from its first move on unlike those simulated.
  std::int64_t since{1};
  double misfit{0.0};                  ///< the smallest misfit of all parameters
  double max_misfit{0.0};              ///< its limit
  std::string reason{};                ///< reason for `unknown`
  std::vector<std::string> tried{};    ///< names of the parameters that act on the measures
  std::vector<std::string> untried{};  ///< names of those that the budget did not suffice for
  std::int64_t max_trials{0};          ///< most trials that all parameters take; 0: not known
};

inline constexpr std::size_t min_moves_before = 20;
inline constexpr std::size_t min_moves_after = 20;

/// Tells what changed by a simulated (synthetic) likelihood (Wood, Nature 466 (2010) 1102).
///
/// A value counts by its rank u = rank/(n + 1) among the n values of the unchanged machines, and each measure
/// by two features of it: the normal score Φ⁻¹(u) for the place of its distribution, and √5·(6u² − 6u + 1),
/// the second Legendre polynomial, for its width. The change is where the mean scores before and after it
/// differ most, max over s of s·(N − s)/N·|W^(−1/2)·(z̄₁ − z̄₂)|², if that is significant at 0.001 (Bonferroni
/// over s); otherwise the machine is compared with those simulated, as a whole. The statistic D is the mean
/// of each feature after the change, less that before it, if there is one. With the factor f of a parameter
/// D has
///
///     mean μ(f) = mean over machines of φ̄(f) − φ̄(1)
///     covariance C(f) = (1 + 1/m)·B(f) + W(1)/n_before + W(f)/n_after + V(f)/N
///
/// with B between the m simulated machines (less what their few moves add), W within one, and V/N the error
/// of μ by the N simulated moves; each feature of W is enlarged by (1 + ρ)/(1 − ρ), ρ the serial correlation
/// of the observed moves. Without a change before, μ(f) is the mean of φ̄(f), B its spread and V = W. C is
/// estimated with ν degrees of freedom, so that the likelihood is the t distribution
/// |C|^(−1/2)·(1 + Q/ν)^(−(ν + 1)/2), Q = (D − μ)ᵀC⁻¹(D − μ) (Sellentin and Heavens, Mon. Not. R. Astron.
/// Soc. 456 (2016) L132), with the smallest ν for all. Between the factors μ and C are interpolated in log f,
/// between amounts in these.
///
/// A parameter *explains* the moves if Q at its most likely change is at most the 99 % quantile of Q for the
/// right parameter (Hotelling's T²: x + x·(x + p)/2ν with the quantile x of χ² with p degrees of freedom),
/// and at most 9.2 above the smallest such Q, which is a likelihood ratio of 1 %. If C were exact, the right
/// one would be missing in one or two cases of a hundred. Where no parameter explains the moves, none of the
/// candidates is right. Probabilities are by the likelihoods without |C|, which has the errors of the
/// simulation, averaged over the range: all parameters have the same prior, log f or the amount evenly.
///
/// A feature that the others tell (with a residual variance below 0.19) is left out, and so is a measure with
/// one value in 80 % of the moves. There are at most 16 features, and one for each four machines that differ.
/// @param observed the moves of the machine @param measures number of measures of a move, the most telling
/// first
ChangeExplanation explain_change(std::span<const ChangeCandidate> candidates, const MachineMoves& observed,
                                 std::size_t measures);

}  // namespace zerocount::monitor
