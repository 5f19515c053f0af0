#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/jerks/creep_comparison.hpp"
#include "analysis/trials/jerks/jerk_statistics.hpp"
#include "core/text/text.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::jerks {
namespace {

/// The reported jerk data of a design point in one setting.
/// @param file the trials in this setting
/// @param creep_trials number of trials that are simulated again for the comparison with the closed form of
/// creep
PointJerks jerks_at(const reading::AllTrialsFile& file, const measures::PointInSetting& place,
                    double confidence, std::int64_t creep_trials) {
  const study::Study& study = file.study();
  PointJerks jerks{place,
                   jerk_statistics(file, study, place.point, confidence),
                   compare_with_creep(study, place.point, creep_trials),
                   {}};
  const double sample_rate = study::study_trial(study, place.point, 0).parameters.controller.sample_rate;
  jerks.creep_agreement = agreement_of(jerks.creep, 1.0 / sample_rate);
  return jerks;
}

using document::bounded;
using document::Description;
using document::everywhere;

/// An item of the answer that is a single value. People see its meaning in place of a heading.
/// @param key name in JSON
document::Item fact(const char* key, const char* meaning, const char* unit = "") {
  return everywhere(key, meaning, meaning, unit);
}

Description<JerkRate> rate_description() {
  using Rate = const JerkRate&;
  return Description<JerkRate>()
      .value(everywhere("from", "from", "start of the range, since arrival", "s"), &JerkRate::from)
      .value(everywhere("to", "to", "end of the range, since arrival; belongs to the next", "s"),
             &JerkRate::to)
      .value(everywhere("moves", "moves", "moves in which a jerk could have begun in the range"),
             &JerkRate::moves)
      .value(everywhere("exposure", "exposure",
                        "time in which a jerk could have begun, summed over all moves", "s"),
             &JerkRate::exposure)
      .value(everywhere("jerks", "jerks", "jerks that began in the range"), &JerkRate::jerks)
      .value(everywhere("rate", "rate",
                        "jerks per exposure, with Garwood's bounds, widened by the dispersion", "1/s"),
             [](Rate r) { return bounded(r.rate, r.bounds); })
      .value(
          document::in_data("poisson_low", "lower bound of the rate of independent jerks (Garwood)", "1/s"),
          [](Rate r) { return r.poisson.low; })
      .value(document::in_data("poisson_high", "its upper bound", "1/s"),
             [](Rate r) { return r.poisson.high; })
      .value(everywhere("dispersion", "dispersion",
                        "variance of the jerks of a trial, divided by that of independent ones", "1"),
             &JerkRate::dispersion);
}

Description<JerkIntervals> interval_description() {
  using Intervals = const JerkIntervals&;
  Description<JerkIntervals> description;
  description.value(everywhere("n", "number", "intervals between the jerks of a move"), &JerkIntervals::n)
      .value(everywhere("mean", "mean", "mean interval", "s"), &JerkIntervals::mean);
  for (std::size_t i = 0; i < jerk_interval_probabilities.size(); ++i) {
    const double percent = 100.0 * jerk_interval_probabilities[i];
    description.value({.key = fmt::format("p{:02.0f}", percent),
                       .heading = fmt::format("{:.0f} % below", percent),
                       .meaning = fmt::format("quantile of {:.0f} % of the intervals", percent),
                       .unit = "s"},
                      [i](Intervals intervals) { return intervals.quantiles[i]; });
  }
  return description;
}

Description<TrendSummary> slowing_description() {
  return Description<TrendSummary>()
      .value(fact("moves", "moves with two or more intervals that differ"), &TrendSummary::moves)
      .value(fact("tested", "moves with 4 or more intervals, each tested (95 %, one-sided)"),
             &TrendSummary::tested)
      .value(fact("slowing", "tested moves whose jerks slow down"), &TrendSummary::slowing)
      .value(fact("quickening", "tested moves whose jerks quicken"), &TrendSummary::quickening)
      .value(fact("score", "Laplace's score of all moves; negative if jerks slow down", "1"),
             &TrendSummary::summed)
      .value(fact("stouffer", "sum of the scores of the moves over the root of their number", "1"),
             &TrendSummary::stouffer)
      .value(fact("p_value", "probability of such a score without a trend", "1"), &TrendSummary::p_slowing)
      .shown_as([](const TrendSummary& trend) -> std::optional<std::string> {
        if (std::isnan(trend.p_slowing)) return {};
        const bool least =
            trend.permutations > 0 && trend.p_slowing * static_cast<double>(trend.permutations + 1) < 1.5;
        return fmt::format("{}{:.2g}", least ? "at most " : "", trend.p_slowing);
      })
      .value(document::in_data("permutations", "permutations of the p-value; 0: its normal limit"),
             &TrendSummary::permutations);
}

Description<statistics::ClusteredProportion> proportion_description() {
  using Proportion = statistics::ClusteredProportion;
  return Description<Proportion>()
      .value(fact("hits", "jerks of this kind"), &Proportion::hits)
      .value(document::in_data("jerks", "all jerks"), &Proportion::events)
      .value({.key = "proportion",
              .heading = "proportion of all jerks [Korn-Graubard bounds]",
              .meaning = "proportion of jerks, with Korn-Graubard bounds",
              .unit = "1",
              .notation = document::Notation::percent},
             [](const Proportion& p) { return bounded(p.value, p.korn_graubard); })
      .value(document::in_data("independent", "number of independent jerks that give as narrow bounds", "1"),
             &Proportion::effective_events);
}

Description<JerkMagnitudes> magnitude_description() {
  return Description<JerkMagnitudes>()
      .value(fact("counts", "jerks of 1, of 2, of 3 or more counts"), &JerkMagnitudes::counts)
      .value(fact("mean", "mean of the largest |error|", "counts"), &JerkMagnitudes::mean)
      .value(fact("max", "largest |error|", "counts"), &JerkMagnitudes::max)
      .value(fact("median_duration", "median duration of a jerk", "s"), &JerkMagnitudes::median_duration)
      .value(fact("longest_duration", "longest duration of a jerk", "s"), &JerkMagnitudes::longest_duration)
      .object(everywhere("one_count", "Of one count", "jerks of one count"), proportion_description(),
              &JerkMagnitudes::one_count);
}

Description<CreepAgreement> agreement_description() {
  return Description<CreepAgreement>()
      .value(fact("ended", "waits that ended with a jerk"), &CreepAgreement::ended)
      .value(fact("predicted", "ended waits that are predicted to within two samples and 1 %"),
             &CreepAgreement::predicted)
      .value(fact("lasting", "waits without a jerk"), &CreepAgreement::lasting)
      .value(fact("lasting_predicted", "waits without a jerk that are predicted to last as long"),
             &CreepAgreement::lasting_predicted)
      .value(fact("median_deviation", "median deviation of the onset from its prediction", "s"),
             &CreepAgreement::median_deviation)
      .value(fact("largest_deviation", "largest deviation of the onset", "s"),
             &CreepAgreement::largest_deviation);
}

Description<PointJerks> creep_description() {
  using Jerks = const PointJerks&;
  const auto applies = [](Jerks j) { return j.creep.not_applicable.empty(); };
  const auto waits =
      Description<CreepComparison>()
          .value(fact("too_short", "excluded waits: not longer than a dwell"), &CreepComparison::too_short)
          .value(fact("unsteady", "excluded waits: the torque was not constant, or the hook slid"),
                 &CreepComparison::unsteady);
  return Description<PointJerks>()
      .value(fact("trials", "trials simulated again"), [](Jerks j) { return j.creep.trials; })
      .value(fact("not_applicable", "reason why the closed form does not apply"),
             [applies](Jerks j) { return applies(j) ? std::nullopt : std::optional(j.creep.not_applicable); })
      .include(agreement_description(),
               [applies](Jerks j) { return applies(j) ? &j.creep_agreement : nullptr; })
      .include(waits, [applies](Jerks j) { return applies(j) ? &j.creep : nullptr; });
}

Description<JerkStatistics> statistics_description() {
  using Statistics = JerkStatistics;
  const auto has_jerks = [](const Statistics& s) { return s.jerks > 0; };
  return Description<Statistics>()
      .value(fact("trials", "trials of the design point"), &Statistics::trials)
      .value(fact("moves", "moves of all trials"), &Statistics::moves)
      .value(fact("arrived", "moves that arrived; only these can jerk"), &Statistics::arrived)
      .value(fact("lost", "moves that became non-finite after arrival; excluded"), &Statistics::lost)
      .value(fact("trials_with_jerks", "trials with at least one jerk"), &Statistics::with_jerks)
      .value(fact("jerks", "jerks of all trials"), &Statistics::jerks)
      .table(everywhere("rates", "Rate of jerks since arrival", "rate by time"), rate_description(),
             &Statistics::rates)
      .object(everywhere("interval", "Intervals between the jerks of a move",
                         "times between the onsets of successive jerks of a move"),
              interval_description(), &Statistics::intervals)
      .shown_where([](const Statistics& s) { return s.intervals.n > 0; })
      .object(everywhere("slowing", "Trend of the intervals",
                         "trend of the intervals between the jerks of a move"),
              slowing_description(), &Statistics::slowing)
      .shown_where([](const Statistics& s) { return s.slowing.moves > 0; })
      .object(everywhere("agreement", "In the direction of the holding torque",
                         "jerks in the direction of their holding torque"),
              proportion_description(), &Statistics::agreement)
      .shown_where(has_jerks)
      .object(everywhere("magnitude", "Magnitude", "largest |error| of the jerks"), magnitude_description(),
              &Statistics::magnitudes)
      .shown_where(has_jerks);
}

Description<PointJerks> point_description() {
  return Description<PointJerks>()
      .title([](const PointJerks& p) { return text::printable(p.label); })
      .include(measures::name_of_point(),
               [](const PointJerks& p) -> const measures::PointInSetting& { return p; })
      .include(statistics_description(), &PointJerks::statistics)
      .object(everywhere("creep", "Creep at constant torque",
                         "comparison with the closed form of creep at constant torque"),
              creep_description(), [](const PointJerks& p) -> const PointJerks& { return p; });
}

std::string headline(const JerkReport& report) {
  if (!any_arrival(report))
    return fmt::format("{}: no move arrived, so there are no jerks", text::printable(report.name));
  JerkStatistics all;
  for (const PointJerks& point : report.points) {
    all.jerks += point.statistics.jerks;
    all.with_jerks += point.statistics.with_jerks;
    all.trials += point.statistics.trials;
  }
  return fmt::format("{}: {} in {} of {}", text::printable(report.name), text::counted(all.jerks, "jerk"),
                     all.with_jerks, text::counted(all.trials, "trial"));
}

constexpr const char* legend =
    "dispersion: above 1 where the jerks of a trial vary more than independent ones; the bounds of the rate "
    "are widened by it\n"
    "trend: scores have mean 0 and standard deviation 1 without one, whatever the distribution of the "
    "intervals. A trend does not tell its cause: creep, or noise that moves the rotor to where it is quieter";

}  // namespace

JerkReport jerk_report(const reading::AllTrialsFile& file, std::vector<std::int64_t> points,
                       double confidence, std::int64_t creep_trials) {
  const auto jerks = [&](const reading::AllTrialsFile& one, const measures::PointInSetting& place) {
    return jerks_at(one, place, confidence, creep_trials);
  };
  return {file.study().name, confidence, measures::at_points<PointJerks>(file, std::move(points), jerks)};
}

bool any_arrival(const JerkReport& report) {
  return std::any_of(report.points.begin(), report.points.end(), [](const PointJerks& point) {
    return point.statistics.arrived > point.statistics.lost;
  });
}

document::AnswerDescription<JerkReport> jerk_answer() {
  document::AnswerDescription<JerkReport> answer{
      {.name = "jerks",
       .meaning = "rate, intervals and trend of the jerks of each design point",
       .csv_table = "points.rates"},
      {}};
  answer.items.headline(headline)
      .value(document::in_data("name", "name of the study"), &JerkReport::name)
      .value({.key = "confidence",
              .heading = "confidence of all bounds",
              .unit = "1",
              .notation = document::Notation::given_percent},
             &JerkReport::confidence)
      .sections({.key = "points", .meaning = "the design points"}, point_description(), &JerkReport::points)
      .title([](const JerkReport&) { return "Legend"; })
      .sentence([](const JerkReport&) { return legend; });
  return answer;
}

}  // namespace zerocount::jerks
