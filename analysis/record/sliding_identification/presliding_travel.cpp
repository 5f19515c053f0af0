#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <ceres/autodiff_cost_function.h>

#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "analysis/record/sliding_identification/sliding_record.hpp"
#include "core/friction/sliding/sliding.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {
namespace {

constexpr double bands_per_octave = 2.0;
constexpr int reference_bands = 2;        // of the longest travels
constexpr double lowest_travel = 4.0;     // steps of the readings
constexpr double visible_deficit = 0.05;  // of the sliding level
constexpr double standard_errors = 3.0;
constexpr double margin = 4.0;

/// Least-squares equations of the torque balance in which each band of the travel since standstill or
/// reversal has its own friction level.
class LevelsByTravel {
 public:
  LevelsByTravel(double longest, double shortest, std::size_t correlated)
      : longest_(longest),
        correlated_(static_cast<double>(correlated)),
        bands_(std::max(reference_bands, band_of(shortest))) {
    normal_ = Eigen::MatrixXd::Zero(balance_terms + bands_, balance_terms + bands_);
    right_ = Eigen::VectorXd::Zero(balance_terms + bands_);
    samples_.assign(static_cast<std::size_t>(bands_), 0.0);
  }

  int bands() const { return bands_; }
  double samples(int band) const { return samples_[static_cast<std::size_t>(band)]; }
  double upper_end(int band) const { return longest_ * std::exp2(-band / bands_per_octave); }

  void add(const TorqueBalance& balance, double direction, double travel) {
    const int band = std::clamp(band_of(travel), 0, bands_ - 1);
    const Eigen::Index own = balance_terms + band;
    normal_.topLeftCorner<balance_terms, balance_terms>() += balance.terms * balance.terms.transpose();
    normal_.col(own).head<balance_terms>() += direction * balance.terms;
    normal_.row(own).head<balance_terms>() += direction * balance.terms.transpose();
    normal_(own, own) += 1.0;
    right_.head<balance_terms>() += balance.torque * balance.terms;
    right_[own] += direction * balance.torque;
    squares_ += balance.torque * balance.torque;
    samples_[static_cast<std::size_t>(band)] += 1.0;
  }

  /// Whether the friction in `band` is significantly below the common level of the bands with longer travel,
  /// and the bands with shorter travel are on average as low or lower.
  bool is_lower(int band) const {
    std::vector<Eigen::Index> used;
    for (Eigen::Index i = 0; i < balance_terms; ++i) used.push_back(i);
    for (int i = band; i < bands_; ++i) {
      if (samples(i) > 0.0) used.push_back(balance_terms + i);
    }
    const Eigen::VectorXd scale =
        normal_.diagonal()(used).cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd inverse =
        numerics::pseudo_inverse(scale.asDiagonal() * normal_(used, used) * scale.asDiagonal());
    const Eigen::VectorXd found =
        scale.cwiseProduct(numerics::product(inverse, scale.cwiseProduct(right_(used))));
    const double level = found[direction_term];
    const double count = std::accumulate(samples_.begin(), samples_.end(), 0.0);
    const double variance = std::max(0.0, squares_ - found.dot(right_(used))) / count;
    const double error =
        scale[balance_terms] * std::sqrt(variance * correlated_ * inverse(balance_terms, balance_terms));
    double below = 0.0;
    double samples_below = 0.0;
    for (std::size_t i = balance_terms + 1; i < used.size(); ++i) {
      const double number = samples(static_cast<int>(used[i] - balance_terms));
      below += number * found[static_cast<Eigen::Index>(i)];
      samples_below += number;
    }
    const double deficit = -found[balance_terms];
    return level > 0.0 && deficit > std::max(visible_deficit * level, standard_errors * error) &&
           -below >= deficit * samples_below;
  }

 private:
  int band_of(double travel) const {
    return static_cast<int>(bands_per_octave * std::log2(longest_ / travel));
  }

  double longest_;
  double correlated_;  ///< Number of successive samples whose errors are correlated because of smoothing.
  int bands_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd right_;
  double squares_{0.0};
  std::vector<double> samples_;
};

}  // namespace

double presliding_travel(const SlidingRecord& record, std::span<const Window> runs) {
  const auto travel_at = [&](const Window& run, std::size_t k) {
    return std::abs(record.position[k] - record.position[run.first]);
  };
  double longest = 0.0;
  for (const Window& run : runs) longest = std::max(longest, travel_at(run, run.last));
  const double shortest = lowest_travel * record.resolution;
  if (longest <= shortest) return 0.0;
  LevelsByTravel levels(longest, shortest, 2 * balance_reach(record));
  for (const Window& run : runs) {
    for (std::size_t k = run.first + record.smoothing + balance_reach(record);
         k + balance_reach(record) <= run.last; ++k) {
      if (const double travel = travel_at(run, k); travel > 0.0)
        levels.add(torque_balance(record, k, run.direction), run.direction, travel);
    }
  }
  for (int band = reference_bands; band < levels.bands(); ++band) {
    if (levels.samples(band) == 0.0 || !levels.is_lower(band)) continue;
    const double end = levels.upper_end(band);
    return std::min(margin * end, std::max(end, longest / margin));
  }
  return 0.0;
}

}  // namespace zerocount::sliding_identification
