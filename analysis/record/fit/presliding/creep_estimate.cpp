#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/record/fit/presliding/starting_point.hpp"
#include "core/numerics/elementary_functions.hpp"

namespace zerocount::fit {
namespace {

constexpr std::array exponents{1.0, 1.5, 2.0, 2.5, 3.0, 4.0};
constexpr int rates = 14;  // number of values of α tried, by factors of 2 from the smallest

/// Largest number of samples at the beginning of a hold (constant torque) in which the rotor may oscillate;
/// at most a quarter of the hold.
constexpr std::size_t oscillation_samples = 100;

/// Number of samples at the beginning of a hold (constant torque) that may be those of an oscillation.
std::size_t oscillating_samples(const TorqueHold& hold) {
  return std::min((hold.last - hold.first + 1) / 4, oscillation_samples);
}

/// Longest time in which the rotor may oscillate at the beginning of any hold, s. Creep can be distinguished
/// from an oscillation only if it is slower. If there are longer holds, shorter ones are left out.
double longest_oscillation(Records records) {
  double longest = 0.0;
  for (const TestRecord& record : records) {
    for (const TorqueHold& hold : record.parts.holds) {
      const auto samples = static_cast<double>(oscillating_samples(hold));
      longest = std::max(longest, samples * record.sample_time);
    }
  }
  return longest;
}

/// Sums over the samples of the holds, each about the mean of its hold. x: creep law with a limit of 1 rad;
/// y: measured angle.
struct HoldSums {
  double xx{0.0};
  double xy{0.0};
  double yy{0.0};
};

void add_hold(const TorqueHold& hold, const Eigen::VectorXd& law, const Eigen::VectorXd& angle,
              HoldSums& sums) {
  const auto samples = static_cast<Eigen::Index>(hold.last - hold.first + 1);
  const auto skipped = static_cast<Eigen::Index>(oscillating_samples(hold));
  const auto x = law.segment(static_cast<Eigen::Index>(hold.first) + skipped, samples - skipped).array();
  const auto y = angle.segment(static_cast<Eigen::Index>(hold.first) + skipped, samples - skipped).array();
  const double x_mean = x.mean();
  const double y_mean = y.mean();
  sums.xx += (x - x_mean).square().sum();
  sums.xy += ((x - x_mean) * (y - y_mean)).sum();
  sums.yy += (y - y_mean).square().sum();
}

}  // namespace

Eigen::VectorXd measured_angle(const TestRecord& record) {
  return record.unit * (readings_of(record).array() + middle_of_reading(record));
}

Eigen::VectorXd creep_extension(const TestRecord& record, const CreepEstimate& creep, double creep_torque) {
  Eigen::VectorXd extension(static_cast<Eigen::Index>(sample_count(record)));
  const double decay = std::exp(-creep.alpha * record.sample_time);
  double hardening = record.start.hardening;
  double extended = 0.0;
  double torque = 0.0;
  double limit = 0.0;
  for (std::size_t k = 0; k < sample_count(record); ++k) {
    extension[static_cast<Eigen::Index>(k)] = extended;
    if (record.torque[k].now != torque) {
      torque = record.torque[k].now;
      const double ratio = std::abs(torque) / creep_torque;
      limit = torque == 0.0 ? 0.0 : creep.limit * numerics::exp(creep.exponent * numerics::log(ratio));
    }
    if (limit <= hardening) continue;
    const double growth = (limit - hardening) * (1.0 - decay);
    hardening += growth;
    extended += std::copysign(growth, torque);
  }
  return extension;
}

CreepEstimate estimate_creep(Records records, double creep_torque) {
  std::vector<Eigen::VectorXd> angles;
  double longest = 0.0;
  for (const TestRecord& record : records) {
    angles.push_back(measured_angle(record));
    longest = std::max(longest, record.sample_time * static_cast<double>(sample_count(record)));
  }
  const double oscillation = longest_oscillation(records);
  const auto is_long = [&](const TestRecord& record, const TorqueHold& hold) {
    constexpr double nearly = 0.9;
    return static_cast<double>(oscillating_samples(hold)) * record.sample_time >= nearly * oscillation;
  };
  CreepEstimate best{3.0 / longest, 2.0, 0.0};
  double explained = 0.0;
  for (int i = 0; i < rates && 0.2 / longest * std::pow(2.0, i) * oscillation <= 1.0; ++i) {
    for (const double exponent : exponents) {
      CreepEstimate tried{0.2 / longest * std::pow(2.0, i), exponent, 1.0};
      HoldSums sums;
      for (std::size_t r = 0; r < records.size(); ++r) {
        const Eigen::VectorXd law = creep_extension(records[r], tried, creep_torque);
        for (const TorqueHold& hold : records[r].parts.holds) {
          if (is_long(records[r], hold)) add_hold(hold, law, angles[r], sums);
        }
      }
      if (!(sums.xx > 0.0) || sums.xy <= 0.0 || sums.xy * sums.xy / sums.xx <= explained) continue;
      explained = sums.xy * sums.xy / sums.xx;
      tried.limit = sums.xy / sums.xx;
      best = tried;
    }
  }
  return best;
}

}  // namespace zerocount::fit
