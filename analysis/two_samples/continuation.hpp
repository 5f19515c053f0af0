#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// How a sample might go on: simulated further units from what the seen ones say of their population.
namespace zerocount::two_samples {

/// Purpose of a random number of a continuation.
enum class ContinuationDraw : std::uint32_t {
  population,
  further_units,
  nil_effect,
  unseen_kind,
  unseen_units
};

/// Random bits of a simulation: a function of these four numbers alone.
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

}  // namespace zerocount::two_samples
