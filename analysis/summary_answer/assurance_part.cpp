#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "analysis/statistics/clusters/tolerance.hpp"
#include "analysis/summary_answer/parts.hpp"
#include "analysis/text/percent.hpp"

namespace zerocount::summary_answer {
namespace {

using document::Shown;
using Point = const PointReading&;

bool makes_claims(const summary::StudySummary& summary) {
  return !summary.features.open_loop && !summary.features.dependent_trials;
}

bool has_trials(Point p) {
  return p.statistics().trials > 0;
}

/// With one trial per rig, nothing is known of the moves of a rig.
bool shows_rigs(const summary::StudySummary& summary) {
  return summary.features.rigs && !summary.points.empty() &&
         summary.points.front().trials > summary.points.front().rigs.n;
}

double success_at_least(Point p) {
  return p.statistics().claim.success_at_least;
}
double zero_at_least(Point p) {
  return p.statistics().rigs.tolerance.zero_at_least;
}

std::string claim_statement(Point p) {
  const measures::PointSummary& point = p.statistics();
  const std::string settling = statistics::settling_sentence(point.settles_within);
  return (point.worlds ? "on average over the worlds: " : "") + statistics::claim_sentence(point.claim) +
         (settling.empty() ? "" : "; " + settling);
}

/// "95", "99", "99_9".
std::string content_name(double content) {
  std::string name = fmt::format("{:.6g}", 100.0 * content);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

auto arrival_of(std::size_t content) {
  return [content](Point p) { return p.statistics().settles_within.at(content).within; };
}

PointDescription assurance_object(bool on_rigs) {
  using Limit = statistics::ToleranceLimit;
  document::Description<Limit> limit;
  limit.value({.key = "content", .meaning = "proportion of axes", .unit = "1"}, &Limit::content)
      .value({.key = "within", .meaning = "time in which at least these settle", .unit = "s"},
             &Limit::within);
  PointDescription object;
  object
      .value({.key = "success_at_least",
              .meaning = "proportion of axes (with rigs: of trials) that succeed at least",
              .unit = "1",
              .column = "success_at_least"},
             success_at_least)
      .value({.key = "failure_at_most",
              .meaning = "proportion of axes (with rigs: of trials) that fail at most",
              .unit = "1",
              .column = "failure_at_most"},
             [](Point p) { return p.statistics().claim.failure_at_most; })
      .value({.key = "rule_of_three",
              .meaning = "approximation of failure_at_most without a failure; null where there was one",
              .unit = "1",
              .shown = Shown::in_json},
             [](Point p) { return statistics::rule_of_three(p.statistics().claim); })
      .table({.key = "settling_time", .meaning = "upper tolerance limits", .shown = Shown::in_json}, limit,
             [](Point p) { return p.statistics().settles_within; });
  for (std::size_t i = 0; i < std::size(statistics::tolerance_contents); ++i) {
    const double content = statistics::tolerance_contents[i];
    object.value({.key = "settling_within_" + content_name(content),
                  .meaning = fmt::format("time in which at least {} of axes settle", text::percent(content)),
                  .unit = "s",
                  .shown = Shown::in_csv,
                  .column = "settling_within_" + content_name(content)},
                 arrival_of(i));
  }
  object.value({.key = "statement", .meaning = "the same in words", .shown = Shown::in_json},
               claim_statement);
  if (!on_rigs) return object;
  PointDescription rigs;
  rigs.value({.key = "content", .meaning = "proportion of rigs", .unit = "1", .shown = Shown::in_json},
             [](Point p) { return p.statistics().rigs.tolerance.content; })
      .value({.key = "zero_at_least",
              .meaning = "proportion of moves in which at least these rigs hold zero at least",
              .unit = "1",
              .column = "rigs_zero_at_least"},
             zero_at_least)
      .value({.key = "statement", .meaning = "the same in words", .shown = Shown::in_json},
             [](Point p) { return statistics::tolerance_sentence(p.statistics().rigs.tolerance); });
  return object.object({.key = "rigs", .meaning = "what is shown of single rigs"}, rigs,
                       [](Point p) { return p.statistics().rigs.tolerance.min_rigs > 0 ? &p : nullptr; });
}

std::string title_of_claims(const summary::StudySummary& summary) {
  return fmt::format("shown with {} confidence of all axes that the manifest describes{}",
                     text::percent(summary.confidence),
                     !summary.conditions.empty()   ? ", on average over its conditions: under some it is less"
                     : summary.question.worlds > 0 ? ", on average over its worlds: in some worlds it is less"
                                                   : "");
}

std::string note_on_claims(const SummaryReading& s) {
  if (std::ranges::none_of(s.points, has_trials)) return {};
  return fmt::format(
      "bounds of one side each (Wilks; {}). success: of trials{}; arrive by: all moves of a trial; a "
      "tolerance limit is later than the quantile of the trials at hand, and – where these are too few, or "
      "too many never arrive",
      s.summary.features.rigs ? "Korn and Graubard" : "Clopper and Pearson",
      shows_rigs(s.summary) ? "; of rigs: their moves that end at zero error" : "");
}

}  // namespace

void add_assurance(PointDescription& point, const summary::StudySummary& summary) {
  if (!makes_claims(summary)) return;
  point.object({.key = "assurance",
                .meaning = "what the trials show of all axes that the manifest describes",
                .shown = Shown::in_data},
               assurance_object(summary.features.rigs), [](Point p) -> const PointReading& { return p; });
}

void add_assurance(SummaryDescription& answer, const summary::StudySummary& summary) {
  if (!makes_claims(summary)) return;
  PointDescription columns = labelled_points(summary);
  columns.value({.heading = "success ≥", .numeric = true},
                [](Point p) { return text::percent_at_least(success_at_least(p)); });
  if (shows_rigs(summary))
    columns.value({.heading = "90 % of rigs ≥", .numeric = true}, [](Point p) {
      return std::isnan(zero_at_least(p)) ? "–" : text::percent_at_least(zero_at_least(p));
    });
  for (std::size_t i = 0; i < std::size(statistics::tolerance_contents); ++i)
    columns.value({.heading = fmt::format("{} arrive by", text::percent(statistics::tolerance_contents[i])),
                   .unit = "s"},
                  arrival_of(i));
  answer
      .table({.heading = title_of_claims(summary), .shown = Shown::to_people}, columns,
             [](const SummaryReading& s) { return points_that(s, has_trials); })
      .sentence(note_on_claims);
}

}  // namespace zerocount::summary_answer
