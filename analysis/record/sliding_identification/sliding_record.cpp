#include "analysis/record/sliding_identification/sliding_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include <ceres/autodiff_cost_function.h>
#include <fmt/format.h>

#include "analysis/basis/statistics/quantile.hpp"
#include "analysis/record/fit/records/checked_record.hpp"
#include "analysis/record/sliding_identification/sliding_fit.hpp"
#include "core/friction/sliding/sliding.hpp"
#include "core/numerics/dense.hpp"

namespace zerocount::sliding_identification {

namespace {

constexpr std::size_t smoothing_samples = 5;
constexpr double min_steps_per_span = 3.0;
constexpr double min_window_steps = 50.0;
constexpr std::size_t min_stroke_samples = 20;

/// Smallest difference of two readings that is not 0: the step of the encoder, rad or m.
/// @param position [sample] readings
double min_step(const std::vector<double>& position) {
  double least = 0.0;
  double largest = 0.0;
  for (std::size_t k = 1; k < position.size(); ++k) {
    const double step = std::abs(position[k] - position[k - 1]);
    largest = std::max(largest, step);
    if (step > 0.0 && (least == 0.0 || step < least)) least = step;
  }
  constexpr double rounding = 1e-6;  // of written numbers: differences that small are none of an encoder
  return least > rounding * largest ? least : 0.0;
}

/// Standard deviation of the errors of the readings, if these are independent, rad or m. It comes from third
/// differences, which smooth motion hardly contributes to (the sum of their squared weights is 20); by the
/// median, which single jerks do not move.
double noise_of(const std::vector<double>& position) {
  std::vector<double> differences;
  for (std::size_t k = 3; k < position.size(); ++k) {
    differences.push_back(
        std::abs(position[k] - 3.0 * position[k - 1] + 3.0 * position[k - 2] - position[k - 3]));
  }
  constexpr double median_of_normal = 0.6745;
  return statistics::upper_median(std::move(differences)) / (median_of_normal * std::sqrt(20.0));
}

/// True if the axis stops within the samples around `k`, in which it moves by `moved` (rad or m): between
/// neighbours it moves by less than half of the mean velocity.
bool stops_at(const SlidingRecord& record, std::size_t k, double moved) {
  constexpr double visible = 10.0;  // steps: where there are fewer, readings that stay are none of a stop
  constexpr double slow = 0.1;      // of what it moves over ten samples, in two
  const double here = std::abs(record.position[k + 1] - record.position[k - 1]);
  return moved >= visible * record.resolution && here < slow * moved;
}

double travel_of(const SlidingRecord& record, const Window& part) {
  return std::abs(record.position[part.last] - record.position[part.first]);
}

/// [sample] Direction of the motion: −1 or 1; 0 where the axis rests, is too slow to tell, sticks, or the
/// reading is masked.
std::vector<int> directions_of(const SlidingRecord& record, const records::RawSeries& series) {
  std::vector<int> direction(record.position.size(), 0);
  const std::size_t h = record.smoothing;
  for (std::size_t k = h; k + h < record.position.size(); ++k) {
    const double moved = record.position[k + h] - record.position[k - h];
    if (std::abs(moved) < min_steps_per_span * record.resolution) continue;
    if (stops_at(record, k, std::abs(moved))) continue;
    if (!series.excluded.empty() && series.excluded[k]) continue;
    if (!series.sliding.empty() && !series.sliding[k]) continue;
    direction[k] = moved > 0.0 ? 1 : -1;
  }
  return direction;
}

/// The motions in one direction (runs of samples), each from a standstill or a reversal to the next.
std::vector<Window> runs_of(const std::vector<int>& direction) {
  std::vector<Window> runs;
  for (std::size_t from = 0, end = 0; from < direction.size(); from = end) {
    while (end < direction.size() && direction[end] == direction[from]) ++end;
    if (direction[from] != 0) runs.push_back({from, end - 1, 0, static_cast<double>(direction[from])});
  }
  return runs;
}

void find_strokes(SlidingRecord& record, const std::vector<Window>& runs) {
  for (const Window& run : runs) {
    Window stroke = run;
    stroke.first += record.smoothing;
    stroke.last -= std::min(stroke.last, record.smoothing);
    const auto slides = [&](std::size_t k) {
      return std::abs(record.position[k] - record.position[run.first]) > record.presliding_travel;
    };
    while (stroke.first < stroke.last && !slides(stroke.first)) ++stroke.first;
    stroke.stroke = record.strokes.size();
    if (stroke.first + min_stroke_samples <= stroke.last + 1 &&
        travel_of(record, stroke) >= min_window_steps * record.resolution)
      record.strokes.push_back(stroke);
  }
}

void set_velocities(SlidingRecord& record) {
  const std::size_t h = record.smoothing;
  record.velocity.assign(record.position.size(), 0.0);
  for (std::size_t k = h; k + h < record.position.size(); ++k) {
    record.velocity[k] =
        (record.position[k + h] - record.position[k - h]) / (record.time[k + h] - record.time[k - h]);
    record.max_velocity = std::max(record.max_velocity, std::abs(record.velocity[k]));
  }
}

}  // namespace

SlidingRecord sliding_record(const records::RawSeries& series, double pitch) {
  fit::TestRecord sampled;
  sampled.sample_time = fit::checked_sample_time(series);
  sampled.intervals = fit::uneven_intervals(series);
  fit::check_jumps(series);
  SlidingRecord record;
  record.name = series.name;
  record.axis = fit::axis_of(series);
  record.torque = fit::courses_of(series, sampled);
  record.smoothing = smoothing_samples;
  record.delay = series.delay;
  const double unit = series.count_size > 0.0 ? series.count_size : 1.0;
  record.origin = unit * series.angle.front();
  record.pitch = series.linear ? pitch : 2.0 * std::numbers::pi;
  double now = 0.0;
  for (std::size_t k = 0; k < series.time.size(); ++k) {
    record.time.push_back(now);
    now += fit::interval_after(sampled, k);
    record.position.push_back(unit * (series.angle[k] - series.angle.front()));
  }
  if (std::ranges::count(series.torque, series.torque.front()) == std::ssize(series.torque))
    fit::refuse(record.axis, series.name, "the torque or force is constant");
  record.resolution = std::max(min_step(record.position), 3.0 * noise_of(record.position));
  if (!(record.resolution > 0.0)) record.resolution = std::numeric_limits<double>::min();
  const auto [lowest, highest] = std::ranges::minmax_element(record.position);
  constexpr double visible = 0.02;  // of the pitch: below, a wave looks like a spring
  record.turns = record.pitch > 0.0 && *highest - *lowest >= visible * record.pitch;
  set_velocities(record);
  const std::vector<Window> runs = runs_of(directions_of(record, series));
  if (series.sliding.empty()) record.presliding_travel = presliding_travel(record, runs);
  for (const Window& run : runs) record.moved += travel_of(record, run);
  find_strokes(record, runs);
  if (record.strokes.empty()) {
    fit::refuse(
        record.axis, series.name,
        fmt::format("shows no sliding: nowhere does it move on by {:g} steps of its readings ({:.3g} {}) "
                    "in one direction; material tests within the pre-sliding range are identified "
                    "without --sliding",
                    min_window_steps, record.resolution, parameters::unit_on(record.axis, "rad")));
  }
  record.min_velocity = record.max_velocity;
  for (const Window& stroke : record.strokes) {
    for (std::size_t k = stroke.first; k <= stroke.last; ++k)
      record.min_velocity = std::min(record.min_velocity, std::abs(record.velocity[k]));
  }
  cut_windows(record, max_window_samples);
  return record;
}

double used_proportion(std::span<const SlidingRecord> records) {
  double used = 0.0;
  double moved = 0.0;
  for (const SlidingRecord& record : records) {
    moved += record.moved;
    for (const Window& stroke : record.strokes) used += travel_of(record, stroke);
  }
  return moved > 0.0 ? used / moved : 0.0;
}

void cut_windows(SlidingRecord& record, std::size_t samples) {
  record.windows.clear();
  record.window_samples = samples;
  for (const Window& stroke : record.strokes) {
    const std::size_t length = samples_of(stroke);
    const auto by_travel =
        static_cast<std::size_t>(travel_of(record, stroke) / (min_window_steps * record.resolution));
    const std::size_t parts = std::max<std::size_t>(1, std::min(length / samples, by_travel));
    for (std::size_t i = 0; i < parts; ++i) {
      record.windows.push_back({stroke.first + i * length / parts,
                                stroke.first + (i + 1) * length / parts - 1, stroke.stroke,
                                stroke.direction});
    }
  }
}

namespace {

double value_of(double number) {
  return number;
}

template <int N>
double value_of(const ceres::Jet<double, N>& number) {
  return number.a;
}

/// Simulates a sliding axis (inertia, damping, Coulomb and Stribeck friction). Number is double, or
/// ceres::Jet to carry derivatives.
template <class Number>
class SlidingAxis {
 public:
  SlidingAxis(const Number* point, const Number* start, double direction)
      : position_(start[0]), velocity_(start[1]), direction_(direction) {
    using std::abs, std::exp, std::sqrt;
    curve_ = {point[coulomb_level], point[stribeck_excess], exp(-2.0 * point[log_stribeck_velocity])};
    damping_ = point[viscous_damping];
    offset_ = point[offset_torque];
    per_inertia_ = exp(-point[log_inertia]);
    constexpr double steepest = 0.86;  // of 2·x·exp(−x²)
    friction_rate_ = value_of(
        per_inertia_ * (abs(damping_) + steepest * abs(curve_.excess) * sqrt(curve_.per_velocity_squared)));
  }

  const Number& position() const { return position_; }

  /// Advances the motion by `duration`, s.
  /// @param course drive torque during this time
  /// @param of_position position-dependent torques against the drive, at the beginning, in the middle and at
  /// the end. They are interpolated by a parabola, because a straight line would leave an error that looks
  /// like a second mass where cogging passes within a few samples.
  void advance(const motion::TorqueCourse& course, double duration,
               const std::array<Number, 3>& of_position) {
    const double rate = std::max(friction_rate_, motion::is_constant(course) ? 0.0 : course.rate);
    constexpr double max_steps = 200.0;  // no meaning beyond: the parameters are far off
    const double steps = std::clamp(std::ceil(20.0 * rate * duration), 1.0, max_steps);
    for (double i = 0.0; i < steps; i += 1.0) {
      const auto torque = [&](double at) -> Number {
        const double s = at / steps;
        return motion::course_after(course, at * duration / steps).now - offset_ -
               ((1.0 - s) * (1.0 - 2.0 * s) * of_position[0] + 4.0 * s * (1.0 - s) * of_position[1] +
                s * (2.0 * s - 1.0) * of_position[2]);
      };
      step(torque(i), torque(i + 0.5), torque(i + 1.0), duration / steps);
    }
  }

 private:
  Number acceleration(const Number& velocity, const Number& torque) const {
    return per_inertia_ * friction::sliding_torque<Number>(torque, damping_, curve_, direction_, velocity);
  }

  void step(const Number& first, const Number& middle, const Number& last, double time) {
    const Number a1 = acceleration(velocity_, first);
    const Number a2 = acceleration(velocity_ + 0.5 * time * a1, middle);
    const Number a3 = acceleration(velocity_ + 0.5 * time * a2, middle);
    const Number a4 = acceleration(velocity_ + time * a3, last);
    position_ += time * velocity_ + time * time / 6.0 * (a1 + a2 + a3);
    velocity_ += time / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
  }

  Number position_;
  Number velocity_;
  friction::StribeckCurveOf<Number> curve_;
  Number damping_;      ///< Viscous damping cs, N m s/rad or N s/m.
  Number offset_;       ///< Constant offset torque u0, N m or N.
  Number per_inertia_;  ///< Reciprocal inertia 1/J, 1/(kg m²), or reciprocal mass, 1/kg.
  double direction_;
  double friction_rate_;  ///< Largest rate at which the friction can change the velocity, 1/s.
};

template <std::size_t terms>
struct WindowResiduals {
  const SlidingRecord& record;
  const Window& window;

  template <class Number>
  bool operator()(const Number* point, const Number* start, Number* residuals) const {
    using std::isfinite;
    SlidingAxis<Number> axis(point, start, window.direction);
    const auto torque_of = [&](const PositionShape& shape) {
      Number torque(0.0);
      for (std::size_t j = 0; j < terms; ++j) torque += shape[j] * point[position_amplitudes + j];
      return torque;
    };
    const auto of_position = [&](const std::vector<PositionShape>& shapes, std::size_t k) {
      return terms == 0 ? Number(0.0) : torque_of(shapes[k]);
    };
    Number here = of_position(record.shape, window.first);
    for (std::size_t k = window.first; k <= window.last; ++k) {
      if (!isfinite(axis.position())) return false;
      *residuals++ = (axis.position() - record.position[k]) / record.resolution;
      if (k == window.last) break;
      const Number next = of_position(record.shape, k + 1);
      axis.advance(record.torque[k], record.time[k + 1] - record.time[k],
                   {here, of_position(record.shape_between, k), next});
      here = next;
    }
    return true;
  }
};

template <std::size_t terms>
std::unique_ptr<ceres::CostFunction> residuals_with(const SlidingRecord& record, const Window& window) {
  using Residuals = ceres::AutoDiffCostFunction<WindowResiduals<terms>, ceres::DYNAMIC,
                                                static_cast<int>(position_amplitudes + terms), 2>;
  return std::make_unique<Residuals>(new WindowResiduals<terms>{record, window},
                                     static_cast<int>(samples_of(window)));
}

}  // namespace

std::unique_ptr<ceres::CostFunction> window_residuals(const SlidingRecord& record, const Window& window) {
  if (record.waves == 0) return residuals_with<0>(record, window);
  return record.waves == 1 ? residuals_with<2>(record, window)
                           : residuals_with<position_terms>(record, window);
}

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
