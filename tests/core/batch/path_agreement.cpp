#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/loop/encoder.hpp"
#include "tests/core/batch/batch_agreement.hpp"

namespace zerocount::testing {
namespace {

/// A trial simulated by the reference twice: with its inertia, and with one that is larger by the relative
/// change 1e-12.
class Sensitivity {
 public:
  Sensitivity(const trial::TrialParameters& parameters, const BatchedTrial& reference)
      : parameters_(parameters), reference_(reference) {}

  /// Largest difference of the rotor angle θ between the two simulations up to sample k, in counts, as long
  /// as no count and no code differs. Must be called with ascending k.
  double up_to(std::size_t k) {
    if (!twin_) {
      trial::TrialParameters changed = parameters_;
      changed.plant.inertia *= 1.0 + 1e-12;
      twin_ = run_by_reference(changed);
    }
    for (; next_ <= k && !has_parted_; ++next_) {
      const batch::BatchSample& one = twin_->samples[next_];
      const batch::BatchSample& other = reference_.samples[next_];
      const double difference = std::abs(one.theta - other.theta);
      largest_ = std::max(largest_, difference / loop::fine_resolution(parameters_.encoder));
      has_parted_ = one.count != other.count || one.code != other.code;
    }
    return largest_;
  }
  bool has_parted() const { return has_parted_; }

 private:
  const trial::TrialParameters& parameters_;
  const BatchedTrial& reference_;
  std::optional<BatchedTrial> twin_;
  std::size_t next_{0};
  double largest_{0.0};
  bool has_parted_{false};
};

}  // namespace

PathAgreement path_agreement(const trial::TrialParameters& parameters, const BatchedTrial& batched,
                             const BatchedTrial& reference) {
  if (batched.samples.size() != reference.samples.size())
    return {.astray = fmt::format("{} samples, not {}", batched.samples.size(), reference.samples.size())};
  const double resolution = loop::fine_resolution(parameters.encoder);
  Sensitivity sensitivity(parameters, reference);
  double travel = 0.0;
  for (std::size_t k = 0; k < reference.samples.size(); ++k) {
    const batch::BatchSample& a = batched.samples[k];
    const batch::BatchSample& b = reference.samples[k];
    if (k > 0) travel += std::abs(b.theta - reference.samples[k - 1].theta) / resolution;
    const double difference = std::abs(a.theta - b.theta) / resolution;
    const bool agrees = difference < 1e-6 + 1e-9 * travel || difference < sensitivity.up_to(k);
    if (!agrees && sensitivity.has_parted()) return {.amplifies = true};
    if (!agrees) return {.astray = fmt::format("{} count at sample {}", difference, k)};
    if (a.count != b.count || a.code != b.code) return {.parts = true};
  }
  return {};
}

}  // namespace zerocount::testing
