#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "analysis/comparison/measure_comparison.hpp"
#include "analysis/two_samples/continuation.hpp"
#include "analysis/two_samples/quick_tests.hpp"

/// A sample as the sums that its judgement needs, for samples that go on.
namespace zerocount::comparison {

/// Sums over units; their meaning depends on the kind of sample.
using SampleSums = std::array<double, 6>;

/// Sums of both files; pairs have theirs in the first.
using FileSums = std::array<SampleSums, 2>;

/// The weights of blocks of both files.
using FileWeights = std::array<std::vector<double>, 2>;

/// A sample of units by blocks: each row holds the mean sums of one unit of the block.
class BlockedSums {
 public:
  BlockedSums() = default;
  /// @param rows [unit]
  BlockedSums(const std::vector<SampleSums>& rows, const two_samples::Continuation& continuation);

  const SampleSums& seen() const { return seen_; }
  /// With so many units like each block.
  SampleSums weighted(const std::vector<double>& weights) const;

 private:
  std::vector<SampleSums> blocks_;
  SampleSums seen_{};
};

/// The sample of one measure.
class JudgedMeasure {
 public:
  JudgedMeasure(const MeasureSample& sample, const std::array<two_samples::Continuation, 2>& continuations);

  FileSums seen() const { return {files_[0].seen(), files_[1].seen()}; }
  FileSums weighted(const FileWeights& weights) const;

  bool proportion() const { return proportion_; }
  bool paired() const { return paired_; }

  /// Takes the effect that `population` has (sums of one unit) out of `more` further units.
  void remove_effect(FileSums& further, const FileSums& population) const;

  /// Adds units that are of a kind that the sample has none of: of proportions, pairs that differ either
  /// way, or failures and successes.
  void add_unseen(SampleSums& sums, double first_kind, double second_kind) const;

  /// @param ranks whether the rank test speaks too
  two_samples::QuickResult test(const FileSums& sums, double confidence, bool ranks) const;

 private:
  two_samples::QuickResult test_means(const FileSums& sums, double confidence, bool ranks) const;

  bool proportion_;
  bool paired_;
  double plausible_;
  std::array<BlockedSums, 2> files_;
};

}  // namespace zerocount::comparison
