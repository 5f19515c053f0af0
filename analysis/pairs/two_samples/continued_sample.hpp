#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/pairs/two_samples/sample.hpp"

/// Simulated continuation of a sample: further units are drawn from the population that the observed units
/// suggest, and the change of all units together is computed.
namespace zerocount::two_samples {

/// Purpose of a random number in a simulated continuation of a sample; each purpose has its own numbers.
enum class ContinuationDraw : std::uint32_t {
  population,
  further_units,
  nil_effect,
  unseen_kind,
  unseen_units
};

/// Random bits for a simulated continuation, a function of the four arguments only.
std::uint64_t continuation_bits(std::uint32_t simulation, std::uint32_t stream, std::uint64_t index,
                                ContinuationDraw draw);

/// A random number of the Poisson distribution with this mean, from random bits: by inversion, from a mean of
/// 30 on by a rounded normal number.
double poisson_number(double mean, std::uint64_t bits);

/// Simulated continuation of a sample of units that are independent of each other. The population is drawn
/// from the posterior that the sample gives it (the Bayesian bootstrap: Rubin, Annals of Statistics 9 (1981),
/// 130), and further units from that population, so that the forecast includes what the sample leaves unknown
/// (the Pólya posterior: Lo, Annals of Statistics 16 (1988), 1684).
///
/// A sample of many units is drawn in blocks of neighbours. The units of a block are independent of each
/// other, so the variance of sums does not change.
class Continuation {
 public:
  /// @param units number of units in the sample
  /// @param stream number of the stream of its random numbers
  Continuation(std::int64_t units, std::uint32_t stream);

  std::int64_t units() const { return units_; }
  std::size_t blocks() const { return blocks_; }
  std::size_t block_of(std::int64_t unit) const;
  /// Number of the sample's units in a block.
  double size_of(std::size_t block) const;

  /// [block] Proportion of the population that is like the units of the block, drawn for the simulation with
  /// this number.
  std::vector<double> population(std::uint32_t simulation) const;

  /// [block] Number of further units like those of the block: Poisson numbers of whole blocks, drawn for the
  /// simulation with this number. In the mean there are `more` units in all.
  std::vector<double> further_units(const std::vector<double>& population, double more,
                                    std::uint32_t simulation) const;

 private:
  std::int64_t units_;
  std::uint32_t stream_;
  std::size_t blocks_;
};

/// Sums over units of a sample; see the enumeration Sum in the source for their meaning, which depends on the
/// kind of sample.
using Sums = std::array<double, 6>;
void add(Sums& sums, const Sums& more);

/// [file] Sums of the baseline and the current file. For pairs, all sums are in the first element.
using FileSums = std::array<Sums, 2>;

/// [file][block] Weight of the block in a resample of both files.
using FileWeights = std::array<std::vector<double>, 2>;

/// The units of a sample divided into the blocks of a continuation, with the mean sums of a unit in each
/// block. The memory does not grow with the number of units.
class BlockedSums {
 public:
  BlockedSums() = default;
  /// @param units sums of each single unit
  BlockedSums(const std::vector<Sums>& units, const Continuation& continuation);

  const Sums& seen() const { return seen_; }
  /// Sums over a sample that has, for each block, `weights[block]` units like those of the block.
  Sums weighted(const std::vector<double>& weights) const;

 private:
  std::vector<Sums> blocks_;
  Sums seen_{};
};

/// A baseline and a current sample reduced to the sums from which their change is computed, for forecasts
/// with more units.
class ContinuedSample {
 public:
  ContinuedSample(const Sample& sample, const std::array<Continuation, 2>& continuations);

  FileSums seen() const { return {files_[0].seen(), files_[1].seen()}; }
  FileSums weighted(const FileWeights& weights) const;

  bool failures() const { return failures_; }
  bool paired() const { return paired_; }

  /// Removes from `further`, the sums of `more` further units, the effect that the population has, as if
  /// there were no change.
  /// @param population sums of one unit of the population
  void remove_effect(FileSums& further, const FileSums& population) const;

  /// Adds units of two kinds that the sample may not contain: pairs of which only one failed, in either
  /// direction, or failures and successes.
  /// @param sums sums of a sample of failures
  /// @param first_kind, second_kind numbers of units to add
  void add_unseen(Sums& sums, double first_kind, double second_kind) const;

  /// change_of() a sample with these sums, quick enough for simulations: the p-values are approximations by
  /// the normal distribution, ranks keep the scores that they have in the sample, and the bounds of failures
  /// are exact.
  /// @param ranks whether the rank test counts too
  Change change_of(const FileSums& sums, double confidence, bool ranks, double margin = 0.0) const;

 private:
  Change change_of_means(const FileSums& sums, double confidence, bool ranks, double margin) const;

  bool failures_;
  bool paired_;
  double plausible_;
  std::array<BlockedSums, 2> files_;
};

/// One-sided bounds of a mean as cautious_bounds() gives them, but quick, each with a confidence of its own.
/// @param sums number of values, their sum and the sum of their squares
/// @param plausible plausible difference of a single unit
statistics::ConfidenceInterval quick_bounds(const Sums& sums, double plausible, double low_confidence,
                                            double high_confidence);

}  // namespace zerocount::two_samples
