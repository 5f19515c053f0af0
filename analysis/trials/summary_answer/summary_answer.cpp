#include "analysis/trials/summary_answer/summary_answer.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/summary/cells_of_point.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "analysis/trials/summary_answer/parts.hpp"
#include "core/text/text.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Visibility;
using summary::StudySummary;
using Summary = const SummaryResults&;

const SummaryResults& same_summary(Summary s) {
  return s;
}

/// Number of machines with trials; for an unfinished run, at the design point with the most machines.
std::int64_t machines_of(const StudySummary& summary) {
  std::int64_t machines = 0;
  for (const measures::PointSummary& point : summary.points) machines = std::max(machines, point.machines.n);
  return machines;
}

/// The size of the study as text: "paper-gains: 8 points × 2000 trials on 100 machines".
std::string size_line(const StudySummary& summary) {
  std::string line =
      fmt::format("{}: {}", text::printable(summary.name), text::counted(summary.points.size(), "point"));
  if (const std::optional<std::int64_t> trials = trials_of_each(summary))
    line += " × " + text::counted(*trials, "trial");
  if (summary.features.machines) line += " on " + text::counted(machines_of(summary), "machine");
  return line;
}

std::string headline(Summary s) {
  if (s.summary.features.open_loop) return size_line(s.summary);
  if (s.summary.question.goal())
    return summary::judgement_headline(s.summary, summary::judge_point(s.summary, s.chosen));
  return summary::claim_of_chosen_point(s.summary, s.chosen);
}

/// Text with the reasons for the headline; empty for an open-loop study.
std::string details(Summary s) {
  if (s.summary.features.open_loop) return {};
  if (s.summary.question.goal())
    return fmt::format("goal: {}\n{}", goal::claim_sentence(s.summary.question),
                       summary::judgement_details(s.summary, summary::judge_point(s.summary, s.chosen)));
  const bool allows = s.chosen.chosen_from > 1 && !s.summary.features.dependent_trials;
  return (allows ? "  the bound allows for the choice of the point by these trials\n" : "") +
         summary::competition_text(s.summary, s.chosen);
}

std::string study_lines(Summary s) {
  const std::string unfinished = unfinished_sentence(s.summary);
  return (s.summary.features.open_loop ? "" : size_line(s.summary) + "\n") +
         (unfinished.empty() ? "" : unfinished + "\n") + design_line(s.summary);
}

/// Text with a line for every design point with trials whose motion became non-finite. The reader must know
/// of them because they count as failures.
std::string nonfinite_lines(Summary s) {
  std::string lines;
  for (const DescribedPoint& point : s.points) {
    const std::int64_t lost = point.statistics().outcomes.nonfinite;
    if (lost == 0) continue;
    lines += fmt::format(
        "{}: {} of {} trials nonfinite: the motion left the finite numbers or could not be followed\n",
        text::printable(point.label()), lost, point.statistics().trials);
  }
  return lines;
}

std::string points_shown(Summary s) {
  if (s.points.size() == s.summary.points.size()) return {};
  return fmt::format("({} of {} points)\n", s.points.size(), s.summary.points.size());
}

document::Description<summary::UnfinishedStudy> unfinished_description() {
  using Unfinished = summary::UnfinishedStudy;
  return document::Description<Unfinished>()
      .value(document::in_data("finished", "trials that the summary is of"), &Unfinished::finished)
      .value(document::in_data("trials", "trials of the study; the maximum if 'stop' decides"),
             &Unfinished::trials);
}

/// A swept number that is at the end of its range at the chosen point.
struct RangeEnd {
  const StudySummary& summary;
  std::int64_t point;
  summary::EndOfRange end;
};

std::vector<RangeEnd> ends_of(Summary s) {
  std::vector<RangeEnd> ends;
  for (const summary::EndOfRange& end : s.chosen.ends) ends.push_back({s.summary, s.chosen.point, end});
  return ends;
}

SummaryDescription chosen_description() {
  using End = const RangeEnd&;
  document::Description<RangeEnd> ends;
  ends.value(document::in_data("parameter", "dotted path"),
             [](End e) { return e.summary.axes[e.end.axis].name; })
      .value(document::in_data("value", "value at the point, in the unit of the parameter"),
             [](End e) { return summary::value_at(e.summary, e.end, e.point); })
      .value({.key = "end", .meaning = "which end of the range it is", .words = {"lowest", "highest"}},
             [](End e) { return e.end.lowest ? "lowest" : "highest"; });
  return SummaryDescription()
      .value(document::in_data("point", "number of the design point"),
             [](Summary s) { return s.chosen.point; })
      .value(document::in_data("label", "label of the design point"),
             [](Summary s) { return s.summary.labels[static_cast<std::size_t>(s.chosen.point)]; })
      .value(document::in_data("chosen_from", "points that it is the best of; 1 if it was named"),
             [](Summary s) { return s.chosen.chosen_from; })
      .value(document::in_data("runner_up", "number of the best of the other points"),
             [](Summary s) { return s.chosen.runner_up; })
      .value(document::in_data("as_good", "numbers of the points that are not shown to be worse"),
             [](Summary s) { return s.chosen.as_good; })
      .table({.key = "ends_of_ranges", .meaning = "swept numbers of the point at an end of their range"},
             ends, ends_of);
}

/// Results of the new trials that the option --confirm runs at the chosen point.
struct ConfirmationResults {
  const StudySummary& summary;
  const Confirmation& confirmed;

  /// A point summary that holds only the new trials' counts of moves that meet the goals.
  measures::PointSummary point() const {
    measures::PointSummary point;
    point.goals = confirmed.goals;
    return point;
  }
  bool has_one_trial_per_machine() const { return confirmed.machines == confirmed.trials; }
  double rate() const { return statistics::rate(confirmed.successes, confirmed.trials); }
  std::string size_text() const {
    return fmt::format("{}{}{}", confirmed.trials,
                       confirmed.machines == 0       ? ""
                       : has_one_trial_per_machine() ? ", each on a machine of its own"
                                                     : fmt::format(" on {} machines", confirmed.machines),
                       summary.question.worlds > 0 ? ", on average over new worlds" : "");
  }
  /// Clopper–Pearson bounds of the success rate of the new trials. Empty if the trials are dependent: if
  /// several share a machine, or the study has settings.
  std::optional<statistics::ConfidenceInterval> bounds() const {
    if (confirmed.machines > 0 && !has_one_trial_per_machine()) return std::nullopt;
    if (!summary.question.settings.empty()) return std::nullopt;  // a machine has a trial under each
    return statistics::clopper_pearson(confirmed.successes, confirmed.trials, summary.confidence);
  }
  std::optional<goal::Verdict> verdict() const {
    if (confirmed.goals.empty()) return std::nullopt;
    return goal::verdict_on(summary.question, point());
  }
};
using Confirmed = const ConfirmationResults&;

std::optional<ConfirmationResults> confirmation_of(Summary s) {
  if (!s.confirmation) return std::nullopt;
  return ConfirmationResults{s.summary, *s.confirmation};
}

document::Description<ConfirmationResults> confirmation_description(const StudySummary& summary) {
  document::Description<ConfirmationResults> description;
  description
      .value(document::in_data("point", "number of the design point"),
             [](Confirmed c) { return c.confirmed.point; })
      .value({"seed", "seed", "seed of the new trials"}, [](Confirmed c) { return c.confirmed.seed; })
      .value({"trials", "trials", "new trials"}, [](Confirmed c) { return c.confirmed.trials; })
      .shown_as([](Confirmed c) { return c.size_text(); })
      .value({"zero_count", "succeeded", "new trials that succeeded"},
             [](Confirmed c) { return c.confirmed.successes; })
      .value({"success_rate", "success rate [bounds]",
              "their proportion, with bounds of Clopper and Pearson unless trials share machines", "1",
              document::Notation::percent},
             [](Confirmed c) {
               const statistics::ConfidenceInterval bounds = c.bounds().value_or(
                   statistics::ConfidenceInterval{statistics::unknown, statistics::unknown});
               return document::Bounded{c.rate(), bounds.low, bounds.high};
             })
      .value(document::in_data("one_trial_per_machine", "whether every new trial has a machine of its own"),
             &ConfirmationResults::has_one_trial_per_machine);
  if (summary.question.goal())
    description.object({.key = "goal", .meaning = "whether the new trials meet the goal"},
                       verdict_description(summary.question, summary.features.machines),
                       &ConfirmationResults::verdict);
  return description;
}

/// The JSON items of two types of answers in one list. Items that one of them lacks are optional.
std::vector<document::Item> united(std::vector<document::Item> all, const std::vector<document::Item>& more) {
  const auto find = [](auto& items, const std::string& key) {
    return std::ranges::find(items, key, &document::Item::key);
  };
  std::erase_if(all, [](const document::Item& item) {
    return !document::is_shown(item.shown, document::Audience::json);
  });
  for (document::Item& item : all) item.optional = item.optional || find(more, item.key) == more.end();
  for (const document::Item& item : more) {
    if (!document::is_shown(item.shown, document::Audience::json)) continue;
    if (const auto known = find(all, item.key); known != all.end()) {
      if (item.free_keys) continue;
      if (item.kind != document::Kind::list && item.kind != document::Kind::map)
        known->members = united(known->members, item.members);
      continue;
    }
    all.push_back(item);
    all.back().optional = true;
  }
  return all;
}

/// A summary of a made-up study with all features except torque levels, from which the type of the answers is
/// derived.
StudySummary full_study() {
  StudySummary full;
  full.features.motion = full.features.steps = full.features.following = full.features.reversals = true;
  full.features.travel = full.features.phases = full.features.load = full.features.drive_torque = true;
  full.features.load_count = full.features.motor_count = true;
  full.features.load_error = full.features.motor_error = true;
  full.features.coarse_errors = full.features.encoder_errors = full.features.final_error =
      full.features.stopping = true;
  full.features.own_controller = full.features.machines = true;
  full.question.parts.front().goal = study::Goal{.name = "goal", .machines = 0.99, .beside_load = true};
  full.question.parts.push_back(full.question.parts.front());
  full.features.position_error = true;
  full.features.tolerances = {{1e-8}, 1};
  full.question.worlds = 1;
  full.question.settings = {.conditions = {"empty"}, .ages = {.at = {0.0}}};
  full.predictions.resize(1);
  full.observed_counts[""] = {};
  full.stop = study::StoppingRule{};
  full.features.motor_closes = full.features.load_closes = true;
  full.repeatability = iso230::RepeatabilitySummary{
      .shape = {1, 1, true, true}, .points = {}, .sources = &iso230::deviation_sources(full.features)};
  full.unfinished = summary::UnfinishedStudy{};
  return full;
}

}  // namespace

std::optional<std::int64_t> trials_of_each(const StudySummary& summary) {
  if (summary.points.empty()) return std::nullopt;
  const std::int64_t trials = summary.points.front().trials;
  const bool equal = std::ranges::all_of(
      summary.points, [&](const measures::PointSummary& point) { return point.trials == trials; });
  return equal ? std::optional(trials) : std::nullopt;
}

std::string bounds_head(const StudySummary& summary) {
  return text::percent(summary.confidence) + " bounds";
}

std::string design_line(const StudySummary& summary) {
  const study::StudyFeatures& features = summary.features;
  if (features.dependent_trials) {
    return "The trials of a saltelli design are not independent: all bounds here are too narrow. They are "
           "for 'zerocount sensitivity'";
  }
  std::string line = fmt::format("design: {}", summary.design);
  if (features.machines && !summary.points.empty()) {
    line += fmt::format(
        ", {} machines: bounds hold for all machines that the manifest describes, and more trials on the "
        "same machines narrow them only so far",
        machines_of(summary));
  }
  if (summary.question.worlds > 0) {
    line += fmt::format(", {} worlds: rates over all trials are averages over the worlds{}",
                        summary.question.worlds,
                        summary.question.goal() ? "; those of the goal hold for the worst world" : "");
  }
  const study::Settings& settings = summary.question.settings;
  const std::size_t ages = settings.ages.at.size();
  if (study::counts_conditions(settings))
    line += fmt::format(", {} conditions: statistics of all trials are over the conditions together",
                        settings.conditions.size());
  if (ages > 0) line += fmt::format(", {} ages: statistics of all trials are over the ages together", ages);
  if (features.spread_trials) {
    line += fmt::format(
        "{} bounds are conservative: made for trials by chance, which vary more than those of this design",
        features.machines || summary.question.worlds > 0 || !summary.question.settings.empty() ? ";" : ":");
  }
  return line;
}

std::string unfinished_sentence(const StudySummary& summary) {
  if (!summary.unfinished) return {};
  const std::int64_t begun = std::ranges::count_if(
      summary.points, [](const measures::PointSummary& point) { return point.trials > 0; });
  const std::int64_t without = summary.unfinished->points - begun;
  return fmt::format(
      "unfinished: of the {} of {} trials that the run has finished so far{}", summary.unfinished->finished,
      summary.unfinished->trials,
      without > 0 ? fmt::format("; {} of {} points have none yet", without, summary.unfinished->points) : "");
}

SummaryDescription point_tables(const StudySummary& summary) {
  const bool levels = summary.features.open_loop;
  const PointDescription point = point_description(summary);
  const document::Description<LevelAtPoint> level = level_description(summary);
  const std::string legend = legend_of(levels ? level.items() : point.items());
  SummaryDescription tables;
  add_claims(tables, summary);
  tables.table({.key = "points",
                .heading = has_several_claims(summary) ? "by point" : "",  // after the table "by claim"
                .meaning = "the design points",
                .shown = levels ? Visibility::in_json : Visibility::everywhere},
               point, &SummaryResults::points);
  if (levels)
    tables.table(
        {.key = "levels", .meaning = "the torque levels of the points", .shown = Visibility::not_in_json},
        level, &SummaryResults::levels);
  tables.sentence(
      [legend](Summary s) { return nonfinite_lines(s) + points_shown(s) + (s.legend ? legend : ""); });
  add_repeatability(tables, summary);
  return tables;
}

document::AnswerDescription<SummaryResults> summary_description(const StudySummary& summary) {
  document::AnswerDescription<SummaryResults> answer{
      {.name = "summary",
       .meaning = "statistics of a study by design point; units and meanings are those of a rotary axis",
       .csv_table = summary.features.open_loop ? "levels" : "points"},
      {}};
  answer.items.headline(headline)
      .sentence(details)
      .value(document::in_data("name", "name of the study"), [](Summary s) { return s.summary.name; })
      .value(document::in_data("design", "how trials are drawn"), [](Summary s) { return s.summary.design; })
      .value(document::in_data("conservative_bounds", "whether the design makes bounds wider than needed"),
             [](Summary s) { return s.summary.features.spread_trials; })
      .value(document::in_data("confidence", "of all bounds", "1"),
             [](Summary s) { return s.summary.confidence; });
  if (summary.unfinished)
    answer.items.object(document::in_data("unfinished", "how far the run has come"), unfinished_description(),
                        [](Summary s) { return s.summary.unfinished; });
  answer.items.sentence(study_lines);
  if (!summary.features.open_loop)
    answer.items.object(document::in_data("best", "the point that the headline is of, and its competitors"),
                        chosen_description(), same_summary);
  answer.items.include(point_tables(summary), same_summary).sentence([](Summary s) -> std::string {
    return s.legend ? "" : "(zerocount summary --legend explains the columns)";
  });
  answer.items.object(
      {.key = "confirmation",
       .heading = "the chosen point run again, everything drawn anew: no bound needs a correction",
       .meaning = "new trials of the chosen point (--confirm)",
       .optional = true},
      confirmation_description(summary), confirmation_of);
  return answer;
}

document::AnswerType summary_type() {
  StudySummary plain, levels;
  levels.features.open_loop = true;
  StudySummary without_machines = full_study();
  without_machines.features.machines = false;
  without_machines.features.load_error = without_machines.features.motor_error = false;
  without_machines.repeatability->sources = &iso230::deviation_sources({});
  without_machines.question.parts.front().goal->machines.reset();
  document::AnswerType type = summary_description(full_study()).complete_type();
  for (const StudySummary* other : {&without_machines, &plain, &levels})
    type.items = united(std::move(type.items), summary_description(*other).items.items());
  return type;
}

document::Answer summary_answer(const StudySummary& summary, const SummaryForm& form) {
  return summary_description(summary).of(read_summary(summary, form));
}

std::vector<LevelAtPoint> SummaryResults::levels() const {
  std::vector<LevelAtPoint> levels;
  for (const DescribedPoint& point : points) {
    for (std::size_t level = 0; level < point.statistics().levels.size(); ++level)
      levels.push_back({point, level});
  }
  return levels;
}

DescribedPoint read_point(const summary::StudySummary& summary, std::int64_t point) {
  DescribedPoint reading{summary, point};
  const measures::PointSummary& statistics = reading.statistics();
  if (summary.question.goal() && statistics.trials > 0)
    reading.verdict = goal::verdict_on(summary.question, statistics);
  if (summary.question.worlds > 0) reading.worlds = summary::worlds_of_point(summary, point);
  if (const auto counts = summary.observed_counts.find(reading.label());
      counts != summary.observed_counts.end())
    reading.observed = summary::compare_observed(summary.question, statistics, counts->second);
  return reading;
}

SummaryResults read_summary(const summary::StudySummary& summary, const SummaryForm& form) {
  summary::require_consistent(summary);
  SummaryResults reading{summary, summary::choose_point(summary, form.chosen), {}, form.legend};
  const std::vector<std::int64_t> points =
      form.points.empty() ? summary::points_with_all_statistics(summary) : form.points;
  for (const std::int64_t point : points) {
    reading.points.push_back(read_point(summary, point));
    reading.points.back().marked = summary.points.size() > 1 && point == reading.chosen.point;
  }
  return reading;
}

}  // namespace zerocount::summary_answer
