#include "analysis/theory/criterion_curves.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>

#include "analysis/statistics/spread_over.hpp"
#include "analysis/theory/theory_prediction.hpp"
#include "core/numerics/bisection.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::theory {
namespace {

constexpr std::int64_t max_trials = 200;
constexpr int curve_points = 64;
constexpr int search_steps = 48;
constexpr int halvings = 40;

struct Criterion {
  const char* name;
  double IntegralGainBounds::*bound;
  bool first;  ///< the trial that reaches the criterion at the lowest gain; otherwise at the highest
};

constexpr Criterion criteria[] = {
    {"(6)", &IntegralGainBounds::stable_below, true},
    {"(6)", &IntegralGainBounds::stable_below, false},
    {"(7)", &IntegralGainBounds::unstable_above, true},
    {"(7)", &IntegralGainBounds::unstable_above, false},
};

/// The examined trials, with two variable parameters.
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

  /// Maximum (first) or minimum (last) of ki/bound over the trials; 1 on the curve.
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
  /// Values of a trial before its completion.
  struct Given {
    loop::EncoderParameters encoder;
    loop::ControllerParameters controller;
  };

  parameters::StudyUnits units_;
  std::vector<trial::TrialParameters> trials_;
  std::vector<Given> given_;  ///< [trial]
  std::function<void(trial::TrialParameters&, double)> set_x_;
  std::function<void(trial::TrialParameters&, double)> set_y_;
};

/// The lowest fraction in [0, 1] at which `excess` changes its sign, if any.
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

/// The points of a curve, searched along x for each y, or along y for each x.
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

std::vector<CriterionCurve> criterion_curves(const study::Study& study, std::int64_t point,
                                             const CriterionPlane& plane) {
  CriterionTrials trials(study, point, plane);
  std::vector<CriterionCurve> curves;
  if (trials.empty()) return curves;
  const bool along_x = plane.y.parameter != "controller.ki";
  for (const Criterion& criterion : criteria) {
    std::vector<CurvePoint> points = curve(trials, criterion, plane, along_x);
    std::vector<CurvePoint> other = curve(trials, criterion, plane, !along_x);
    if (points.size() < 2) points = std::move(other);
    if (points.size() >= 2) curves.push_back({criterion.name, criterion.first, std::move(points)});
  }
  return curves;
}

}  // namespace zerocount::theory
