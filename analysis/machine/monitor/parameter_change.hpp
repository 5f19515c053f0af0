#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Identifies the parameter of a simulated study that has changed, from the moves of a machine that changed.
namespace zerocount::monitor {

/// Moves of one machine: the measures of the first move, then those of the next, and so on. The number of
/// measures per move is given separately.
using MoveValues = std::vector<double>;

/// Kind of a parameter's change.
enum class ChangeKind {
  factor,  ///< The parameter's value is multiplied by a factor.
  amount   ///< An amount is added to the parameter's value. This kind is used if the value may be 0.
};

/// The moves of simulated machines with a changed parameter. The machines are the same for every change. A
/// change may contain only the first moves of each.
struct SimulatedChange {
  double change{1.0};  ///< Factor on the parameter, or amount added to it in its unit.
  std::vector<MoveValues> machines;
};

/// A parameter that may have changed.
struct ChangeCandidate {
  std::string parameter;  ///< Dotted path of the parameter, such as friction.k1.
  /// Simulated changes in rising order; the unchanged parameter (unchanged_by(kind)) is among them.
  std::vector<SimulatedChange> changes;
  ChangeKind kind{ChangeKind::factor};
  std::string unit{};  ///< Unit of the change if it is an amount; empty for a factor.
};

constexpr double unchanged_by(ChangeKind kind) {
  return kind == ChangeKind::factor ? 1.0 : 0.0;
}

/// Result for one parameter: its most likely change, and how well that explains the moves.
struct ParameterChange {
  std::string parameter;
  ChangeKind kind{ChangeKind::factor};
  std::string unit{};  ///< Unit of the change if it is an amount; empty for a factor.
  double change{1.0};  ///< Most likely change: factor, or amount in `unit`.
  /// Low end of the 95 % likelihood interval of the change; the end of the simulated range if the interval
  /// continues beyond it.
  double low{1.0};
  /// High end of the 95 % likelihood interval of the change, or of the simulated range if the interval
  /// continues beyond it.
  double high{1.0};
  /// Probability that this parameter changed, given that one of the explaining parameters did and that all
  /// had the same prior probability.
  double probability{0.0};
  /// Squared Mahalanobis distance of the moves from those simulated with the most likely change.
  double misfit{0.0};
  double max_misfit{0.0};  ///< Misfit that the right parameter exceeds with the probability 0.01.
  /// True if the parameter explains the moves in the sense of explain_change().
  bool explains{false};
  /// True if the 95 % interval reaches the lowest simulated change, so that the change may be lower still.
  bool beyond_low{false};
  /// True if the 95 % interval reaches the highest simulated change, so that the change may be higher still.
  bool beyond_high{false};

  bool fits() const { return misfit <= max_misfit; }
};

enum class ExplanationKind {
  one,  ///< One parameter explains the moves.
  /// Several parameters explain the moves, or one does and others were not tried.
  several,
  none,    ///< No single parameter explains the moves.
  unknown  ///< There are too few moves, no candidate acts on the measures, or none was tried.
};

struct ChangeExplanation {
  ExplanationKind told{ExplanationKind::unknown};
  std::vector<ParameterChange> parameters{};  ///< Parameters that explain the moves, most likely first.
  /// All parameters that act on the measures, most likely first.
  std::vector<ParameterChange> ranked{};
  /// First move of the observed machine after the change, from 1. If it is 1, the machine differs from the
  /// simulated ones from its first move on.
  std::int64_t since{1};
  double misfit{0.0};      ///< Smallest ParameterChange::misfit of all parameters.
  double max_misfit{0.0};  ///< Largest misfit that still explains the moves, see ParameterChange::max_misfit.
  /// Reason why nothing is known, as text, if the kind is ExplanationKind::unknown; otherwise empty.
  std::string reason{};
  std::vector<std::string> tried{};  ///< Names of the parameters that were tried and act on the measures.
  /// Names of the parameters that were not tried because the budget of trials was used up.
  std::vector<std::string> untried{};
  /// Largest number of trials that it takes to try all parameters; 0: not known.
  std::int64_t max_trials{0};
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
/// @param observed the moves of the machine
/// @param measures number of measures of a move, the most telling first
ChangeExplanation explain_change(std::span<const ChangeCandidate> candidates, const MoveValues& observed,
                                 std::size_t measures);

}  // namespace zerocount::monitor
