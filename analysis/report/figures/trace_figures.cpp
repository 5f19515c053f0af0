#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "core/loop/encoder.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

/// Number of groups into which the samples of a trial are thinned for drawing. It is smaller than usual
/// because several trials share the figure.
constexpr std::int64_t buckets = 250;

/// Indices of trials at the chosen design point in one setting, each with the badness by which it is ranked.
using RankedTrials = std::vector<std::pair<goal::Badness, std::int64_t>>;

std::vector<RankedTrials> ranked_trials(const ReportedStudy& reported) {
  const study::TrialIndices indices = study::trial_indices(reported.study);
  std::vector<RankedTrials> ranked(static_cast<std::size_t>(reported.study.settings.total()));
  const layout::RowRange rows = rows_of(reported, reported.chosen.point);
  measures::visit_trials(reported.file, rows,
                         [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
                           const std::int64_t index = row - rows.first;
                           ranked[static_cast<std::size_t>(indices.setting_of(index))].emplace_back(
                               badness_of(question_of(reported), moves), index);
                         });
  return ranked;
}

/// Course of a trial as text, for a caption: "settles in the goal's band after 27.5 ms at first; 4 of 4 moves
/// meet the goals".
std::string course_of(const goal::Question& question, std::span<const trial::MoveOutcome> moves) {
  const double time = settling_time(question, moves.first(1));
  const std::string_view settles = question.goal() ? "settles in the goal's band" : "arrives";
  return fmt::format("{}{}, {}",
                     std::isfinite(time) ? fmt::format("{} after {}", settles, text::quantity_text(time, "s"))
                                         : fmt::format("never {}", settles),
                     moves.size() == 1 ? "" : " at first", goal::ending_text(question, moves));
}

/// Indices of the first sample of each move, and then one past the last sample of the last move.
std::vector<std::int64_t> starts_of_moves(const trial::TrialParameters& parameters) {
  std::vector<std::int64_t> starts{0};
  for (std::size_t move = 0; move < trial::move_count(parameters); ++move)
    starts.push_back(starts.back() + trial::samples_of_move(parameters, move));
  return starts;
}

/// A mass (motor or load) whose position error over time is shown.
struct ShownMass {
  /// Mass; nothing: the mass whose encoder closes the loop.
  std::optional<motion::EncoderPlace> mass{};
  /// True to show the position error (trial::PositionError), not the error of the readings.
  bool of_position{false};
  std::vector<goal::JudgedCriterion> parts{};  ///< Parts of the goals that judge this mass.
};

/// The masses (motor, load) whose response is shown: the mass that the first goal judges, and the other mass
/// if a goal or an encoder refers to it.
std::vector<ShownMass> shown_masses(const goal::Question& question, const trial::TrialParameters& p) {
  using enum motion::EncoderPlace;
  const auto mass_of = [](const goal::JudgedCriterion& part) {
    return part.goal ? part.goal->of : std::optional<motion::EncoderPlace>();
  };
  std::vector<ShownMass> shown{{.mass = mass_of(question.parts.front())}};
  const motion::EncoderPlace closing = motion::has_load(p.plant) ? p.plant.load.encoder : motor;
  const motion::EncoderPlace first = shown.front().mass.value_or(closing);
  const bool of_either = question.goal() && question.goal()->of_either;
  ShownMass other{.mass = first == motor ? load : motor};
  other.of_position = other.mass != closing;  // which no reading is of
  for (const goal::JudgedCriterion& part : question.parts) {
    const bool of_other = !of_either && mass_of(part).value_or(first) != first;
    (of_other ? other : shown.front()).parts.push_back(part);
    if (part.goal && part.goal->beside_load && other.mass == load) other.parts.push_back(part);
    (of_other ? other : shown.front()).of_position |= part.goal && part.goal->tolerance;
  }
  if (!other.parts.empty() || (!of_either && motion::has_load(p.plant) && p.encoder.other.counts > 0.0))
    shown.push_back(std::move(other));
  return shown;
}

/// Position errors of a repeated trial, rad or m: one for each sample.
std::vector<double> errors_of(const ReplayedTrial& replayed, const ShownMass& shown) {
  const trial::TrialParameters& p = replayed.parameters;
  const double resolution = loop::fine_resolution(p.encoder);
  const bool at_load =
      motion::has_load(p.plant) && shown.mass.value_or(p.plant.load.encoder) == motion::EncoderPlace::load;
  const std::vector<std::int64_t> starts = starts_of_moves(p);
  std::vector<double> errors;
  for (const trial::SampleRecord& sample : replayed.samples) {
    errors.push_back(static_cast<double>(sample.error) * resolution);
    if (!shown.of_position || loop::moves_for_ever(p.command.profile.shape)) continue;
    const auto move =
        static_cast<std::size_t>(std::ranges::upper_bound(starts, sample.k) - starts.begin() - 1);
    const double target = p.command.exact_targets.empty() ? static_cast<double>(sample.target) * resolution
                                                          : p.command.exact_targets[move];
    errors.back() =
        target + (0.5 - p.initial.encoder_phase) * resolution - (at_load ? sample.load_theta : sample.theta);
  }
  return errors;
}

/// Half the width of the error band or tolerance of a goal, rad or m. A band in counts ends halfway to the
/// next reading.
/// @param resolution size of an encoder count
double half_width(const std::optional<study::Goal>& goal, double resolution) {
  if (goal && goal->tolerance) return *goal->tolerance;
  return (static_cast<double>(goal ? goal->band : 0) + 0.5) * resolution;
}

/// Dataset of boxes that show the goals over time: one for each move that a goal judges, from the allowed
/// time to the end of the move.
FigureData boxes_of(const std::vector<goal::JudgedCriterion>& parts, const ReplayedTrial& replayed) {
  const trial::TrialParameters& parameters = replayed.parameters;
  FigureData data{"goals",
                  {{"goal", "goal", ""},
                   {"from", "from", "s"},
                   {"to", "to", "s"},
                   {"low", "from", "rad"},
                   {"high", "to", "rad"}}};
  const double resolution = loop::fine_resolution(parameters.encoder);
  const std::vector<std::int64_t> starts = starts_of_moves(parameters);
  for (const goal::JudgedCriterion& part : parts) {
    const std::vector<std::int64_t> on = part.goal ? part.goal->on : std::vector<std::int64_t>{};
    const double half = half_width(part.goal, resolution);
    for (std::size_t move = 0; move + 1 < starts.size(); ++move) {
      if (!on.empty() && std::ranges::find(on, static_cast<std::int64_t>(move)) == on.end()) continue;
      const double start = static_cast<double>(starts[move]) / parameters.controller.sample_rate;
      data.rows.push_back(
          {part.goal ? part.goal->name : "",
           datum(start + measures::allowed_time(part.criterion, replayed.result.outcome.moves[move])),
           datum(static_cast<double>(starts[move + 1]) / parameters.controller.sample_rate), datum(-half),
           datum(half)});
    }
  }
  return data;
}

/// Vega-Lite scale for errors of one unit that is linear between −`smallest` and `smallest`, and logarithmic
/// beyond.
ordered_json error_scale(double smallest, double largest) {
  return {{"type", "symlog"}, {"constant", datum(smallest)}, {"domain", {datum(-largest), datum(largest)}}};
}

}  // namespace

std::vector<SampleTrial> sample_trials(const ReportedStudy& reported) {
  std::vector<SampleTrial> trials;
  if (reported.study.open_loop) return trials;
  std::vector<RankedTrials> ranked = ranked_trials(reported);
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const std::string setting = study::label_of(reported.study.settings, static_cast<std::int64_t>(i));
    const auto median = ranked[i].begin() + (std::ssize(ranked[i]) - 1) / 2;
    std::ranges::nth_element(ranked[i], median);
    trials.push_back({.name = "median",
                      .point = reported.chosen.point,
                      .index = median->second,
                      .buckets = buckets,
                      .setting = setting});
    // Of several trials that do equally badly the first is shown.
    const auto worst = std::ranges::max_element(ranked[i], [](const auto& a, const auto& b) {
      return std::pair(a.first, -a.second) < std::pair(b.first, -b.second);
    });
    trials.push_back({.name = "worst",
                      .point = reported.chosen.point,
                      .index = worst->second,
                      .buckets = buckets,
                      .setting = setting});
  }
  return trials;
}

namespace {

/// Courses of all shown trials as text, for the caption: "trial 12, settles in the goal's band after 27.5
/// ms".
std::string courses_of(const goal::Question& question, const std::vector<SampleTrial>& trials,
                       const std::vector<ReplayedTrial>& replayed) {
  std::string courses;
  for (std::size_t i = 0; i < trials.size(); ++i)
    courses += fmt::format("{}{}{}: trial {}, {}", i == 0 ? " Shown are: " : "; ", trials[i].name,
                           trials[i].setting.empty() ? "" : ", " + trials[i].setting, trials[i].index,
                           course_of(question, replayed[i].result.outcome.moves));
  return courses + ".";
}

/// Figure of the position error of one mass (motor or load) over time, in the sample trials.
/// @param one_of_two whether figures of both masses are shown, so that the title must name the mass
Figure response_figure(const ReportedStudy& reported, const std::vector<SampleTrial>& trials,
                       const std::vector<ReplayedTrial>& replayed, const ShownMass& shown, bool one_of_two) {
  const goal::Question& question = question_of(reported);
  FigureData data{"samples",
                  {{"trial", "trial", ""},
                   {"condition", has_settings(reported) ? "condition" : "", ""},
                   {"time", "time", "s"},
                   {"error", "error", "rad"},
                   {"counts", "error", "count"},
                   {"torque", "$torque", "N m"}}};
  double largest = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const std::vector<double> errors = errors_of(replayed[i], shown);
    const double resolution = loop::fine_resolution(replayed[i].parameters.encoder);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const trial::SampleRecord& sample = replayed[i].samples[k];
      largest = std::max(largest, std::abs(errors[k]));
      data.rows.push_back({trials[i].name, trials[i].setting, datum(sample.t, 9), datum(errors[k]),
                           datum(errors[k] / resolution), datum(sample.torque)});
    }
  }
  const trial::TrialParameters& parameters = replayed.front().parameters;
  const double resolution = loop::fine_resolution(parameters.encoder);
  double smallest = INFINITY;
  for (const goal::JudgedCriterion& part : shown.parts)
    smallest = std::min(smallest, half_width(part.goal, resolution));
  if (shown.parts.empty()) smallest = half_width(std::nullopt, resolution);
  largest = std::max(1.2 * largest, 3.0 * smallest);
  const char* const subject = reported.study.machines > 0 ? "machine" : "trial";
  const motion::EncoderPlace mass = shown.mass.value_or(parameters.plant.load.encoder);
  const std::string of_mass = one_of_two ? fmt::format(" of the {}", study::mass_text(mass)) : "";
  const bool is_beside =
      one_of_two && !shown.parts.empty() && std::ranges::all_of(shown.parts, [&](const auto& part) {
        return part.goal && part.goal->beside_load && part.goal->of != shown.mass;
      });
  const std::string boxes = shown.parts.empty() ? "No goal applies to this mass."
                            : is_beside         ? "The shaded boxes are what the goal asks of the motor."
                            : question.goal()   ? "The goal asks that the error stay in the shaded boxes."
                                                : "The shaded box is zero counts.";
  Figure figure = figure_of(
      "response", "response",
      one_of_two ? fmt::format("How does the {} respond in the median and the worst {}?",
                               study::mass_text(mass), subject)
                 : fmt::format("How do the median and the worst {} respond?", subject),
      fmt::format(
          "{}{} of two trials of point {}{}, simulated again, and the $torque of the worst. {} Its axis is "
          "linear within {} and logarithmic beyond. Samples are thinned, but all extremes "
          "are shown.{}",
          shown.of_position ? "Position error" : "Error of the readings", of_mass,
          label_of(reported, reported.chosen.point), has_settings(reported) ? ", under each condition" : "",
          boxes, shown.parts.empty() ? "half a count" : "the narrowest goal",
          courses_of(question, trials, replayed)),
      {std::move(data), boxes_of(shown.parts, replayed.front())});
  for (const SampleTrial& trial : trials)
    figure.parameters["titles"][trial.name] = fmt::format("{} {}", trial.name, subject);
  figure.parameters["error_scale"] = error_scale(smallest, largest);
  figure.parameters["count_scale"] = error_scale(smallest / resolution, largest / resolution);
  return figure;
}

}  // namespace

std::vector<Figure> response_figures(const ReportedStudy& reported, const Replay& replay) {
  const std::vector<SampleTrial> trials = sample_trials(reported);
  if (trials.empty()) return {};
  std::vector<ReplayedTrial> replayed(trials.size());
  std::ranges::transform(trials, replayed.begin(), replay);
  const std::vector<ShownMass> shown = shown_masses(question_of(reported), replayed.front().parameters);
  std::vector<Figure> figures;
  for (const ShownMass& one : shown) {
    figures.push_back(response_figure(reported, trials, replayed, one, shown.size() > 1));
    if (&one != &shown.front()) figures.back().name += fmt::format("-{}", study::mass_text(*one.mass));
  }
  return figures;
}

namespace {

constexpr const char* targets_axis = "command.targets.0";

/// Whether the study can reproduce Fig. 7 of the paper. It needs design points with one move each that differ
/// only in the target.
bool shows_targets(const ReportedStudy& reported) {
  const std::vector<study::SweepAxis>& axes = reported.summary.axes;
  return axes.size() == 1 && axes[0].name == targets_axis && reported.file.moves() == 1 &&
         !numeric_axes(reported, 3).empty() && axes[0].numbers.size() <= 30;
}

/// Whether the study can reproduce Fig. 8 of the paper. It needs one design point with one move, and jerks in
/// most trials.
bool shows_jerks(const ReportedStudy& reported) {
  const measures::PointSummary& point = reported.summary.points.front();
  return reported.summary.points.size() == 1 && reported.file.moves() == 1 &&
         point.of(&trial::MoveOutcome::jerk_count).median.value >= 1.0;
}

SampleTrial first_trial(std::int64_t point) {
  return {.name = "first", .point = point};
}

/// The trial with the median number of jerks (excursions of the position error from 0 after arrival).
SampleTrial typical_trial(const ReportedStudy& reported) {
  SampleTrial typical = first_trial(0);
  bool found = false;
  measures::visit_trials(
      reported.file, rows_of(reported, 0), [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
        const auto jerks = static_cast<double>(moves.front().jerk_count);
        if (found ||
            jerks != reported.summary.points.front().of(&trial::MoveOutcome::jerk_count).median.value)
          return;
        found = true;
        typical.index = row;
      });
  return typical;
}

using SampleColumn = ColumnOf<trial::SampleRecord>;
using Sample = const trial::SampleRecord&;
const SampleColumn time_column{{"time", "time", "s"}, [](Sample s) { return datum(s.t); }};
const SampleColumn target_column{{"target", "target", "count"}, [](Sample s) { return s.target; }};
const SampleColumn count_column{{"count", "position", "count"}, [](Sample s) { return s.count; }};
const SampleColumn torque_column{{"torque", "$torque", "N m"}, [](Sample s) { return datum(s.torque); }};
const SampleColumn motor_torque_column{{"torque", "$torque", "N m"},
                                       [](Sample s) { return datum(s.drive_torque); }};

Figure step_responses(const std::vector<ReplayedTrial>& replayed) {
  std::vector<trial::SampleRecord> samples;
  for (const ReplayedTrial& trial : replayed)
    samples.insert(samples.end(), trial.samples.begin(), trial.samples.end());
  return figure_of(
      "step-responses", "paper-fig7", "Moves to different targets (Fig. 7 of the paper)",
      "Position over time, one trial for each target, from rest. In the paper all ten moves settle at their "
      "target within 300 samples of 0.5 ms. Every curve should end as a horizontal line at its target.",
      {data_of("samples", samples, {target_column, time_column, count_column})});
}

Figure jerks_in_time(const ReplayedTrial& trial) {
  return figure_of(
      "jerks-in-time", "paper-fig8", "Jerks by creep (Fig. 8 of the paper)",
      fmt::format(
          "Position and $torque over time of trial {}, which has the median number of jerks. After the move "
          "the position repeatedly leaves the target by one count, always in the direction of the holding "
          "$torque, and returns at once. The rate of these jerks decreases as the contact hardens.",
          trial.result.row),
      {data_of("samples", trial.samples, {time_column, count_column, torque_column})});
}

/// A position (of rotor or contact) over which the torque of an open-loop trial is drawn, as a member of the
/// samples and of the levels' results.
struct LoadedPlace {
  const char* field;
  const char* title;
  double trial::SampleRecord::*of_sample;
  double trial::MoveOutcome::*at_end;  ///< Position at the end of a torque level.
};

/// Dataset of the position and torque at the end of each torque level. Levels that end at the same point
/// share a row.
FigureData level_ends(const ReplayedTrial& trial, const LoadedPlace& place) {
  FigureData data{
      "levels", {{"levels", "levels", ""}, {place.field, place.title, "µrad"}, {"torque", "$torque", "N m"}}};
  const std::vector<trial::MoveOutcome>& levels = trial.result.outcome.moves;
  double reach = 0.0;
  for (const trial::MoveOutcome& level : levels)
    reach = std::max(reach, std::abs(1e6 * (level.*place.at_end)));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double end = 1e6 * (levels[i].*place.at_end);
    const std::string name = fmt::format("{}", i + 1);
    const auto shared = std::find_if(data.rows.begin(), data.rows.end(), [&](const ordered_json& row) {
      return std::abs(row[1].get<double>() - end) <= 0.01 * reach &&
             std::abs(row[2].get<double>() - levels[i].holding_torque) <= 1e-6;
    });
    if (shared == data.rows.end()) {
      data.rows.push_back(ordered_json::array({name, datum(end), datum(levels[i].holding_torque)}));
    } else {
      (*shared)[0] = (*shared)[0].get<std::string>() + ", " + name;
    }
  }
  return data;
}

/// Figure of the torque over a position that this torque displaces, in an open-loop trial.
/// @param meaning sentence on what the curve shows
Figure loading_figure(const ReplayedTrial& trial, const char* name, const char* title,
                      const LoadedPlace& place, const char* meaning) {
  const SampleColumn column{{place.field, place.title, "µrad"},
                            [place](Sample s) { return datum(1e6 * s.*place.of_sample); }};
  Figure figure = figure_of(
      "loading", name, title,
      fmt::format(
          "$Torque over {} of trial {}. Each number marks the end of a $torque level, in their order. {}",
          place.title, trial.result.row, meaning),
      {data_of("samples", trial.samples, {time_column, column, motor_torque_column}),
       level_ends(trial, place)});
  figure.parameters["place"] = place.field;
  return figure;
}

Figure hysteresis(const ReplayedTrial& trial, bool creeping) {
  return loading_figure(
      trial, "paper-fig4", "$Torque over $angle (Fig. 4 of the paper)",
      {"angle", "$rotor_angle", &trial::SampleRecord::theta, &trial::MoveOutcome::final_position},
      creeping ? "Creep moves the $rotor on while the $torque is held, so a loop does not close where the "
                 "contact has crept in it."
               : "The spring has hysteresis with return-point memory: loops between the same $torques have "
                 "the same width, and a closed loop has no further influence, so levels of equal $torque end "
                 "at the same point.");
}

Figure plastic_extension(const ReplayedTrial& trial) {
  return loading_figure(
      trial, "paper-fig6", "$Torque over plastic extension (Fig. 6 of the paper)",
      {"extension", "plastic extension", &trial::SampleRecord::xp, &trial::MoveOutcome::creep},
      "At constant $torque the contact creeps along a horizontal line until it has hardened. A repeated or "
      "smaller $torque of either sign adds no extension.");
}

/// Whether the friction contact of the first trial creeps (goes on moving under a constant torque).
bool creeps(const ReportedStudy& reported) {
  const trial::TrialParameters parameters = study::study_trial(reported.study, 0, 0).parameters;
  return friction::has_creep(parameters.friction.model) &&
         friction::friction_at(parameters.friction, parameters.initial.position).alpha > 0.0;
}

}  // namespace

std::vector<Figure> paper_figures(const ReportedStudy& reported, const Replay& replay) {
  if (reported.study.open_loop) {
    SampleTrial trial = first_trial(0);
    trial.buckets = 2000;
    const ReplayedTrial replayed = replay(trial);
    const bool creeping = creeps(reported);
    std::vector<Figure> figures{hysteresis(replayed, creeping)};
    if (creeping) figures.push_back(plastic_extension(replayed));
    return figures;
  }
  if (shows_targets(reported)) {
    std::vector<ReplayedTrial> replayed;
    for (std::int64_t point = 0; point < std::ssize(reported.summary.points); ++point)
      replayed.push_back(replay(first_trial(point)));
    return {step_responses(replayed)};
  }
  if (shows_jerks(reported)) return {jerks_in_time(replay(typical_trial(reported)))};
  return {};
}

namespace {

bool alike(const trial::SampleRecord& a, const trial::SampleRecord& b) {
  return a.count == b.count && a.torque == b.torque && a.target == b.target;
}

}  // namespace

TraceThinner::TraceThinner(std::int64_t samples, std::int64_t buckets)
    : bucket_length_(std::max<std::int64_t>(1, (samples + buckets - 1) / buckets)) {}

void TraceThinner::add(const trial::SampleRecord& sample) {
  if (sample.k / bucket_length_ != bucket_) {
    close_bucket();
    bucket_ = sample.k / bucket_length_;
  }
  at_hand_.push_back(sample);
}

void TraceThinner::close_bucket() {
  std::vector<SampleQuantity> quantities{
      [&](std::size_t i) { return static_cast<double>(at_hand_[i].error); },
      [&](std::size_t i) { return at_hand_[i].torque; }};
  if (std::ranges::any_of(at_hand_, [](const auto& sample) { return sample.load_theta != sample.theta; })) {
    quantities.push_back([&](std::size_t i) { return at_hand_[i].theta; });
    quantities.push_back([&](std::size_t i) { return at_hand_[i].load_theta; });
  }
  for (const std::size_t place : extreme_samples(0, at_hand_.size(), quantities)) {
    const trial::SampleRecord& sample = at_hand_[place];
    const std::size_t size = kept_.size();
    if (size >= 2 && alike(kept_[size - 1], sample) && alike(kept_[size - 2], sample)) kept_.pop_back();
    kept_.push_back(sample);
  }
  at_hand_.clear();
}

std::vector<trial::SampleRecord> TraceThinner::finish() {
  close_bucket();
  return std::move(kept_);
}

ReplayedTrial replay_trial(const study::Study& study, std::int64_t point, std::int64_t index,
                           std::int64_t buckets) {
  const study::StudyTrial trial = study::study_trial(study, point, index);
  TraceThinner thinner(trial::samples_of_trial(trial.parameters), buckets);
  ReplayedTrial replayed;
  replayed.point = point;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& sample) { thinner.add(sample); };
  observers.jerk = [&](const trial::Jerk& jerk) { replayed.result.jerks.push_back(jerk); };
  replayed.result.inputs = trial.inputs;
  replayed.result.outcome = trial::run_trial(trial.parameters, observers);
  replayed.samples = thinner.finish();
  replayed.parameters = trial.parameters;
  return replayed;
}

}  // namespace zerocount::report
