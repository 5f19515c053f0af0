#include <cstddef>

#include <fmt/format.h>

#include "analysis/jerks/jerk_report.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"
#include "core/text/counted.hpp"

namespace zerocount::jerks {
namespace {

using document::AnswerDescription;
using document::bounded;
using document::Description;
using document::everywhere;
using document::in_data;

/// The jerks of a point, and the report that they are in.
struct PointReading {
  const JerkReport& report;
  const PointJerks& jerks;

  const JerkStatistics& statistics() const { return jerks.statistics; }
};

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
      .value(in_data("poisson_low", "lower bound of the rate of independent jerks (Garwood)", "1/s"),
             [](Rate r) { return r.poisson.low; })
      .value(in_data("poisson_high", "its upper bound", "1/s"), [](Rate r) { return r.poisson.high; })
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
                      [i](Intervals intervals) -> std::optional<document::Bounded> {
                        if (intervals.quantiles.empty()) return {};
                        const statistics::Quantile& quantile = intervals.quantiles[i];
                        return document::Bounded{quantile.value, quantile.low, quantile.high};
                      });
  }
  return description;
}

Description<TrendSummary> slowing_description() {
  return Description<TrendSummary>()
      .value(in_data("moves", "moves with two or more intervals that differ"), &TrendSummary::moves)
      .value(in_data("tested", "moves with enough intervals for a test of their own"), &TrendSummary::tested)
      .value(in_data("slowing", "tested moves whose jerks slow down"), &TrendSummary::slowing)
      .value(in_data("quickening", "tested moves whose jerks quicken"), &TrendSummary::quickening)
      .value(in_data("score", "Laplace's score of all moves; negative if jerks slow down", "1"),
             &TrendSummary::summed)
      .value(in_data("stouffer", "sum of the scores of the moves over the root of their number", "1"),
             &TrendSummary::stouffer)
      .value(in_data("p_value", "probability of such a score without a trend", "1"), &TrendSummary::p_slowing)
      .value(in_data("permutations", "permutations of the p-value; 0: its normal limit"),
             &TrendSummary::permutations);
}

Description<statistics::ClusteredProportion> proportion_description() {
  using Proportion = statistics::ClusteredProportion;
  return Description<Proportion>()
      .value(in_data("hits", "jerks that have the property"), &Proportion::hits)
      .value(in_data("jerks", "all jerks"), &Proportion::events)
      .value(in_data("proportion", "proportion of jerks, with Korn-Graubard bounds", "1"),
             [](const Proportion& p) { return bounded(p.value, p.korn_graubard); })
      .value(in_data("independent", "number of independent jerks that tell as much", "1"),
             &Proportion::effective_events);
}

Description<JerkMagnitudes> magnitude_description() {
  return Description<JerkMagnitudes>()
      .object(in_data("one_count", "jerks of one count"), proportion_description(),
              &JerkMagnitudes::one_count)
      .value(in_data("counts", "jerks of 1, 2, ... counts; the last: or more"), &JerkMagnitudes::counts)
      .value(in_data("mean", "mean of the largest |error|", "counts"), &JerkMagnitudes::mean)
      .value(in_data("max", "largest |error|", "counts"), &JerkMagnitudes::max)
      .value(in_data("median_duration", "median duration of a jerk", "s"), &JerkMagnitudes::median_duration)
      .value(in_data("longest_duration", "longest duration of a jerk", "s"),
             &JerkMagnitudes::longest_duration);
}

Description<CreepAgreement> agreement_description() {
  return Description<CreepAgreement>()
      .value(in_data("ended", "waits that ended with a jerk"), &CreepAgreement::ended)
      .value(in_data("predicted", "of these, predicted to within two samples and 1 %"),
             &CreepAgreement::predicted)
      .value(in_data("lasting", "waits without a jerk"), &CreepAgreement::lasting)
      .value(in_data("lasting_predicted", "of these, predicted to last as long"),
             &CreepAgreement::lasting_predicted)
      .value(in_data("median_deviation", "median deviation of the onset from its prediction", "s"),
             &CreepAgreement::median_deviation)
      .value(in_data("largest_deviation", "largest deviation of the onset", "s"),
             &CreepAgreement::largest_deviation);
}

Description<PointJerks> creep_description() {
  using Jerks = const PointJerks&;
  const auto applies = [](Jerks j) { return j.creep.not_applicable.empty(); };
  const auto waits =
      Description<CreepComparison>()
          .value(in_data("too_short", "excluded waits: not longer than a dwell"), &CreepComparison::too_short)
          .value(in_data("unsteady", "excluded waits: the torque was not constant, or the hook slid"),
                 &CreepComparison::unsteady);
  return Description<PointJerks>()
      .value(in_data("trials", "trials simulated again"), [](Jerks j) { return j.creep.trials; })
      .value(in_data("not_applicable", "reason why the closed form does not apply"),
             [applies](Jerks j) { return applies(j) ? std::nullopt : std::optional(j.creep.not_applicable); })
      .include(agreement_description(),
               [applies](Jerks j) { return applies(j) ? &j.creep_agreement : nullptr; })
      .include(waits, [applies](Jerks j) { return applies(j) ? &j.creep : nullptr; });
}

Description<JerkStatistics> statistics_description() {
  using Statistics = JerkStatistics;
  return Description<Statistics>()
      .value(in_data("trials", "trials of the design point"), &Statistics::trials)
      .value(in_data("moves", "moves of all trials"), &Statistics::moves)
      .value(in_data("arrived", "moves that arrived; only these can jerk"), &Statistics::arrived)
      .value(in_data("lost", "moves that became non-finite after arrival; excluded"), &Statistics::lost)
      .value(in_data("trials_with_jerks", "trials with at least one jerk"), &Statistics::with_jerks)
      .value(in_data("jerks", "jerks of all trials"), &Statistics::jerks)
      .table(everywhere("rates", "Rate of jerks since arrival", "rate by time"), rate_description(),
             &Statistics::rates)
      .object(everywhere("interval", "Intervals between the jerks of a move",
                         "times between the onsets of successive jerks of a move"),
              interval_description(), &Statistics::intervals)
      .object(in_data("slowing", "trend of the intervals between the jerks of a move"), slowing_description(),
              &Statistics::slowing)
      .object(in_data("agreement", "jerks in the direction of their holding torque"),
              proportion_description(), &Statistics::agreement)
      .object(in_data("magnitude", "largest |error| of the jerks"), magnitude_description(),
              &Statistics::magnitudes);
}

std::string counts_sentence(const PointReading& point) {
  const JerkStatistics& jerks = point.statistics();
  return fmt::format(
      "{} in {} of {}; {} of {} arrived{}", text::counted(jerks.jerks, "jerk"), jerks.with_jerks,
      text::counted(jerks.trials, "trial"), jerks.arrived, text::counted(jerks.moves, "move"),
      jerks.lost > 0 ? fmt::format(", {} of these failed numerically and are excluded", jerks.lost) : "");
}

/// Whether the p-value is the least that so many permutations can show.
bool is_least(const TrendSummary& slowing) {
  return slowing.permutations > 0 && slowing.p_slowing * static_cast<double>(slowing.permutations + 1) < 1.5;
}

std::string slowing_sentence(const PointReading& point) {
  const TrendSummary& slowing = point.statistics().slowing;
  if (slowing.moves == 0) return {};
  return fmt::format(
      "slowing down after the first jerk: score {:.2f} over {} moves (p {} {:.2g}); of {} moves with {} or "
      "more intervals, {} slow down and {} quicken ({} one-sided)",
      slowing.summed, slowing.moves, is_least(slowing) ? "≤" : "=", slowing.p_slowing, slowing.tested,
      min_trend_intervals, slowing.slowing, slowing.quickening, text::percent(point.report.confidence));
}

std::string proportion_text(const statistics::ClusteredProportion& proportion) {
  return fmt::format("{} of {}, bounds [{}] %", text::percentage(proportion.hits, proportion.events),
                     proportion.events,
                     text::percent_bounds(proportion.korn_graubard.low, proportion.korn_graubard.high));
}

std::string magnitude_sentences(const PointReading& point) {
  const JerkStatistics& jerks = point.statistics();
  if (jerks.jerks == 0) return {};
  return parameters::text_on(
      point.report.axis,
      fmt::format("in the direction of the holding $torque: {}\nof one count: {}; largest {} counts; median "
                  "duration {} s",
                  proportion_text(jerks.agreement), proportion_text(jerks.magnitudes.one_count),
                  jerks.magnitudes.max, text::short_number(jerks.magnitudes.median_duration)));
}

std::string creep_sentence(const PointReading& point) {
  const CreepComparison& creep = point.jerks.creep;
  const CreepAgreement& agreement = point.jerks.creep_agreement;
  if (!creep.not_applicable.empty())
    return fmt::format("creep at constant torque: does not apply: {}", creep.not_applicable);
  if (creep.trials == 0) return {};
  return fmt::format(
      "creep at constant torque: in {} trials simulated again it predicts {} of {} jerks, and {} of {} waits "
      "without one{}",
      creep.trials, agreement.predicted, agreement.ended, agreement.lasting_predicted, agreement.lasting,
      agreement.ended > 0 ? fmt::format("; median deviation {:.2g} ms", 1e3 * agreement.median_deviation)
                          : "");
}

Description<PointReading> point_description() {
  using Point = const PointReading&;
  return Description<PointReading>()
      .title([](Point p) { return text::printable(p.jerks.label); })
      .sentence(counts_sentence)
      .sentence(slowing_sentence)
      .sentence(magnitude_sentences)
      .sentence(creep_sentence)
      .value(in_data("point", "number of the design point"), [](Point p) { return p.jerks.point; })
      .value(in_data("label", "label of the design point, with the condition"),
             [](Point p) { return p.jerks.label; })
      .value({.key = "condition",
              .meaning = "condition that the trials are under",
              .shown = document::Shown::in_json,
              .optional = true},
             [](Point p) { return p.jerks.condition; })
      .include(statistics_description(), &PointReading::statistics)
      .object(
          in_data("creep", "comparison with the closed form of creep at constant torque"),
          creep_description(), [](Point p) -> const auto& { return p.jerks; });
}

std::vector<PointReading> readings_of(const JerkReport& report) {
  std::vector<PointReading> readings;
  for (const PointJerks& jerks : report.points) readings.push_back({report, jerks});
  return readings;
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
    "exposure: time in which a jerk could have begun, summed over all moves\n"
    "rate: jerks per exposure; Garwood's bounds, widened where the jerks of a trial vary more than "
    "independent ones (dispersion above 1)\n"
    "score: Laplace's statistic of the intervals against their permutations within each move: mean 0 and "
    "standard deviation 1 without a trend, whatever the distribution of the intervals; negative if jerks "
    "slow down. p: proportion of permutations in which they would seem to slow down as much. A trend does "
    "not tell its cause: creep, or noise that moves the rotor to where it is quieter\n"
    "creep at constant torque: onset of the next jerk, predicted from the state a dwell after the error "
    "became 0";

}  // namespace

AnswerDescription<JerkReport> jerk_answer() {
  AnswerDescription<JerkReport> answer{
      {.name = "jerks",
       .meaning = "rate, intervals and trend of the jerks of each design point",
       .csv_table = "points.rates"},
      {}};
  answer.items.headline(headline)
      .value(in_data("name", "name of the study"), &JerkReport::name)
      .value({.key = "confidence",
              .heading = "confidence of all bounds",
              .unit = "1",
              .notation = document::Notation::given_percent},
             &JerkReport::confidence)
      .sections({.key = "points", .meaning = "the design points"}, point_description(), readings_of)
      .title([](const JerkReport&) { return "Legend"; })
      .sentence([](const JerkReport&) { return legend; });
  return answer;
}

}  // namespace zerocount::jerks
