#include "analysis/trials/theory/curves.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/theory/trial_loops.hpp"
#include "core/numerics/roots.hpp"
#include "core/theory/margins.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study_trial.hpp"
#include "experiments/study/trial_draws.hpp"

namespace zerocount::theory {
namespace {

using Complex = std::complex<double>;

constexpr double degrees = 180.0 / std::numbers::pi;

/// Value of the open loop L at one frequency: at z = exp(i·angle).
struct ResponseSample {
  double angle{0.0};
  Complex value{};
};

/// The change of phase from one value of L to the next, degrees, in (−180°, 180°].
double turn(const ResponseSample& from, const ResponseSample& to) {
  return std::arg(to.value / from.value) * degrees;
}

/// Whether L has a phase at the sample; false at an undamped pole or zero, where it is infinite or 0.
bool has_phase(const ResponseSample& sample) {
  return std::isfinite(std::abs(sample.value)) && sample.value != 0.0;
}

/// Whether the samples of L are so close that a straight line between them represents the curve.
bool are_near(const ResponseSample& a, const ResponseSample& b) {
  constexpr double small_turn = 5.0;    // degrees
  constexpr double small_ratio = 0.12;  // of ln|L|: 1 dB
  return std::abs(turn(a, b)) <= small_turn && std::abs(std::log(std::abs(b.value / a.value))) <= small_ratio;
}

/// Appends samples of L between `from` and `to`, then `to` itself, so dense that a straight line to the next
/// represents the curve.
void add_until(const OpenLoop& loop, const ResponseSample& from, const ResponseSample& to,
               std::vector<ResponseSample>& samples) {
  constexpr double smallest_step = 1e-9;  // of the angle; the phase of an undamped mode jumps
  if (!are_near(from, to) && to.angle - from.angle > smallest_step * to.angle) {
    const double middle = 0.5 * (from.angle + to.angle);
    const ResponseSample between{middle, loop.at_angle(middle)};
    if (has_phase(between)) {
      add_until(loop, from, between, samples);
      add_until(loop, between, to, samples);
      return;
    }
  }
  samples.push_back(to);
}

/// Dense samples of L from a millionth of half the sample rate up to half of it, including those at the
/// angles `also` (rad per sample).
std::vector<ResponseSample> dense_samples(const FrozenLoop& loop, const std::vector<double>& also) {
  std::vector<double> angles = search_angles(loop);
  angles.insert(angles.end(), also.begin(), also.end());
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  const OpenLoop open = open_loop(loop);
  std::vector<ResponseSample> samples;
  for (const double angle : angles) {
    const ResponseSample sample{angle, open.at_angle(angle)};
    if (!has_phase(sample)) continue;
    if (samples.empty()) {
      samples.push_back(sample);
    } else {
      add_until(open, ResponseSample(samples.back()), sample, samples);
    }
  }
  return samples;
}

/// The phase of L at each sample without jumps of 360°, degrees. It begins between −300° and 60°.
std::vector<double> unwrapped(const std::vector<ResponseSample>& samples) {
  constexpr double highest_start = 60.0;
  constexpr double half_turn = 179.0;
  std::vector<double> phases;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == 0) {
      const double start = std::arg(samples[0].value) * degrees;
      phases.push_back(start > highest_start ? start - 360.0 : start);
      continue;
    }
    double by = turn(samples[i - 1], samples[i]);
    if (std::abs(by) > half_turn && i >= 2) {
      const bool peak = std::abs(samples[i - 1].value) > std::abs(samples[i - 2].value);
      by = peak ? -std::abs(by) : std::abs(by);
    }
    phases.push_back(phases.back() + by);
  }
  return phases;
}

/// Distance of the Bode curve at the point `at` from the straight line between two of its points, in units of
/// about the smallest distance that is visible in the figure.
double distance_from_line(const BodePoint& from, const BodePoint& to, const BodePoint& at) {
  constexpr double visible_magnitude = 0.25;  // dB
  constexpr double visible_phase = 1.0;       // degrees
  const double part = std::log(at.frequency / from.frequency) / std::log(to.frequency / from.frequency);
  const double magnitude = from.magnitude + part * (to.magnitude - from.magnitude);
  const double phase = from.phase + part * (to.phase - from.phase);
  return std::max(std::abs(at.magnitude - magnitude) / visible_magnitude,
                  std::abs(at.phase - phase) / visible_phase);
}

/// Marks the points between `first` and `last` that a line within `tolerance` needs (Ramer 1972, Douglas and
/// Peucker 1973).
void mark_needed(const std::vector<BodePoint>& curve, std::size_t first, std::size_t last, double tolerance,
                 std::vector<bool>& needed) {
  double farthest = tolerance;
  std::size_t at = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double distance = distance_from_line(curve[first], curve[last], curve[i]);
    if (distance <= farthest) continue;
    farthest = distance;
    at = i;
  }
  if (at == first) return;
  needed[at] = true;
  mark_needed(curve, first, at, tolerance, needed);
  mark_needed(curve, at, last, tolerance, needed);
}

/// Reduces a Bode curve to at most max_bode_points of its points, including all points with `kept` true.
std::vector<BodePoint> thinned(const std::vector<BodePoint>& curve, const std::vector<bool>& kept) {
  std::vector<bool> needed;
  for (double tolerance = 0.2;; tolerance *= 1.5) {
    needed = kept;
    std::size_t first = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
      if (!kept[i]) continue;
      mark_needed(curve, first, i, tolerance, needed);
      first = i;
    }
    if (std::count(needed.begin(), needed.end(), true) <= std::ptrdiff_t{max_bode_points}) break;
  }
  std::vector<BodePoint> points;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (needed[i]) points.push_back(curve[i]);
  }
  return points;
}

constexpr std::int64_t max_trials = 200;
constexpr int curve_points = 64;
constexpr int search_steps = 48;
constexpr int halvings = 40;

struct Criterion {
  const char* name;
  double IntegralGainBounds::*bound;
  /// True: the curve of the trial that reaches the criterion at the lowest gain; false: at the highest.
  bool first;
};

constexpr Criterion criteria[] = {
    {"(6)", &IntegralGainBounds::stable_below, true},
    {"(6)", &IntegralGainBounds::stable_below, false},
    {"(7)", &IntegralGainBounds::unstable_above, true},
    {"(7)", &IntegralGainBounds::unstable_above, false},
};

/// The examined trials of a design point, with two parameters (x and y of a plane) that can be set to any
/// value.
class CriterionTrials {
 public:
  CriterionTrials(const study::Study& study, std::int64_t point, const CriterionPlane& plane)
      : units_(study.units) {
    const auto x = parameters::find_parameter(plane.x.parameter);
    const auto y = parameters::find_parameter(plane.y.parameter);
    if (!x || !y) return;
    set_x_ = parameters::parameter_table()[*x].set;
    set_y_ = parameters::parameter_table()[*y].set;
    if (!set_x_ || !set_y_) return;
    for (const std::int64_t index : statistics::spread_over(study.trials, max_trials)) {
      trial::TrialParameters parameters = study::study_trial_as_given(study, point, index).parameters;
      if (!predict(parameters).applies) continue;
      given_.push_back({parameters.encoder, parameters.controller});
      trials_.push_back(std::move(parameters));
    }
  }

  bool empty() const { return trials_.empty(); }

  /// Integral gain ki over the criterion's bound, as the maximum over the trials (criterion.first) or the
  /// minimum; 1 on the criterion's curve.
  /// @param x, y values of the plane's two parameters
  double gain_over_bound(const Criterion& criterion, double x, double y) {
    double extreme = criterion.first ? 0.0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      trial::TrialParameters& trial = trials_[i];
      trial.encoder = given_[i].encoder;
      trial.controller = given_[i].controller;
      set_x_(trial, x);
      set_y_(trial, y);
      study::complete_trial(units_, trial);
      const double ratio = trial.controller.ki / (predict(trial).bounds.*criterion.bound);
      extreme = criterion.first ? std::max(extreme, ratio) : std::min(extreme, ratio);
    }
    return extreme;
  }

 private:
  /// Parameter values of a trial as given, before the values that follow from others are computed.
  struct Given {
    loop::EncoderParameters encoder;
    loop::ControllerParameters controller;
  };

  parameters::StudyUnits units_;
  std::vector<trial::TrialParameters> trials_;
  /// [trial] Parameter values as given, from which the trial is completed again for each x and y.
  std::vector<Given> given_;
  std::function<void(trial::TrialParameters&, double)> set_x_;
  std::function<void(trial::TrialParameters&, double)> set_y_;
};

/// The lowest fraction in [0, 1] at which the function `excess` changes its sign; nothing if it does not.
std::optional<double> crossing(const std::function<double(double)>& excess) {
  double low = 0.0;
  double at_low = excess(low);
  for (int step = 1; step <= search_steps; ++step) {
    const double high = static_cast<double>(step) / search_steps;
    const double at_high = excess(high);
    if ((at_low < 0.0) != (at_high < 0.0)) {
      const auto is_before = [&](double at) { return (excess(at) < 0.0) == (at_low < 0.0); };
      const auto [before, after] =
          numerics::bisect({low, high}, is_before, numerics::after_halvings(halvings));
      return 0.5 * (before + after);
    }
    low = high;
    at_low = at_high;
  }
  return std::nullopt;
}

/// The points at which the gain equals the criterion's bound: searched along x for each of several y, or
/// along y for each of several x.
std::vector<CurvePoint> curve(CriterionTrials& trials, const Criterion& criterion,
                              const CriterionPlane& plane, bool along_x) {
  std::vector<CurvePoint> points;
  for (int i = 0; i < curve_points; ++i) {
    const double fixed = static_cast<double>(i) / (curve_points - 1);
    const auto place = [&](double fraction) {
      return CurvePoint{plane.x.at(along_x ? fraction : fixed), plane.y.at(along_x ? fixed : fraction)};
    };
    const std::optional<double> found = crossing([&](double fraction) {
      const CurvePoint at = place(fraction);
      return trials.gain_over_bound(criterion, at.x, at.y) - 1.0;
    });
    if (found) points.push_back(place(*found));
  }
  return points;
}

}  // namespace

std::vector<BodePoint> bode_curve(const FrozenLoop& loop, double lowest, const std::vector<double>& kept) {
  const double frequency_to_angle = 2.0 * std::numbers::pi * loop.sample_time;
  std::vector<double> kept_angles{lowest * frequency_to_angle};
  for (const double frequency : kept) kept_angles.push_back(frequency * frequency_to_angle);
  const std::vector<ResponseSample> samples = dense_samples(loop, kept_angles);
  const std::vector<double> phases = unwrapped(samples);
  std::vector<BodePoint> curve;
  std::vector<bool> is_kept;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].angle < kept_angles.front()) continue;
    curve.push_back(
        {samples[i].angle / frequency_to_angle, 20.0 * std::log10(std::abs(samples[i].value)), phases[i]});
    is_kept.push_back(std::find(kept_angles.begin(), kept_angles.end(), samples[i].angle) !=
                      kept_angles.end());
  }
  if (curve.empty()) return curve;
  is_kept.front() = is_kept.back() = true;
  return thinned(curve, is_kept);
}

std::vector<CriterionCurve> criterion_curves(const study::Study& study, std::int64_t point,
                                             const CriterionPlane& plane) {
  CriterionTrials trials(study, point, plane);
  std::vector<CriterionCurve> curves;
  if (trials.empty()) return curves;
  const bool along_x = plane.y.parameter != parameter::controller::ki;
  for (const Criterion& criterion : criteria) {
    std::vector<CurvePoint> points = curve(trials, criterion, plane, along_x);
    std::vector<CurvePoint> other = curve(trials, criterion, plane, !along_x);
    if (points.size() < 2) points = std::move(other);
    if (points.size() >= 2) curves.push_back({criterion.name, criterion.first, std::move(points)});
  }
  return curves;
}

}  // namespace zerocount::theory
