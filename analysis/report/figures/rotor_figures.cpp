#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "analysis/basis/statistics/unknown.hpp"
#include "analysis/report/figures/report_figures.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "experiments/parameters/handles.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::report {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t max_profiles = 4;
constexpr std::int64_t profile_points = 512;
constexpr std::int64_t max_failures = 250;

/// Final position of a trial on the rotor, and its outcome.
struct EndOnRotor {
  std::int64_t trial{0};  ///< Index of the trial within the point.
  double angle{0.0};      ///< Final position, rad or m, in [0, period).
  trial::Outcome outcome{trial::Outcome::zero_count};
  /// True if the trial meets the question by which the study is judged: its goal or, without a goal, success.
  bool met{true};
};

double on_rotor(double angle, double period) {
  const double within = std::fmod(angle, period);
  return within < 0.0 ? within + period : within;
}

/// Index of the input column with the start position of each trial; nothing if there is none.
std::optional<std::size_t> position_column(const reading::AllTrialsFile& file) {
  const std::vector<study::InputColumn>& inputs = file.input_columns();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (inputs[i].name == parameter::initial::position) return i;
  }
  return std::nullopt;
}

/// The trials of a figure: all trials of a point, or the trials of one machine at that point.
struct ShownTrials {
  std::int64_t point{0};
  std::optional<std::int64_t> machine{};
};

/// Final positions of the shown trials. A trial that ended with a non-finite state is shown at its start
/// position.
/// @param column index of the input column with the start positions
std::vector<EndOnRotor> ends_of(const ReportedStudy& reported, const ShownTrials& shown, std::size_t column) {
  const layout::RowRange rows = rows_of(reported, shown.point);
  const std::vector<double> starts = reported.file.input(column, rows);
  std::vector<EndOnRotor> ends;
  measures::visit_trials(
      reported.file, rows, [&](std::int64_t row, std::span<const trial::MoveOutcome> moves) {
        const std::int64_t trial = row - rows.first;
        if (shown.machine &&
            study::group_of(reported.study, study::Grouping::machine, trial) != *shown.machine)
          return;
        const double start = starts[static_cast<std::size_t>(trial)];
        const double end = start + moves.back().final_position;
        ends.push_back({trial, on_rotor(std::isfinite(end) ? end : start, reported.study.period),
                        trial::worst_outcome(moves), meets(question_of(reported), moves)});
      });
  return ends;
}

/// The design point to which a stored parameter profile along the rotor belongs: the point in its name,
/// otherwise the chosen point.
std::int64_t point_of_profile(const ReportedStudy& reported, const std::string& profile) {
  const std::size_t at = profile.find('@');
  return at == std::string::npos ? reported.chosen.point : std::stoll(profile.substr(at + 1));
}

double value_at(const reading::StoredProfile& profile, double angle, double period) {
  const double size = static_cast<double>(profile.value.size());
  const double place = angle / period * size;
  const auto before = static_cast<std::size_t>(place) % profile.value.size();
  const double fraction = place - std::floor(place);
  return (1.0 - fraction) * profile.value[before] +
         fraction * profile.value[(before + 1) % profile.value.size()];
}

FigureData profile_data(const reading::StoredProfile& profile) {
  FigureData data{"profile", {{"theta", "$rotor_angle", "rad"}, {"value", profile.name, profile.unit}}};
  for (const std::int64_t i : statistics::spread_over(std::ssize(profile.theta), profile_points)) {
    const auto at = static_cast<std::size_t>(i);
    data.rows.push_back(ordered_json::array({datum(profile.theta[at]), datum(profile.value[at])}));
  }
  return data;
}

/// Dataset of the proportion of trials that meet the question (goal or success) in equal sectors of the
/// rotor.
/// @param period length of the rotor's position range, rad or m
/// @param rate name of the proportion
FigureData sector_data(const std::vector<EndOnRotor>& ends, double period, std::size_t sectors,
                       std::string_view rate) {
  FigureData data{"sectors",
                  {{"from", "from", "rad"},
                   {"to", "to", "rad"},
                   {"rate", std::string(rate), "1"},
                   {"low", "lower 95 % bound", "1"},
                   {"high", "upper 95 % bound", "1"},
                   {"successes", "trials that met it", "1"},
                   {"trials", "trials", "1"}}};
  const auto sector_of = [&](const EndOnRotor& end) {
    return std::min(static_cast<std::size_t>(end.angle / period * static_cast<double>(sectors)), sectors - 1);
  };
  const double width = period / static_cast<double>(sectors);
  for (std::size_t i = 0; i < sectors; ++i) {
    const std::int64_t trials = std::ranges::count(ends, i, sector_of);
    const std::int64_t met =
        std::ranges::count_if(ends, [&](const EndOnRotor& end) { return end.met && sector_of(end) == i; });
    if (trials == 0) continue;
    const statistics::ConfidenceInterval bounds = statistics::clopper_pearson(met, trials);
    data.rows.push_back({datum(width * static_cast<double>(i)), datum(width * static_cast<double>(i + 1)),
                         datum(statistics::rate(met, trials)), datum(bounds.low), datum(bounds.high), met,
                         trials});
  }
  return data;
}

/// Index of the machine with the fewest moves or trials that meet the question (goal or success) at the
/// design point.
std::int64_t worst_machine(const ReportedStudy& reported, std::int64_t point) {
  const std::vector<statistics::MachineMoves> machines =
      counts_of(question_of(reported), point_of(reported, point)).machines;
  return std::ranges::min_element(machines, {}, &statistics::MachineMoves::met) - machines.begin();
}

reading::StoredProfile rotor_of_machine(const reading::StoredProfile& profile, std::int64_t machine) {
  reading::StoredProfile rotor{profile.name, profile.unit, profile.theta, {}};
  const auto first = profile.value.begin() + machine * std::ssize(profile.theta);
  rotor.value.assign(first, first + std::ssize(profile.theta));
  return rotor;
}

/// Name of the proportion of trials that meet the question.
std::string_view name_of_trial_rate(const goal::Question& question) {
  return question.goal() ? "rate of trials in goal" : "success rate";
}

std::string caption_of(const ReportedStudy& reported, const std::string& parameter, const ShownTrials& shown,
                       bool failed) {
  const std::string& label = label_of(reported, shown.point);
  const std::string trials = shown.machine ? fmt::format("machine {} at point {}", *shown.machine, label)
                                           : fmt::format("point {}", label);
  const goal::Question& question = question_of(reported);
  const bool has_goal = question.goal().has_value();
  std::string caption =
      shown.machine
          ? fmt::format("The line is {} along the $track of machine {}, the one with the lowest {}. ",
                        parameter, *shown.machine, name_of_rate(question))
          : fmt::format("The line is {} along the $track, the same in all trials. ", parameter);
  caption += failed ? fmt::format("The marks are the {} of {}, at the $rotor_angle where they ended. ",
                                  has_goal ? "trials that miss the goal" : "failed trials", trials)
                    : fmt::format("No trial of {} {}. ", trials, has_goal ? "missed the goal" : "failed");
  return caption +
         fmt::format(
             "Below: {} that ended in each sector of the $track, with 95 % Clopper-Pearson bounds. If "
             "it follows the line, the minimum of the profile limits it, as the paper states for k1 "
             "(practical issue 1).",
             name_of_trial_rate(question));
}

Figure rotor_figure(const ReportedStudy& reported, const reading::StoredProfile& stored, std::size_t column) {
  ShownTrials shown{point_of_profile(reported, stored.name)};
  if (stored.machines > 0) shown.machine = worst_machine(reported, shown.point);
  const reading::StoredProfile profile = shown.machine ? rotor_of_machine(stored, *shown.machine) : stored;
  const std::int64_t trials_shown =
      reported.file.header().trials / std::max<std::int64_t>(stored.machines, 1);
  const double period = reported.study.period;
  const std::vector<EndOnRotor> ends = ends_of(reported, shown, column);
  std::vector<EndOnRotor> failures;
  std::ranges::copy_if(ends, std::back_inserter(failures), [](const EndOnRotor& end) { return !end.met; });
  FigureData trials{"trials",
                    {{"trial", "trial of the point", "1"},
                     {"theta", "$rotor_angle at the end", "rad"},
                     {"value", profile.name, profile.unit},
                     {"outcome", "outcome", ""}}};
  for (const std::int64_t i : statistics::spread_over(std::ssize(failures), max_failures)) {
    const EndOnRotor& end = failures[static_cast<std::size_t>(i)];
    trials.rows.push_back(
        ordered_json::array({end.trial, datum(end.angle), datum(value_at(profile, end.angle, period)),
                             layout::outcome_labels()[static_cast<std::size_t>(end.outcome)].word}));
  }
  const std::string parameter = profile.name.substr(0, profile.name.find('@'));
  std::string caption = caption_of(reported, parameter, shown, !failures.empty());
  if (std::ssize(failures) > max_failures) {
    caption += fmt::format(" {} of {} failures are shown, evenly spaced.", max_failures, failures.size());
  }
  Figure figure = figure_of(
      "rotor", fmt::format("rotor-{}", profile.name),
      failures.empty() ? fmt::format("How does {} vary along the $track?", parameter)
      : question_of(reported).goal()
          ? fmt::format("Where along the $track are the trials that miss the goal, over {}?", parameter)
          : fmt::format("Where along the $track are the failed trials, over {}?", parameter),
      caption,
      {std::move(trials), profile_data(profile),
       sector_data(ends, period, trials_shown >= 480 ? 24 : 12, name_of_trial_rate(question_of(reported)))});
  figure.parameters["period"] = {0.0, period};
  // The first dataset is the table behind the figure.
  if (failures.empty()) std::rotate(figure.data.begin(), figure.data.begin() + 2, figure.data.end());
  return figure;
}

}  // namespace

std::vector<Figure> rotor_figures(const ReportedStudy& reported) {
  std::vector<Figure> figures;
  const std::optional<std::size_t> column = position_column(reported.file);
  if (reported.study.open_loop || !column || !reported.file.has_profiles()) return figures;
  const std::vector<reading::StoredProfile> profiles = reported.file.profiles();
  for (const std::int64_t i : statistics::spread_over(std::ssize(profiles), max_profiles))
    figures.push_back(rotor_figure(reported, profiles[static_cast<std::size_t>(i)], *column));
  return figures;
}

}  // namespace zerocount::report
