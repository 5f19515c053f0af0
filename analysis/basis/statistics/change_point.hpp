#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/unknown.hpp"

/// Changes of the level of a sequence of measurements that comes one by one.
namespace zerocount::statistics {

/// Numbers of pairs of a series whose later value is larger, smaller or equal.
struct RankTrend {
  std::int64_t rising{0};   ///< Number of pairs whose later value is larger.
  std::int64_t falling{0};  ///< Number of pairs whose later value is smaller.
  std::int64_t equal{0};    ///< Number of pairs of equal values.

  RankTrend& operator+=(const RankTrend& other);

  template <class Self, class Archive>
  static void transfer(Self& self, Archive& archive) {
    archive(self.rising, self.falling, self.equal);
  }
};

/// Counts the pairs of a series in O(n log n) time. rising − falling is the Mann–Kendall statistic S:
/// positive if the series tends to rise. Both signs are equally likely if the order of the values is random.
/// Values must not be NaN. Source: Mann (1945); Kendall, Rank Correlation Methods.
RankTrend rank_trend(std::span<const double> series);

/// Kendall's τ_a = (rising − falling)/pairs, in [−1, 1]; NaN where there are no pairs.
double kendall_tau(const RankTrend& trend);

/// Kind of a measurement, which determines the likelihood.
enum class MeasurementKind {
  /// Mean of n values. The likelihood is normal; the variance of each measurement is known.
  mean,
  /// Proportion of n trials. The likelihood is binomial, with a design effect if trials depend on each other.
  proportion
};

/// One measurement of a sequence, in the order of time.
struct Measurement {
  double value{0.0};
  /// Number n > 0 of values (of a mean) or trials (of a proportion) behind the measurement.
  double size{1.0};
  double dispersion{1.0};  ///< For a mean: variance of one value. For a proportion: design effect, ≥ 1.
  /// Index of the set of random numbers with which the measurement was made. Measurements with the same index
  /// used the same numbers, so their errors are correlated.
  std::size_t draws{0};
};

/// A change of the level of a sequence of measurements that became significant.
struct LevelChange {
  std::size_t first{0};     ///< Index of the first measurement after the change, as estimated.
  std::size_t detected{0};  ///< Index of the measurement at which the change became significant.
  double before{unknown};   ///< Mean of the measurements before `first`, since the preceding change.
  double after{unknown};    ///< Mean of the measurements from `first` up to `detected`.
  double z{0.0};            ///< Signed root of the likelihood ratio statistic: positive if the level rose.
};

/// Converts a mean of n values with confidence bounds to a measurement. The bounds are taken as those of a
/// normal distribution, so the dispersion is n·((high − low)/2z)². Nothing unless the bounds are finite, low
/// < high and n > 0.
std::optional<Measurement> measured_mean(double value, double n, const ConfidenceInterval& bounds,
                                         double confidence);

/// Converts a proportion of n trials with confidence bounds to a measurement. The design effect is the
/// squared ratio of the width of the bounds to the width of the Clopper–Pearson bounds for independent
/// trials; it is at least 1. Nothing unless 0 ≤ value ≤ 1 and n > 0.
std::optional<Measurement> measured_proportion(double value, double n, const ConfidenceInterval& bounds,
                                               double confidence);

/// The threshold h of level_changes() with which a sequence without a change gives a false alarm with this
/// probability at each further measurement:
///
///   p = h·e^(−h²/2)/√(2π)·∫₀ʰ x·ν(x)² dx,  ν(x) = (2/x)·(Φ(x/2) − ½)/((x/2)·Φ(x/2) + φ(x/2)).
///
/// An approximation for large h: Siegmund and Venkatraman, Annals of Statistics 23 (1995), 255, Theorem 1,
/// where 1/p is the mean time between false alarms; ν from Siegmund, Sequential Analysis (1985), (4.38).
/// @param probability in (0, 0.05].
double change_threshold(double probability);

/// The changes of the level of a sequence of measurements, each found at the first measurement that shows it.
///
/// After each measurement, every division of all of them into n₀ values before and n₁ values from the k-th
/// on, with means m₀, m₁ and m together and the average dispersion φ, gives the likelihood ratio statistic of
/// two levels against one:
///
///   mean:        Z_k² = (m₁ − m₀)²/(φ·(1/n₀ + 1/n₁)),
///   proportion:  Z_k² = (2/φ)·Σᵢ nᵢ·(mᵢ·ln(mᵢ/m) + (1 − mᵢ)·ln((1 − mᵢ)/(1 − m))).
///
/// A change is significant where max |Z_k| ≥ h (Siegmund and Venkatraman 1995, section 2), and the maximum
/// estimates k. The search then starts again with the measurements from k on.
///
/// The dispersion is averaged because that of a single measurement depends on its value: weights by it would
/// favour the values on one side. Measurements on one side that were made with the same random numbers count
/// as a single one, their average: what the errors of such measurements have in common is not evidence. As
/// they are not correlated negatively, the variance of Z_k is then at most about 1.
/// @param threshold h, see change_threshold()
std::vector<LevelChange> level_changes(MeasurementKind kind, std::span<const Measurement> measurements,
                                       double threshold);

}  // namespace zerocount::statistics
