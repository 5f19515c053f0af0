#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>

#include <fmt/format.h>

#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/theory/curves.hpp"
#include "analysis/trials/theory/point_theory.hpp"
#include "analysis/trials/theory/theory_prediction.hpp"
#include "analysis/trials/theory/trial_loops.hpp"
#include "core/theory/margins.hpp"
#include "core/theory/stability.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t shown_trial = 0;

/// An open control loop of the trial, with its stability margins and its Bode curve.
struct LoopCurve {
  std::string label;
  theory::StabilityMargins margins;
  std::vector<theory::BodePoint> points;
};

std::vector<double> margin_frequencies(const theory::StabilityMargins& margins) {
  std::vector<double> frequencies;
  for (const theory::Margin& margin : {margins.gain, margins.phase}) {
    if (!std::isnan(margin.frequency)) frequencies.push_back(margin.frequency);
  }
  return frequencies;
}

double decibels(double factor) {
  return 20.0 * std::log10(factor);
}

/// A number with its unit as text: "16.2 dB", with a true minus sign as on the axes; "–" for NaN.
std::string value_with_unit(double value, const char* unit) {
  if (std::isnan(value)) return "–";
  return fmt::format("{}{:.3g}{}", value < 0.0 ? "−" : "", std::abs(value), unit);
}

const char* stability_label(theory::LoopStability stability) {
  switch (stability) {
    case theory::LoopStability::stable:
      return "";
    case theory::LoopStability::marginal:
      return ", marginal";
    case theory::LoopStability::unstable:
      break;
  }
  return ", unstable";
}

/// Label of a loop in the legend, with its margins: "at k1: 16.2 dB, 49.4°".
std::string label_of_loop(const theory::TrialLoop& loop, const theory::StabilityMargins& margins,
                          double hold) {
  return fmt::format("{}: {}, {}{}", loop.name,
                     margins.no_gain_stabilises ? "no gain stabilises it"
                                                : value_with_unit(decibels(margins.gain.value), " dB"),
                     value_with_unit(margins.phase.value, "°"),
                     stability_label(theory::stability_of(loop.loop, hold)));
}

/// The Bode curves of the loops. They begin a decade below the lowest crossover, or below the lowest natural
/// frequency of the inertia on a contact spring if that is lower. A loop without gain has no curve.
std::vector<LoopCurve> loop_curves(const trial::TrialParameters& parameters) {
  double corner = 0.5 * parameters.controller.sample_rate;
  const std::vector<theory::TrialLoop> loops = theory::trial_loops(parameters);
  const double hold = parameters.command.hold;
  std::vector<LoopCurve> curves;
  for (const theory::TrialLoop& loop : loops) {
    const theory::StabilityMargins margins = theory::stability_margins(loop.loop);
    curves.push_back({label_of_loop(loop, margins, hold), margins, {}});
    if (loop.stiffness > 0.0)
      corner = std::min(corner, theory::natural_frequency(loop.stiffness, parameters.plant));
    for (const double frequency : margin_frequencies(margins)) corner = std::min(corner, frequency);
  }
  for (std::size_t i = 0; i < loops.size(); ++i)
    curves[i].points = theory::bode_curve(loops[i].loop, 0.1 * corner, margin_frequencies(curves[i].margins));
  std::erase_if(curves, [](const LoopCurve& curve) { return curve.points.empty(); });
  return curves;
}

FigureData curve_data(const std::vector<LoopCurve>& curves) {
  FigureData data{"curves",
                  {{"label", "loop", ""},
                   {"frequency", "frequency", "Hz"},
                   {"magnitude", "magnitude", "dB"},
                   {"phase", "phase", "°"}}};
  for (const LoopCurve& curve : curves) {
    for (const theory::BodePoint& point : curve.points) {
      data.rows.push_back(ordered_json::array(
          {curve.label, datum(point.frequency, 9), datum(point.magnitude), datum(point.phase)}));
    }
  }
  return data;
}

const theory::BodePoint& point_at(const LoopCurve& curve, double frequency) {
  return *std::min_element(curve.points.begin(), curve.points.end(),
                           [&](const theory::BodePoint& a, const theory::BodePoint& b) {
                             return std::abs(a.frequency - frequency) < std::abs(b.frequency - frequency);
                           });
}

/// Dataset of the points on the Bode curves at which the stability margins are read. In the figure, a line
/// leads from each point to the level from which the margin counts: 0 dB (`unity`), or the phase at which L
/// is real and negative (`reversal`).
FigureData margin_data(const std::vector<LoopCurve>& curves) {
  FigureData data{"margins",
                  {{"label", "loop", ""},
                   {"margin", "margin", ""},
                   {"value", "value", ""},
                   {"frequency", "frequency", "Hz"},
                   {"magnitude", "magnitude", "dB"},
                   {"unity", "", "dB"},
                   {"phase", "phase", "°"},
                   {"reversal", "", "°"}}};
  const auto add = [&](const LoopCurve& curve, const char* name, const std::string& value,
                       double phase_margin, double frequency) {
    const theory::BodePoint& point = point_at(curve, frequency);
    data.rows.push_back(
        ordered_json::array({curve.label, name, value, datum(frequency, 9), datum(point.magnitude), 0,
                             datum(point.phase), datum(point.phase - phase_margin)}));
  };
  for (const LoopCurve& curve : curves) {
    const theory::Margin& gain = curve.margins.gain;
    const theory::Margin& phase = curve.margins.phase;
    if (!std::isnan(gain.value))
      add(curve, "gain margin", value_with_unit(decibels(gain.value), " dB"), 0.0, gain.frequency);
    if (!std::isnan(phase.value))
      add(curve, "phase margin", value_with_unit(phase.value, "°"), phase.value, phase.frequency);
  }
  return data;
}

/// Dataset of the phases at which the open loop L is real and negative: −180°, and within the range of the
/// curves the phases that differ from it by multiples of 360°.
FigureData reversal_levels(const theory::Range& phases) {
  FigureData data{"levels", {{"level", "", "°"}}};
  data.rows.push_back(ordered_json::array({-180}));
  for (double level = -180.0 - 360.0; level > phases.low; level -= 360.0)
    data.rows.push_back(ordered_json::array({datum(level)}));
  for (double level = 180.0; level < phases.high; level += 360.0)
    data.rows.push_back(ordered_json::array({datum(level)}));
  return data;
}

/// Range of the magnitudes that the Bode figure shows, dB. It is limited because a deep antiresonance or an
/// undamped resonance would flatten the rest.
theory::Range shown_magnitudes(const std::vector<LoopCurve>& curves) {
  constexpr double largest = 80.0;
  constexpr double step = 20.0;
  theory::Range all;
  all.add(0.0);
  for (const LoopCurve& curve : curves) {
    for (const theory::BodePoint& point : curve.points) all.add(point.magnitude);
  }
  return {step * std::floor(std::max(all.low, -largest) / step),
          step * std::ceil(std::min(all.high, largest) / step)};
}

/// The stiffnesses with which the friction contact holds the axis, for the caption: "at k1 of 110 N m/rad, …,
/// while sliding none".
std::string springs_text(const trial::TrialParameters& parameters, std::string_view unit) {
  std::string text;
  for (const theory::TrialLoop& loop : theory::trial_loops(parameters)) {
    const std::string spring =
        loop.stiffness > 0.0 ? fmt::format("of {:.4g} {}", loop.stiffness, unit) : "none";
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", loop.name, spring);
  }
  return text;
}

std::string bode_caption(const ReportedStudy& reported, const trial::TrialParameters& parameters,
                         const theory::Range& magnitudes) {
  const std::string unit = parameters::unit_on(reported.study.units.axis, "N m/rad");
  return fmt::format(
      "Frequency response of the open loop L(z) = C(z)·z^(−d)·G(z), z = exp(iωT), from error to count, of "
      "trial {} of point {}, up to half of the sample rate of {:.4g} Hz. C is the controller with all its "
      "blocks away from their limits, d its delay of {} sample{}, and G the driven plant behind the "
      "zero-order hold. Friction is frozen, a damper with a spring: {}. Triangles mark the gain margin, the "
      "distance "
      "from 0 dB where the phase "
      "is −180°; circles mark the phase margin, the distance from −180° at 0 dB. Of several crossovers the "
      "one nearest to instability counts, as in zerocount check; – stands for none. Magnitudes are shown "
      "from {} to {} dB. Definitions: Franklin, Powell, Workman, Digital Control of Dynamic Systems, 3rd "
      "ed., 1998, section 7.4.",
      shown_trial, label_of(reported, reported.chosen.point), parameters.controller.sample_rate,
      parameters.controller.delay, parameters.controller.delay == 1 ? "" : "s",
      springs_text(parameters, unit), value_with_unit(magnitudes.low, ""),
      value_with_unit(magnitudes.high, ""));
}

}  // namespace

std::optional<Figure> bode_figure(const ReportedStudy& reported) {
  const trial::TrialParameters parameters =
      study::study_trial(reported.study, reported.chosen.point, shown_trial).parameters;
  const std::vector<LoopCurve> curves = loop_curves(parameters);
  if (curves.empty()) return std::nullopt;
  theory::Range frequencies, phases;
  phases.add(-180.0);
  for (const LoopCurve& curve : curves) {
    frequencies.add(curve.points.front().frequency);
    frequencies.add(curve.points.back().frequency);
    for (const theory::BodePoint& point : curve.points) phases.add(point.phase);
  }
  const theory::Range magnitudes = shown_magnitudes(curves);
  Figure figure = figure_of("bode", "bode", "How much margin do the loops have?",
                            bode_caption(reported, parameters, magnitudes),
                            {curve_data(curves), margin_data(curves), reversal_levels(phases)});
  figure.parameters["frequencies"] = {datum(frequencies.low), datum(frequencies.high)};
  figure.parameters["magnitudes"] = {magnitudes.low, magnitudes.high};
  return figure;
}

}  // namespace zerocount::report
