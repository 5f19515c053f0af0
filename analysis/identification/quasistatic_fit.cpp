#include "analysis/identification/quasistatic_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <oneapi/tbb/parallel_for.h>

#include "core/numerics/dense.hpp"

namespace zerocount::identification {
namespace {

/// Samples of a record that are compared.
constexpr std::size_t most_samples = 3000;

/// Change of a coordinate for a difference quotient.
constexpr double slope_step = 1e-5;

/// Softening travel (units of the readings) below which the readings cannot tell it.
constexpr double least_travel = 0.3;

/// Largest change of a coordinate in one step, and from its start.
constexpr double max_step = 1.0;
constexpr double max_change = 8.0;

/// The spring under a torque that changes slowly.
class SpringUnderTorque {
 public:
  explicit SpringUnderTorque(const friction::FrictionParameters& friction)
      : k1_(friction.k1), offset_(friction.k2 / friction.beta), beta_(friction.beta) {}

  void move_to(double torque) {
    if (torque == torque_) return;
    const double direction = torque > torque_ ? 1.0 : -1.0;
    if (direction == -direction_) turns_.push_back({torque_, elongation()});
    direction_ = direction;
    torque_ = torque;
    close_loops();
  }

  double elongation() const {
    if (turns_.empty()) return std::copysign(0.5 * travel(2.0 * std::abs(torque_)), torque_);
    return turns_.back().elongation + direction_ * travel(std::abs(torque_ - turns_.back().torque));
  }

 private:
  struct Turn {
    double torque;
    double elongation;
  };

  /// The inverse of the branch law, by Newton's method from below: the law is concave, so that its tangents
  /// lie above it.
  double travel(double torque) const {
    double at = std::max(torque / (k1_ + offset_ * beta_), (torque - offset_) / k1_);
    constexpr int max_steps = 50;
    constexpr double close = 1e-14;
    for (int i = 0; i < max_steps; ++i) {
      const double left = std::exp(-beta_ * at);
      const double missing = torque - k1_ * at - offset_ * (1.0 - left);
      const double change = missing / (k1_ + offset_ * beta_ * left);
      at += change;
      if (std::abs(change) <= close * at) break;
    }
    return at;
  }

  void close_loops() {
    while (turns_.size() >= 2 && direction_ * (torque_ - turns_[turns_.size() - 2].torque) >= 0.0) {
      turns_.resize(turns_.size() - 2);
    }
    if (turns_.size() == 1 && direction_ * torque_ >= std::abs(turns_[0].torque)) turns_.clear();
  }

  double k1_;
  double offset_;
  double beta_;
  double torque_{0.0};
  double direction_{0.0};
  std::vector<Turn> turns_;
};

/// Slow parts of a record: the torques that matter in the order of time, and the angles that answer some.
struct SlowParts {
  struct Point {
    double torque{0.0};     ///< N m
    std::size_t sample{0};  ///< of its answer
    bool read{false};       ///< otherwise only a turning point
  };
  std::vector<Point> points;
  std::size_t read{0};  ///< number of angles
};

/// The torque (N m) whose answer is the reading at sample k.
double torque_before(const TestRecord& record, std::size_t k) {
  return k == 0 ? 0.0 : record.torque[k - 1].now;
}

SlowParts slow_parts_of(const TestRecord& record) {
  std::vector<bool> slow(sample_count(record), false);
  const auto mark = [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k <= last; ++k) slow[k] = true;
  };
  for (const LoadingBranch& branch : record.parts.branches) {
    if (is_gradual(record, branch)) mark(branch.first + 1, branch.last);
  }
  for (const TorqueHold& hold : record.parts.holds) {
    if (hold.rings_down)
      std::fill(slow.begin() + static_cast<std::ptrdiff_t>(hold.first),
                slow.begin() + static_cast<std::ptrdiff_t>(hold.last) + 1, false);
    mark(hold.first + (hold.last - hold.first) / 2, hold.last);
  }
  const auto available = static_cast<std::size_t>(std::count(slow.begin(), slow.end(), true));
  const std::size_t every = std::max<std::size_t>(1, available / most_samples);
  SlowParts parts;
  std::size_t number = 0;
  for (std::size_t k = 1; k < sample_count(record); ++k) {
    const bool read = slow[k] && number++ % every == 0 && !is_excluded(record, k);
    const double torque = torque_before(record, k);
    const double before = torque - torque_before(record, k - 1);
    const double after = record.torque[k].now - torque;
    const bool turns = before * after < 0.0 || (before != 0.0 && after == 0.0);
    if (read || turns) parts.points.push_back({torque, k, read});
    if (read) ++parts.read;
  }
  return parts;
}

class SlowPartsFit {
 public:
  SlowPartsFit(std::span<const TestRecord> records, const ContactPoint& creep, double creep_torque)
      : records_(records), creep_torque_(creep_torque) {
    const CreepEstimate law{std::exp(creep[log_alpha]), creep[creep_exponent], std::exp(creep[log_limit])};
    for (const TestRecord& record : records) {
      parts_.push_back(slow_parts_of(record));
      angles_.push_back(measured_angle(record) - creep_extension(record, law, creep_torque));
      read_ += parts_.back().read;
      largest_rate_ = std::max(largest_rate_, -std::log(least_travel * record.unit));
    }
  }

  bool empty() const { return read_ == 0; }

  /// Levenberg–Marquardt over the free coordinates.
  SlowFit fit(ContactPoint point, const FreeCoordinates& free) const {
    const ContactPoint start = point;
    Eigen::VectorXd residuals = residuals_at(point);
    double squares = residuals.squaredNorm();
    double damping = 1e-3;
    constexpr int max_steps = 40;
    constexpr double max_damping = 1e8;
    constexpr double close = 1e-7;
    for (int step = 0; step < max_steps && damping < max_damping; ++step) {
      const Eigen::MatrixXd slopes = slopes_at(point, residuals, free);
      const Eigen::MatrixXd matrix = slopes.transpose() * slopes;
      const Eigen::VectorXd gradient = -slopes.transpose() * residuals;
      const double scale = matrix.diagonal().maxCoeff();
      bool better = false;
      while (!better && damping < max_damping) {
        Eigen::MatrixXd damped = matrix;
        damped.diagonal() += damping * matrix.diagonal();
        damped.diagonal().array() += 1e-12 * scale + std::numeric_limits<double>::min();
        const Eigen::VectorXd change =
            numerics::solve_positive_definite(damped, gradient).cwiseMin(max_step).cwiseMax(-max_step);
        ContactPoint tried = point;
        for (Eigen::Index i = 0, j = 0; j < contact_dimension; ++j) {
          if (free[static_cast<std::size_t>(j)]) tried[j] += change[i++];
        }
        Eigen::VectorXd left;
        if ((tried - start).cwiseAbs().maxCoeff() < max_change && tried[log_beta] < largest_rate_) {
          left = residuals_at(tried);
        }
        better = left.size() > 0 && left.allFinite() && left.squaredNorm() < squares;
        damping *= better ? 0.2 : 4.0;
        if (!better) continue;
        const double gain = 1.0 - left.squaredNorm() / squares;
        point = tried;
        residuals = left;
        squares = left.squaredNorm();
        if (gain < close) return {point, squares};
      }
    }
    return {point, squares};
  }

 private:
  /// (measured − modelled)/unit of all samples read, about the mean of each record.
  Eigen::VectorXd residuals_at(const ContactPoint& point) const {
    const friction::FrictionParameters friction = contact_at(point, creep_torque_).friction;
    Eigen::VectorXd residuals(static_cast<Eigen::Index>(read_));
    Eigen::Index filled = 0;
    for (std::size_t r = 0; r < records_.size(); ++r) {
      if (parts_[r].read == 0) continue;
      SpringUnderTorque spring(friction);
      for (const double torque : {records_[r].start.preload, 0.0}) spring.move_to(torque);
      for (const double torque : records_[r].start.history) spring.move_to(torque);
      if (!records_[r].start.history.empty()) spring.move_to(0.0);
      const Eigen::Index first = filled;
      for (const SlowParts::Point& at : parts_[r].points) {
        spring.move_to(at.torque);
        if (!at.read) continue;
        const auto k = static_cast<Eigen::Index>(at.sample);
        residuals[filled++] = (angles_[r][k] - spring.elongation()) / records_[r].unit;
      }
      residuals.segment(first, filled - first).array() -= residuals.segment(first, filled - first).mean();
    }
    return residuals;
  }

  Eigen::MatrixXd slopes_at(const ContactPoint& point, const Eigen::VectorXd& residuals,
                            const FreeCoordinates& free) const {
    Eigen::MatrixXd slopes(residuals.size(), std::count(free.begin(), free.end(), true));
    Eigen::Index column = 0;
    for (std::size_t j = 0; j < coordinate_count; ++j) {
      if (!free[j]) continue;
      ContactPoint moved = point;
      moved[j] += slope_step;
      slopes.col(column++) = (residuals_at(moved) - residuals) / (moved[j] - point[j]);
    }
    return slopes;
  }

  std::span<const TestRecord> records_;
  double creep_torque_;
  std::vector<SlowParts> parts_;
  std::vector<Eigen::VectorXd> angles_;  // [record] less the creep extension, rad
  std::size_t read_{0};
  double largest_rate_{-std::numeric_limits<double>::infinity()};  // of log_beta
};

}  // namespace

std::vector<double> spring_elongations(std::span<const double> torques,
                                       const friction::FrictionParameters& friction) {
  SpringUnderTorque spring(friction);
  std::vector<double> elongations;
  for (const double torque : torques) {
    spring.move_to(torque);
    elongations.push_back(spring.elongation());
  }
  return elongations;
}

SlowFit fit_slow_parts(std::span<const TestRecord> records, const ContactPoint& start, double creep_torque,
                       const FreeCoordinates& free) {
  const SlowPartsFit slow(records, start, creep_torque);
  FreeCoordinates spring{};
  for (const Coordinate coordinate : {log_k1, log_k2, log_beta}) spring[coordinate] = free[coordinate];
  if (!has_slow_branches(records) || slow.empty() ||
      std::none_of(spring.begin(), spring.end(), [](bool one) { return one; })) {
    return {start, std::numeric_limits<double>::infinity()};
  }
  constexpr std::array rates{1.0, 0.003, 0.01, 0.03, 0.1, 0.3, 3.0, 10.0, 30.0};
  std::array<SlowFit, rates.size()> found;
  oneapi::tbb::parallel_for(std::size_t{0}, rates.size(), [&](std::size_t i) {
    ContactPoint point = start;
    if (free[log_beta]) point[log_beta] += std::log(rates[i]);
    if (free[log_beta] && free[log_k2]) point[log_k2] += std::log(rates[i]);
    found[i] = slow.fit(point, spring);
  });
  return *std::min_element(found.begin(), found.end(), [](const SlowFit& one, const SlowFit& other) {
    return one.squares < other.squares;
  });
}

}  // namespace zerocount::identification
