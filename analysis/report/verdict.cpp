#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/statistics/sample_size.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/report_sections.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary/chosen_point.hpp"

namespace zerocount::report {
namespace {

/// The number of design points from which a point was chosen, for which its bounds are corrected: those of
/// the choice for the chosen point, otherwise all.
std::size_t chosen_from(const ReportedStudy& reported, std::int64_t point) {
  return point == reported.chosen.point ? static_cast<std::size_t>(reported.chosen.chosen_from)
                                        : reported.summary.points.size();
}

/// Bounds of the rate at the chosen or the worst design point as text: " (95 % bounds a to b)". They are
/// corrected for the choice of the point among all points. Empty if the trials are not independent.
std::string bounds_text(const ReportedStudy& reported, const goal::Question& question, std::int64_t point) {
  if (reported.summary.features.dependent_trials) return "";
  const std::size_t points = chosen_from(reported, point);
  const statistics::ConfidenceInterval bounds =
      goal::rate_of(question, point_of(reported, point), points).bounds;
  return fmt::format(" ({}{} bounds {} to {}{})", question.goal() ? "one-sided " : "",
                     text::percent(goal::confidence_of(question, statistics::summary_confidence)),
                     text::percent_at_least(bounds.low), text::percent_at_most(bounds.high),
                     points == 1 ? "" : fmt::format(", corrected for the choice among {} points", points));
}

/// The question whether trials succeed (all moves end at zero error), also if the study is judged by a goal.
goal::Question success_of(const ReportedStudy& reported) {
  return goal::success(question_of(reported));
}

std::string of_all(std::int64_t successes, std::int64_t trials) {
  return fmt::format("{} of {} trials", successes, trials);
}

/// Sentence on the failure probability if no trial failed.
std::string flawless_text(const ReportedStudy& reported, const statistics::SuccessClaim& claim) {
  if (reported.summary.features.dependent_trials) {
    return fmt::format(
        "No failure in {} trials does not prove 100 % repeatability. As these trials are not independent, "
        "they give no bound of the failure probability.",
        claim.trials);
  }
  return fmt::format(
      "No failure in {} trials does not prove 100 % repeatability: with 95 % confidence the probability of a "
      "failure is at most {}. To show that it is below 0.1 % takes {} {} without a failure.",
      claim.trials, text::percent_at_most(claim.failure_at_most),
      statistics::trials_for_claim(0.999, claim.confidence, 0), claim.machines > 0 ? "machines" : "trials");
}

std::string capitalised(std::string line) {
  if (!line.empty() && line.front() >= 'a' && line.front() <= 'z')
    line.front() = static_cast<char>(line.front() - 'a' + 'A');
  return line;
}

/// The headline of the command `summary`. For a study with one design point, its name is left out.
std::string headline(const ReportedStudy& reported, const std::optional<summary::JudgedPoint>& judged) {
  const std::string text = judged ? summary::judgement_headline(reported.summary, *judged)
                                  : summary::claim_of_chosen_point(reported.summary, reported.chosen);
  return capitalised(reported.summary.points.size() == 1 ? text.substr(text.find(": ") + 2) : text);
}

/// Appends each line of the text to `lines`, as a sentence.
void add_sentences(std::vector<std::string>& lines, const std::string& text) {
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    line.erase(0, line.find_first_not_of(' '));
    if (!line.empty()) lines.push_back(capitalised(std::move(line)) + ".");
  }
}

/// Appends conclusions on the goals that the table of requirements does not contain.
void add_goal(std::vector<std::string>& lines, const ReportedStudy& reported,
              const summary::JudgedPoint& judged) {
  const goal::Question& question = reported.summary.question;
  if (const auto all = machines_meeting_all(question, point_of(reported, judged.chosen.point)))
    lines.push_back(fmt::format("{} of {} machines meet all goals under all conditions together.",
                                all->machines, all->of));
  if (const auto worlds = summary::worlds_of_point(reported.summary, judged.chosen.point))
    add_sentences(lines, summary::bad_worlds_sentence(
                             *worlds, summary::world_inputs_of(reported.summary, judged.chosen.point),
                             reported.summary.question));
  if (judged.needs)
    lines.push_back(goal::needs_sentence(*question.parts[judged.verdict.goal].goal, *judged.needs,
                                         reported.summary.features.machines) +
                    ".");
}

void add_success(std::vector<std::string>& lines, const ReportedStudy& reported, std::int64_t best) {
  const measures::PointSummary& point = point_of(reported, best);
  lines.push_back(fmt::format("{} ended at zero counts{}{}{}.",
                              of_all(point.outcomes.zero_count, point.trials), question_of(reported).of_mass,
                              bounds_text(reported, success_of(reported), best),
                              reported.summary.question.worlds > 0 ? ", on average over the worlds" : ""));
  if (point.outcomes.zero_count == point.trials)
    lines.push_back(flawless_text(
        reported, goal::claim_of_chosen(point, chosen_from(reported, best), question_of(reported).stopped)));
  const measures::OutcomeCounts& outcomes = point.outcomes;
  if (outcomes.zero_count < point.trials) {
    lines.push_back(
        fmt::format("Of the others, {} ended within one count, {} off target (stalled or still moving to the "
                    "target), {} oscillating, and {} failed numerically.",
                    outcomes.one_count, outcomes.off_target, outcomes.oscillating, outcomes.nonfinite));
  }
}

void add_spread(std::vector<std::string>& lines, const ReportedStudy& reported, std::int64_t best) {
  const std::vector<measures::PointSummary>& points = reported.summary.points;
  if (points.size() == 1) return;
  const bool has_goal = question_of(reported).goal().has_value();
  std::vector<goal::QuestionRate> rates;
  for (std::int64_t point = 0; point < std::ssize(points); ++point)
    rates.push_back(shown_rate(reported, point));
  const auto flawless =
      std::ranges::count_if(rates, [](const goal::QuestionRate& rate) { return rate.hits == rate.events; });
  const auto worst = std::ranges::min_element(rates, {}, &goal::QuestionRate::value);
  const std::string proportion = flawless == 0 ? fmt::format("None of the {} points is", points.size())
                                               : fmt::format("{} of the {} points {}", flawless,
                                                             points.size(), flawless == 1 ? "is" : "are");
  if (worst->value == rates[static_cast<std::size_t>(best)].value) {
    lines.push_back(has_goal
                        ? fmt::format("{} without a miss; no other met the goal less often.", proportion)
                        : fmt::format("{} without a failure; no other succeeded less often.", proportion));
    return;
  }
  const std::int64_t at = worst - rates.begin();
  const std::string bounds = bounds_text(reported, question_of(reported), at);
  lines.push_back(has_goal
                      ? fmt::format("{} without a miss. The worst, {}, met the goal in {} of {} moves{}.",
                                    proportion, label_of(reported, at), worst->hits, worst->events, bounds)
                      : fmt::format("{} without a failure. The worst, {}, succeeded in {} of {} trials{}.",
                                    proportion, label_of(reported, at), worst->hits, worst->events, bounds));
}

/// Design points at which a theoretical stability criterion gives the same prediction for every trial, with
/// counts of their trials and outcomes.
struct DecidedPoints {
  std::int64_t points{0}, trials{0}, stable{0}, undecided{0};

  void add(const measures::PointSummary& point) {
    ++points;
    trials += point.trials;
    stable += point.of(&trial::MoveOutcome::stable).trials;
    undecided += point.outcomes.off_target;
  }
  /// @param statement beginning of the sentence, such as "Criterion (7) is exceeded"
  void add_to(std::vector<std::string>& lines, std::string_view statement) const {
    if (points == 0) return;
    lines.push_back(fmt::format("{} in every trial of {} point{}; {} there were stable{}.", statement, points,
                                points == 1 ? "" : "s", of_all(stable, trials),
                                undecided == 0 ? "" : fmt::format(", {} undecided", undecided)));
  }
};

void add_theory(std::vector<std::string>& lines, const ReportedStudy& reported) {
  DecidedPoints stable, beyond;
  for (std::size_t i = 0; i < reported.summary.predictions.size(); ++i) {
    const theory::PointPrediction& prediction = reported.summary.predictions[i];
    if (theory::predicted_trials(prediction) == 0) continue;
    if (prediction.stable == prediction.trials) stable.add(reported.summary.points[i]);
    if (prediction.unstable == prediction.trials) beyond.add(reported.summary.points[i]);
  }
  stable.add_to(lines, "Criterion (6) of the paper holds");
  beyond.add_to(lines, "Criterion (7) is exceeded");
}

Conclusions open_loop_conclusions(const ReportedStudy& reported) {
  std::int64_t lost = 0;
  std::int64_t broke_away = 0;
  std::int64_t trials = 0;
  for (const measures::PointSummary& point : reported.summary.points) {
    lost += point.outcomes.nonfinite;
    broke_away += point.of(&trial::MoveOutcome::broke_away).trials;
    trials += point.trials;
  }
  const parameters::AxisKind axis = reported.study.units.axis;
  return {
      parameters::text_on(axis,
                          "A material test: the $rotor was loaded by $torques, without targets, so there is "
                          "no success rate."),
      {parameters::text_on(
          axis,
          fmt::format(
              "In {} of {} trials the contact broke away into sliding; {} failed numerically. The table "
              "below shows how far each level moved the $rotor, and the part of creep.",
              broke_away, trials, lost))}};
}

}  // namespace

Conclusions conclusions_of(const ReportedStudy& reported) {
  if (reported.study.open_loop) return open_loop_conclusions(reported);
  const std::int64_t best = reported.chosen.point;
  std::vector<std::string> lines;
  std::optional<summary::JudgedPoint> judged;
  if (question_of(reported).goal()) judged = summary::judge_point(reported.summary, reported.chosen);
  if (reported.summary.features.dependent_trials) {
    lines.push_back(
        fmt::format("{} Statements about all axes, with bounds, need a study with `design: monte_carlo`.",
                    dependence_sentence));
  }
  if (judged) {
    add_goal(lines, reported, *judged);
  } else {
    add_success(lines, reported, best);
  }
  if (reported.chosen.chosen_from > 1 && !reported.summary.features.dependent_trials)
    lines.emplace_back("The bounds allow for the choice of the point by these trials.");
  add_sentences(lines, summary::competition_text(reported.summary, reported.chosen));
  add_spread(lines, reported, best);
  if (!judged) add_theory(lines, reported);
  return {headline(reported, judged), std::move(lines)};
}

std::string zero_counts_html(const ReportedStudy& reported) {
  std::vector<std::string> lines;
  add_success(lines, reported, reported.chosen.point);
  add_theory(lines, reported);
  std::string html;
  for (const std::string& line : lines) html += fmt::format("<p>{}</p>\n", document::prose_markup(line));
  return html;
}

}  // namespace zerocount::report
