#include "tests/support/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

namespace zerocount::testing {

void Agreement::add(const Agreement& other) {
  samples += other.samples;
  before_breakaway = std::max(before_breakaway, other.before_breakaway);
  after_breakaway = std::max(after_breakaway, other.after_breakaway);
  after_breakaway_ratio = std::max(after_breakaway_ratio, other.after_breakaway_ratio);
  depth_differences += other.depth_differences;
  slide_samples += other.slide_samples;
  edge_trials += other.edge_trials;
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
}

std::string Agreement::figures() const {
  return fmt::format(
      "{} samples, {} sliding; theta within {:.1e} count before breakaway, {:.1e} count ({:.1e} of the "
      "bound) after; "
      "{} on an edge, {} different depths, {} failures",
      samples, slide_samples, before_breakaway, after_breakaway, after_breakaway_ratio, edge_trials,
      depth_differences, failures.size());
}

Agreement compare(const trial::TrialParameters& parameters, const std::vector<trial::SampleRecord>& trial,
                  const std::vector<trial::SampleRecord>& judge, const std::string& name) {
  Agreement agreement;
  if (trial.size() != judge.size()) {
    agreement.failures.push_back(fmt::format("{}: {} samples against {}", name, trial.size(), judge.size()));
  }
  const double fine = 2.0 * std::numbers::pi / parameters.encoder.fine;
  const double coarse = 2.0 * std::numbers::pi / parameters.encoder.coarse;
  const auto edge_distance = [&](double theta, double resolution) {
    const double position = theta / resolution + parameters.initial.encoder_phase;
    return std::abs(position - std::round(position)) * resolution;
  };
  bool slid = false;
  double travel = 0.0;
  for (std::size_t i = 0; i < std::min(trial.size(), judge.size()); ++i) {
    const trial::SampleRecord& a = trial[i];
    const trial::SampleRecord& b = judge[i];
    if (i > 0) travel += std::abs(b.theta - judge[i - 1].theta);
    // A slide may begin and end between two samples; a contact that is new has lost its hardening.
    slid = slid || b.mode == trial::HookMode::slide || (i > 0 && b.xh < judge[i - 1].xh);
    const double allowed = slid ? 1e-3 * fine + 1e-7 * travel : 1e-6 * fine;
    const double difference = std::abs(a.theta - b.theta);
    if (!(difference <= allowed)) {
      agreement.failures.push_back(
          fmt::format("{}: sample {}: theta {:.17g} against {:.17g}, {:.3g} count apart", name, i, a.theta,
                      b.theta, difference / fine));
      return agreement;
    }
    const bool same_counts = a.count == b.count && a.coarse_count == b.coarse_count;
    const double resolution = a.count == b.count ? coarse : fine;
    if (!same_counts && std::abs(a.count - b.count) <= 1 && std::abs(a.coarse_count - b.coarse_count) <= 1 &&
        edge_distance(b.theta, resolution) <= allowed) {
      agreement.edge_trials += 1;
      return agreement;
    }
    if (!same_counts || a.code != b.code || a.error != b.error || a.target != b.target || a.mode != b.mode ||
        a.k != b.k || a.torque != b.torque || std::abs(a.t - b.t) > 1e-12 * b.t) {
      agreement.failures.push_back(
          fmt::format("{}: sample {}: count {} against {}, coarse {} against {}, code {} against {}, slides "
                      "{} against {}",
                      name, i, a.count, b.count, a.coarse_count, b.coarse_count, a.code, b.code,
                      a.mode == trial::HookMode::slide, b.mode == trial::HookMode::slide));
      return agreement;
    }
    if (std::abs(a.drive_torque - b.drive_torque) > 1e-13) {  // which is false where the judge does not say
      agreement.failures.push_back(fmt::format("{}: sample {}: motor torque {:.17g} against {:.17g}", name, i,
                                               a.drive_torque, b.drive_torque));
      return agreement;
    }
    const double creep_difference = std::max(std::abs(a.xp - b.xp), std::abs(a.xh - b.xh));
    if (creep_difference > allowed) {
      agreement.failures.push_back(
          fmt::format("{}: sample {}: xp {:.17g} against {:.17g}, xh {:.17g} against {:.17g}", name, i, a.xp,
                      b.xp, a.xh, b.xh));
      return agreement;
    }
    agreement.samples += 1;
    agreement.slide_samples += b.mode == trial::HookMode::slide;
    agreement.depth_differences += a.depth != b.depth;
    double& worst = slid ? agreement.after_breakaway : agreement.before_breakaway;
    worst = std::max(worst, difference / fine);
    if (slid)
      agreement.after_breakaway_ratio = std::max(agreement.after_breakaway_ratio, difference / allowed);
  }
  return agreement;
}

}  // namespace zerocount::testing
