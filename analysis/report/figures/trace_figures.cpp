#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/goal/goal_text.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/text/quantity.hpp"
#include "core/loop/encoder.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t buckets = 250;  ///< of a trial: several share the figure

/// The trials of the chosen point under one condition, [trial], with how badly they do.
using RankedTrials = std::vector<std::pair<goal::Badness, std::int64_t>>;

std::vector<RankedTrials> ranked_trials(const ReportedStudy& reported) {
  const study::TrialTurns turns = study::turns_of(reported.study);
  std::vector<RankedTrials> ranked(std::max<std::size_t>(reported.study.conditions.size(), 1));
  const layout::RowRange rows = rows_of(reported, reported.chosen.point);
  measures::visit_trials(
      reported.file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
        const std::int64_t index = row - rows.first;
        ranked[has_conditions(reported) ? static_cast<std::size_t>(turns.condition_of(index)) : 0]
            .emplace_back(badness_of(question_of(reported), moves), index);
      });
  return ranked;
}

/// "settles in the goal's band after 27.5 ms at first; 4 of 4 moves meet the goals".
std::string course_of(const goal::Question& question, std::span<const trial::MoveOutcome> moves) {
  const double time = settling_time(question, moves.first(1));
  const std::string_view settles = words_of(question).settles;
  return fmt::format("{}{}, {}",
                     std::isfinite(time) ? fmt::format("{} after {}", settles, text::quantity_text(time, "s"))
                                         : fmt::format("never {}", settles),
                     moves.size() == 1 ? "" : " at first", goal::ending_text(question, moves));
}

/// The first sample of each move, and the end of the last.
std::vector<std::int64_t> starts_of_moves(const trial::TrialParameters& parameters) {
  std::vector<std::int64_t> starts{0};
  for (std::size_t move = 0; move < trial::move_count(parameters); ++move)
    starts.push_back(starts.back() + trial::samples_of_move(parameters, move));
  return starts;
}

/// Errors of the samples, rad: of the position (trial::PositionError) where a goal has a tolerance, else of
/// the readings.
std::vector<double> errors_of(const ReplayedTrial& replayed, bool of_position) {
  const trial::TrialParameters& p = replayed.parameters;
  const double resolution = loop::fine_resolution(p.encoder);
  const bool at_load = motion::has_load(p.plant) && p.plant.load.encoder == motion::EncoderPlace::load;
  const std::vector<std::int64_t> starts = starts_of_moves(p);
  std::vector<double> errors;
  for (const trial::SampleRecord& sample : replayed.samples) {
    errors.push_back(static_cast<double>(sample.error) * resolution);
    if (!of_position || p.command.profile.shape == loop::ReferenceShape::sine) continue;
    const auto move =
        static_cast<std::size_t>(std::ranges::upper_bound(starts, sample.k) - starts.begin() - 1);
    const double target = p.command.exact_targets.empty() ? static_cast<double>(sample.target) * resolution
                                                          : p.command.exact_targets[move];
    errors.back() =
        target + (0.5 - p.initial.encoder_phase) * resolution - (at_load ? sample.load_theta : sample.theta);
  }
  return errors;
}

/// Half the width of what a goal asks for, rad; a band ends halfway to the next reading.
double half_width(const std::optional<study::Goal>& goal, double resolution) {
  if (goal && goal->tolerance) return *goal->tolerance;
  return (static_cast<double>(goal ? goal->band : 0) + 0.5) * resolution;
}

/// Goals as boxes, one for each move that they are about, from `within` to its end.
FigureData boxes_of(const goal::Question& question, const trial::TrialParameters& parameters) {
  FigureData data{"goals",
                  {{"goal", "goal", ""},
                   {"from", "from", "s"},
                   {"to", "to", "s"},
                   {"low", "from", "rad"},
                   {"high", "to", "rad"}}};
  const double resolution = loop::fine_resolution(parameters.encoder);
  const std::vector<std::int64_t> starts = starts_of_moves(parameters);
  for (const goal::JudgedPart& part : question.parts) {
    const std::vector<std::int64_t> on = part.claim ? part.claim->on : std::vector<std::int64_t>{};
    const double half = half_width(part.claim, resolution);
    for (std::size_t move = 0; move + 1 < starts.size(); ++move) {
      if (!on.empty() && std::ranges::find(on, static_cast<std::int64_t>(move)) == on.end()) continue;
      const double start = static_cast<double>(starts[move]) / parameters.controller.sample_rate;
      data.rows.push_back({part.claim ? part.claim->name : "",
                           datum(start + (part.claim ? part.claim->within : 0.0)),
                           datum(static_cast<double>(starts[move + 1]) / parameters.controller.sample_rate),
                           datum(-half), datum(half)});
    }
  }
  return data;
}

/// 0, and ± powers of ten well beyond `smallest` up to `largest`; of many decades evenly some.
ordered_json ticks_about_zero(double smallest, double largest) {
  constexpr int max_decades = 3;
  const int first = static_cast<int>(std::ceil(std::log10(4.0 * smallest)));
  const int last = static_cast<int>(std::floor(std::log10(largest)));
  const int stride = std::max(1, (last - first + max_decades) / max_decades);
  std::vector<double> ticks{0.0};
  for (int power = last; power >= first; power -= stride) {
    ticks.push_back(std::pow(10.0, power));
    ticks.push_back(-std::pow(10.0, power));
  }
  std::ranges::sort(ticks);
  ordered_json values = ordered_json::array();
  for (const double tick : ticks) values.push_back(datum(tick));
  return values;
}

/// Puts an error in one unit on an axis that is linear within `smallest` and logarithmic beyond.
void set_error_axis(ordered_json& channel, double smallest, double largest) {
  channel["scale"] = {
      {"type", "symlog"}, {"constant", datum(smallest)}, {"domain", {datum(-largest), datum(largest)}}};
  channel["axis"]["values"] = ticks_about_zero(smallest, largest);
}

}  // namespace

std::vector<SampleTrial> sample_trials(const ReportedStudy& reported) {
  std::vector<SampleTrial> trials;
  if (reported.study.open_loop) return trials;
  std::vector<RankedTrials> ranked = ranked_trials(reported);
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const std::string condition = has_conditions(reported) ? reported.study.conditions[i] : "";
    const auto median = ranked[i].begin() + (std::ssize(ranked[i]) - 1) / 2;
    std::ranges::nth_element(ranked[i], median);
    trials.push_back({.name = "median",
                      .point = reported.chosen.point,
                      .index = median->second,
                      .buckets = buckets,
                      .condition = condition});
    // Of several trials that do equally badly the first is shown.
    const auto worst = std::ranges::max_element(ranked[i], [](const auto& a, const auto& b) {
      return std::pair(a.first, -a.second) < std::pair(b.first, -b.second);
    });
    trials.push_back({.name = "worst",
                      .point = reported.chosen.point,
                      .index = worst->second,
                      .buckets = buckets,
                      .condition = condition});
  }
  return trials;
}

Figure response_figure(const ReportedStudy& reported, const std::vector<SampleTrial>& trials,
                       const std::vector<ReplayedTrial>& replayed) {
  const goal::Question& question = question_of(reported);
  const bool of_position = std::ranges::any_of(
      question.parts, [](const goal::JudgedPart& part) { return part.claim && part.claim->tolerance; });
  FigureData data{"samples",
                  {{"trial", "trial", ""},
                   {"condition", has_conditions(reported) ? "condition" : "", ""},
                   {"time", "time", "s"},
                   {"error", "error", "rad"},
                   {"counts", "error", "count"},
                   {"torque", "$torque", "N m"}}};
  std::string course;
  double largest = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const std::vector<double> errors = errors_of(replayed[i], of_position);
    const double resolution = loop::fine_resolution(replayed[i].parameters.encoder);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const trial::SampleRecord& sample = replayed[i].samples[k];
      largest = std::max(largest, std::abs(errors[k]));
      data.rows.push_back({trials[i].name, trials[i].condition, datum(sample.t, 9), datum(errors[k]),
                           datum(errors[k] / resolution), datum(sample.torque)});
    }
    course += fmt::format("{}{}{}: trial {}, {}", i == 0 ? " Shown are: " : "; ", trials[i].name,
                          trials[i].condition.empty() ? "" : ", " + trials[i].condition, trials[i].index,
                          course_of(question, replayed[i].result.outcome.moves));
  }
  const trial::TrialParameters& parameters = replayed.front().parameters;
  const double resolution = loop::fine_resolution(parameters.encoder);
  double smallest = INFINITY;
  for (const goal::JudgedPart& part : question.parts)
    smallest = std::min(smallest, half_width(part.claim, resolution));
  largest = std::max(1.2 * largest, 3.0 * smallest);
  const char* const subject = reported.study.rigs > 0 ? "machine" : "trial";
  Figure figure = figure_of(
      "response", "response", fmt::format("How do the median and the worst {} respond?", subject),
      fmt::format(
          "{} of two trials of point {}{}, simulated again, and the $torque of the worst. {} Its axis is "
          "linear within the narrowest goal and logarithmic beyond. Samples are thinned, but all extremes "
          "are shown.{}",
          of_position ? "Position error" : "Error of the readings", label_of(reported, reported.chosen.point),
          has_conditions(reported) ? ", under each condition" : "",
          question.claim() ? "The goal asks that the error stay in the shaded boxes."
                           : "The shaded box is zero counts.",
          course + "."),
      {std::move(data), boxes_of(question, parameters)});
  for (std::size_t panel : {0U, 1U}) {
    ordered_json& layers = figure.specification["vconcat"][panel]["layer"];
    set_error_axis(layers[0]["layer"][1]["encoding"]["y"], smallest, largest);
    set_error_axis(layers[1]["encoding"]["y"], smallest / resolution, largest / resolution);
    colour_conditions(layers[0]["layer"][1]["encoding"]["color"], reported);
    figure.specification["vconcat"][panel]["title"] =
        fmt::format("{} {}", panel == 0 ? "median" : "worst", subject);
  }
  colour_conditions(figure.specification["vconcat"][2]["encoding"]["color"], reported);
  return figure;
}

}  // namespace zerocount::report
