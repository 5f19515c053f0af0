#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/tolerance.hpp"
#include "analysis/basis/statistics/mean_bounds.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "analysis/trials/measures/undecided_moves.hpp"
#include "analysis/trials/summary_answer/parts.hpp"

/// Parts of the summary on the trials of a design point beyond their statistics. Each part is an object of
/// the point in data, and a table below that of the points for people.
namespace zerocount::summary_answer {
namespace {

using document::Visibility;
using Point = const DescribedPoint&;

const DescribedPoint& same_point(Point p) {
  return p;
}

/// The sentence on undecided moves, with a remark if the converter clipped the torque, because clipping can
/// also keep moves from their targets. Empty without undecided moves.
std::string undecided_text(Point p) {
  if (!measures::any_undecided(p.statistics().undecided)) return {};
  const std::int64_t clipped = p.statistics().of(&trial::MoveOutcome::saturated).trials;
  return measures::undecided_sentence(p.statistics().undecided) +
         (clipped == 0
              ? ""
              : fmt::format("; the converter clipped in {} of {} trials", clipped, p.statistics().trials));
}

std::string simulated_text(Point p) {
  const statistics::Successes& trials = p.observed->simulated;
  if (trials.trials == 0) return "–";
  const std::int64_t machines = p.statistics().machines.n;
  return fmt::format("{} of {}{}{}", text::percentage(trials.successes, trials.trials), trials.trials,
                     machines > 0 ? fmt::format(" on {} machines", machines) : "",
                     p.summary.question.worlds > 0 ? ", on average over the worlds" : "");
}

std::string observed_statement(Point p) {
  return summary::statement_on(p.statistics(), *p.observed, p.summary.confidence);
}

statistics::ConfidenceInterval stopped_bounds(Point p, double confidence) {
  const measures::PointSummary& point = p.statistics();
  return statistics::confidence_sequence_bounds(point.outcomes.zero_count, point.judged, confidence);
}

/// Half the width of the success rate's bounds at the confidence of the stopping rule.
double halfwidth(Point p) {
  const statistics::ConfidenceInterval judged = stopped_bounds(p, p.summary.stop->confidence);
  return 0.5 * (judged.high - judged.low);
}

bool is_reached(Point p) {
  return halfwidth(p) <= p.summary.stop->success_rate_halfwidth;
}

std::string note_on_stopping(const summary::StudySummary& summary) {
  const std::int64_t machines = summary.points.empty() ? 0 : summary.points.front().machines.n;
  return fmt::format(
      "outcomes decided the number of trials, after every {} at each point; all other bounds are those of a "
      "number fixed beforehand{}",
      summary.stop->block,
      machines == 0
          ? ""
          : fmt::format("\nthese bounds hold for the mean over the {} machines of the study, which more "
                        "trials narrow; those over all machines are in the table above, and more machines "
                        "narrow them",
                        machines));
}

/// Whether tables show results by machine: machines have several trials each. With one trial per machine,
/// little is known of a single machine.
bool shows_machines(const summary::StudySummary& summary) {
  return summary.features.machines && !summary.points.empty() &&
         summary.points.front().trials > summary.points.front().machines.n;
}

std::string shown_at_least(double proportion) {
  return std::isnan(proportion) ? "–" : text::percent_at_least(proportion);
}

std::string assurance_statement(Point p) {
  const measures::PointSummary& point = p.statistics();
  const std::string settling = statistics::settling_sentence(point.settles_within);
  return (p.summary.question.worlds > 0 ? "on average over the worlds: " : "") +
         statistics::claim_sentence(point.claim, goal::success_predicate(p.summary.question)) +
         (settling.empty() ? "" : "; " + settling);
}

std::string title_of_assurance(const summary::StudySummary& summary) {
  return fmt::format(
      "shown with {} confidence of all axes that the manifest describes{}", text::percent(summary.confidence),
      !summary.question.settings.empty() ? ", on average over its conditions: under some it is less"
      : summary.question.worlds > 0      ? ", on average over its worlds: in some worlds it is less"
                                         : "");
}

std::string note_on_assurance(const summary::StudySummary& summary) {
  return fmt::format(
      "bounds of one side each (Wilks; {}). success: {}of trials{}; arrive by: all moves of a trial; a "
      "tolerance limit is later than the quantile of the trials at hand, and – where these are too few, or "
      "too many never arrive",
      summary.features.machines ? "Korn and Graubard" : "Clopper and Pearson",
      summary.question.of_mass.empty() ? "" : fmt::format("zero counts{}, ", summary.question.of_mass),
      shows_machines(summary) ? "; of machines: their moves that end at zero error" : "");
}

/// JSON key of a tolerance limit of the settling time, by its proportion of machines: "settling_within_95",
/// "settling_within_99_9".
std::string key_of_limit(double content) {
  std::string name = fmt::format("settling_within_{:.6g}", 100.0 * content);
  std::ranges::replace(name, '.', '_');
  return name;
}

PointDescription assurance_of_machines(const summary::StudySummary& summary) {
  return PointDescription()
      .value(in_json("content", "proportion of machines", "1"),
             [](Point p) { return p.statistics().machines.tolerance.content; })
      .value({.key = "zero_at_least",
              .heading = shows_machines(summary) ? "90 % of machines ≥" : "",
              .meaning = "proportion of moves in which at least these machines hold zero at least",
              .unit = "1",
              .numeric = true,
              .column = "machines_zero_at_least"},
             [](Point p) { return p.statistics().machines.tolerance.zero_at_least; })
      .shown_as([](Point p) { return shown_at_least(p.statistics().machines.tolerance.zero_at_least); })
      .value(in_json("statement", "the same in words"),
             [](Point p) { return statistics::tolerance_sentence(p.statistics().machines.tolerance); });
}

}  // namespace

void add_undecided(PointDescription& point, const summary::StudySummary& summary) {
  if (summary.features.open_loop) return;
  PointDescription object;
  object.value(in_json("moves", "moves of all trials"),
               [](Point p) { return p.statistics().undecided.moves; });
  for (const measures::UndecidedCount& each : measures::undecided_counts)
    object.value({.key = each.name, .meaning = each.long_name, .column = each.column},
                 [count = each.count](Point p) { return p.statistics().undecided.*count; });
  object
      .value({.key = "hold_at_least",
              .meaning = "hold that most of the undecided moves are expected to need",
              .unit = "s",
              .column = "hold_at_least"},
             [](Point p) { return p.statistics().undecided.advised_hold; })
      .sentence(undecided_text);
  point.object({.key = "undecided",
                .meaning = "moves that are neither stable nor shown unstable",
                .own_table = "undecided moves",
                .note = std::string(measures::undecided_meaning)},
               object, same_point);
}

void add_observed(PointDescription& point, const summary::StudySummary& summary) {
  if (summary.observed_counts.empty()) return;
  const std::string method = fmt::format(
      "A trial succeeds if all its moves {}. {}, each point by itself: it differs where p ≤ {}. Consistent "
      "counts do not prove the simulation right: they only do not contradict it",
      goal::doing_text(summary.question),
      summary.features.machines
          ? "rank of the real machine among the simulated ones, by as many trials of each"
          : "Fisher's exact test",
      text::percent(1.0 - summary.confidence));
  PointDescription object;
  object
      .value({.key = "successes",
              .heading = "real machine",
              .meaning = "trials that succeeded on the real machine",
              .column = "observed_successes"},
             [](Point p) { return p.observed->counts.successes; })
      .shown_as([](Point p) {
        return fmt::format("{} of {}", p.observed->counts.successes, p.observed->counts.of);
      })
      .value({.key = "of", .meaning = "trials on the real machine", .column = "observed_trials"},
             [](Point p) { return p.observed->counts.of; })
      .value(in_json("simulated_successes",
                     "simulated trials that do what the study asks: its goals, or zero counts"),
             [](Point p) { return p.observed->simulated.successes; })
      .value(in_json("simulated_of", "simulated trials"),
             [](Point p) { return p.observed->simulated.trials; })
      .value({.heading = "simulated"}, simulated_text)
      .value({.key = "p_value",
              .meaning = "two-sided p-value; null where it cannot be tested",
              .unit = "1",
              .column = "observed_p_value"},
             [](Point p) { return p.observed->test ? p.observed->test->p : statistics::unknown; })
      .value(in_json("lowest_p_value", "lowest p-value that any result can have", "1"),
             [](Point p) { return p.observed->test ? p.observed->test->lowest_p : statistics::unknown; })
      .value({.key = "verdict",
              .meaning = "whether the simulation and the real machine are consistent",
              .shown = Visibility::in_json,
              .words = {std::begin(summary::observed_verdicts), std::end(summary::observed_verdicts)}},
             [](Point p) { return summary::verdict_on(*p.observed, p.summary.confidence); })
      .value({.key = "statement",
              .heading = "the simulation and the machine",
              .meaning = "the verdict in words",
              .shown = Visibility::not_in_csv},
             observed_statement);
  point.object({.key = "observed_counts",
                .meaning = "trials on the real machine against those simulated",
                .own_table = "observed on the real machine",
                .note = method},
               object, [](Point p) { return p.observed ? &p : nullptr; });
}

void add_stopping(PointDescription& point, const summary::StudySummary& summary) {
  if (!summary.stop) return;
  const auto bound = [](const std::string& key, const char* side, const std::string& heading) {
    return document::Item{
        .key = key,
        .heading = heading,
        .meaning = std::string(side) + " bound of the success rate that holds however often one looks",
        .unit = "1",
        .column = "stopped_" + key};
  };
  document::Item half = in_json("halfwidth", "half the width of the bounds that the rule is about", "1");
  half.heading = fmt::format("asked for: ± {:.4g} %, came to", 100.0 * summary.stop->success_rate_halfwidth);
  half.shown = Visibility::not_in_csv;
  PointDescription object;
  object
      .value(bound("success_rate_low", "lower",
                   bounds_head(summary) + " of zero-count, however often one looks (%)"),
             [](Point p) { return stopped_bounds(p, p.summary.confidence).low; })
      .shown_as([](Point p) {
        const statistics::ConfidenceInterval here = stopped_bounds(p, p.summary.confidence);
        return fmt::format("[{}]", text::percent_bounds(here.low, here.high, 2));
      })
      .value(bound("success_rate_high", "upper", ""),
             [](Point p) { return stopped_bounds(p, p.summary.confidence).high; })
      .value(in_json("confidence", "confidence of these bounds", "1"),
             [](Point p) { return p.summary.confidence; })
      .value(std::move(half), halfwidth)
      .shown_as([](Point p) {
        return fmt::format("± {} %{}", text::rounded_up(100.0 * halfwidth(p), 2),
                           is_reached(p) ? "" : ": not reached");
      })
      .value(in_json("halfwidth_asked", "half-width that the rule asks for", "1"),
             [](Point p) { return p.summary.stop->success_rate_halfwidth; })
      .value(in_json("halfwidth_confidence", "confidence of the bounds that the rule is about", "1"),
             [](Point p) { return p.summary.stop->confidence; })
      .value(in_json("reached", "whether the bounds are as narrow as asked for"), is_reached);
  if (summary.features.machines)
    object.value(in_json("of_machines", "machines of the study, over whose mean the bounds are"),
                 [](Point p) { return p.statistics().machines.n; });
  point.object({.key = "stopping",
                .meaning = "what the rule that ended the study asked for, and what was reached",
                .own_table = "bounds of the stopping rule",
                .note = note_on_stopping(summary)},
               object, same_point);
}

void add_assurance(PointDescription& point, const summary::StudySummary& summary) {
  if (summary.features.open_loop || summary.features.dependent_trials) return;
  using Limit = statistics::ToleranceLimit;
  document::Description<Limit> limit;
  limit.value(document::in_data("content", "proportion of axes", "1"), &Limit::content)
      .value(document::in_data("within", "time in which at least these arrive", "s"), &Limit::within);
  PointDescription object;
  object
      .value({.key = "success_at_least",
              .heading = "success ≥",
              .meaning = "proportion of axes (with machines: of trials) that succeed at least",
              .unit = "1",
              .numeric = true,
              .column = "success_at_least"},
             [](Point p) { return p.statistics().claim.success_at_least; })
      .shown_as([](Point p) { return shown_at_least(p.statistics().claim.success_at_least); })
      .value({.key = "failure_at_most",
              .meaning = "proportion of axes (with machines: of trials) that fail at most",
              .unit = "1",
              .column = "failure_at_most"},
             [](Point p) { return p.statistics().claim.failure_at_most; })
      .value(in_json("rule_of_three",
                     "approximation of failure_at_most without a failure; null where there was one", "1"),
             [](Point p) { return statistics::rule_of_three(p.statistics().claim); })
      .table(in_json("arrival_time", "upper tolerance limits"), limit,
             [](Point p) { return p.statistics().settles_within; });
  for (std::size_t i = 0; i < std::size(statistics::tolerance_contents); ++i) {
    const double content = statistics::tolerance_contents[i];
    const std::string axes = text::percent(content);
    object.value({.key = key_of_limit(content),
                  .heading = axes + " arrive by",
                  .meaning = fmt::format("time in which at least {} of axes arrive", axes),
                  .unit = "s",
                  .shown = Visibility::not_in_json,
                  .column = key_of_limit(content)},
                 [i](Point p) { return p.statistics().settles_within.at(i).within; });
  }
  object.value(in_json("statement", "the same in words"), assurance_statement);
  if (summary.features.machines)
    object.object({.key = "machines", .meaning = "what is shown of single machines"},
                  assurance_of_machines(summary),
                  [](Point p) { return p.statistics().machines.tolerance.min_machines > 0 ? &p : nullptr; });
  point.object({.key = "assurance",
                .meaning = "what the trials show of all axes that the manifest describes",
                .own_table = title_of_assurance(summary),
                .note = note_on_assurance(summary)},
               object, same_point);
}

}  // namespace zerocount::summary_answer
