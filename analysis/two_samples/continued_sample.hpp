#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/two_samples/sample.hpp"

/// Simulated continuation of a sample: further units are drawn from the population that the observed units
/// suggest, and the change of all units together is computed.
namespace zerocount::two_samples {

/// Purpose of a random number of a continuation.
enum class ContinuationDraw : std::uint32_t {
  population,
  further_units,
  nil_effect,
  unseen_kind,
  unseen_units
};

/// Random bits of a simulation, a function of the four arguments only.
std::uint64_t continuation_bits(std::uint32_t simulation, std::uint32_t stream, std::uint64_t index,
                                ContinuationDraw draw);

/// A Poisson number with this mean: by inversion, from a mean of 30 on the rounded normal one.
double poisson_number(double mean, std::uint64_t bits);

/// The continuation of a sample of units that are independent of each other. The population is drawn from the
/// posterior that the sample gives it (the Bayesian bootstrap: Rubin, Annals of Statistics 9 (1981), 130),
/// and further units from that population, so that the forecast includes what the sample leaves unknown (the
/// Pólya posterior: Lo, Annals of Statistics 16 (1988), 1684).
///
/// A sample of many units is drawn in blocks of neighbours. The units of a block are independent of each
/// other, so the variance of sums does not change.
class Continuation {
 public:
  /// @param units of the sample; @param stream of its random numbers
  Continuation(std::int64_t units, std::uint32_t stream);

  std::int64_t units() const { return units_; }
  std::size_t blocks() const { return blocks_; }
  std::size_t block_of(std::int64_t unit) const;
  /// Number of units in a block.
  double size_of(std::size_t block) const;

  /// Proportions of the population that are like each block, for simulation number `simulation`.
  std::vector<double> population(std::uint32_t simulation) const;

  /// Numbers of further units like each block: whole blocks, in Poisson numbers; `more` units in the mean.
  std::vector<double> further_units(const std::vector<double>& population, double more,
                                    std::uint32_t simulation) const;

 private:
  std::int64_t units_;
  std::uint32_t stream_;
  std::size_t blocks_;
};

/// Sums over units; their meaning depends on the kind of sample.
using Sums = std::array<double, 6>;
void add(Sums& sums, const Sums& more);

/// Sums of both files. The sums of pairs are in the first.
using FileSums = std::array<Sums, 2>;

/// [file][block] Weight of the block in a resample of both files.
using FileWeights = std::array<std::vector<double>, 2>;

/// Units in the blocks of a continuation. A block holds the mean sums of one of its units. The memory does
/// not grow with the number of units.
class BlockedSums {
 public:
  BlockedSums() = default;
  /// @param units the sums of each
  BlockedSums(const std::vector<Sums>& units, const Continuation& continuation);

  const Sums& seen() const { return seen_; }
  /// Sums over `weights` units like each block.
  Sums weighted(const std::vector<double>& weights) const;

 private:
  std::vector<Sums> blocks_;
  Sums seen_{};
};

/// A sample reduced to the sums from which its change is computed.
class ContinuedSample {
 public:
  ContinuedSample(const Sample& sample, const std::array<Continuation, 2>& continuations);

  FileSums seen() const { return {files_[0].seen(), files_[1].seen()}; }
  FileSums weighted(const FileWeights& weights) const;

  bool failures() const { return failures_; }
  bool paired() const { return paired_; }

  /// Takes the effect that `population` has (sums of one unit) out of `more` further units.
  void remove_effect(FileSums& further, const FileSums& population) const;

  /// Adds units of two kinds of which the sample may have none: pairs of which only one failed, in either
  /// direction, or failures and successes.
  /// @param sums sums of failures
  void add_unseen(Sums& sums, double first_kind, double second_kind) const;

  /// change_of() a sample with these sums, quick enough for simulations: the p-values are approximations by
  /// the normal distribution, ranks keep the scores that they have in the sample, and the bounds of failures
  /// are exact. @param ranks whether the rank test counts too
  Change change_of(const FileSums& sums, double confidence, bool ranks, double margin = 0.0) const;

 private:
  Change change_of_means(const FileSums& sums, double confidence, bool ranks, double margin) const;

  bool failures_;
  bool paired_;
  double plausible_;
  std::array<BlockedSums, 2> files_;
};

/// One-sided bounds of a mean as cautious_bounds() gives them, each with a confidence of its own.
/// @param sums number of values, their sum and the sum of their squares
statistics::ConfidenceInterval quick_bounds(const Sums& sums, double plausible, double low_confidence,
                                            double high_confidence);

}  // namespace zerocount::two_samples
