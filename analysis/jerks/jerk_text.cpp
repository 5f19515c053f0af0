#include <cstddef>

#include <fmt/format.h>

#include "analysis/jerks/jerk_report.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::jerks {
namespace {

std::string bounds_text(const statistics::ConfidenceInterval& bounds) {
  return fmt::format("[{}, {}]", text::short_number(bounds.low), text::short_number(bounds.high));
}

std::string rate_table(const std::vector<JerkRate>& rates, const std::string& level) {
  std::vector<std::vector<std::string>> cells{
      {"since arrival (s)", "moves", "watched (s)", "jerks", "rate (1/s)", level + " bounds", "dispersion"}};
  for (const JerkRate& rate : rates) {
    cells.push_back({fmt::format("{} to {}", text::short_number(rate.from), text::short_number(rate.to)),
                     std::to_string(rate.moves), text::short_number(rate.exposure),
                     std::to_string(rate.jerks), text::short_number(rate.rate), bounds_text(rate.bounds),
                     text::short_number(rate.dispersion)});
  }
  return text::aligned_table(cells, std::vector<bool>(cells.front().size(), true));
}

std::string proportion_text(const statistics::ClusteredProportion& proportion) {
  return fmt::format("{} of {}, bounds [{}] %", text::percentage(proportion.hits, proportion.events),
                     proportion.events,
                     text::percent_bounds(proportion.korn_graubard.low, proportion.korn_graubard.high));
}

std::string intervals_text(const JerkIntervals& intervals) {
  std::string text = fmt::format("intervals: {}", intervals.n);
  if (intervals.n == 0) return text + "\n";
  for (std::size_t i = 0; i < intervals.quantiles.size(); ++i) {
    const statistics::Quantile& quantile = intervals.quantiles[i];
    text += fmt::format("; {:.0f} % below {} s [{}, {}]", 100.0 * jerk_interval_probabilities[i],
                        text::short_number(quantile.value), text::short_number(quantile.low),
                        text::short_number(quantile.high));
  }
  return text + "\n";
}

/// Whether the p-value is the least that so many permutations can show.
bool is_least(const TrendSummary& slowing) {
  return slowing.permutations > 0 && slowing.p_slowing * static_cast<double>(slowing.permutations + 1) < 1.5;
}

std::string slowing_text(const TrendSummary& slowing, const std::string& level) {
  if (slowing.moves == 0) return {};
  return fmt::format(
      "slowing down after the first jerk: score {:.2f} over {} moves (p {} {:.2g}); of {} moves with {} or "
      "more intervals, {} slow down and {} quicken ({} one-sided)\n",
      slowing.summed, slowing.moves, is_least(slowing) ? "≤" : "=", slowing.p_slowing, slowing.tested,
      min_trend_intervals, slowing.slowing, slowing.quickening, level);
}

std::string creep_text(const CreepComparison& creep, const CreepAgreement& agreement) {
  if (!creep.not_applicable.empty())
    return fmt::format("creep at constant torque: does not apply: {}\n", creep.not_applicable);
  if (creep.trials == 0) return {};
  std::string text = fmt::format(
      "creep at constant torque: in {} trials simulated again it predicts {} of {} jerks, and {} of {} waits "
      "without one",
      creep.trials, agreement.predicted, agreement.ended, agreement.lasting_predicted, agreement.lasting);
  if (agreement.ended > 0)
    text += fmt::format("; median deviation {:.2g} ms", 1e3 * agreement.median_deviation);
  return text + "\n";
}

std::string point_text(const PointJerks& point, const std::string& level, parameters::AxisKind axis) {
  const JerkStatistics& jerks = point.statistics;
  std::string text =
      fmt::format("{}\n{} jerks in {} of {} trials; {} of {} moves arrived", text::printable(point.label),
                  jerks.jerks, jerks.with_jerks, jerks.trials, jerks.arrived, jerks.moves);
  if (jerks.lost > 0) text += fmt::format(", {} of these failed numerically and are excluded", jerks.lost);
  text += "\n\n";
  if (!jerks.rates.empty()) text += rate_table(jerks.rates, level) + "\n";
  text += intervals_text(jerks.intervals) + slowing_text(jerks.slowing, level);
  if (jerks.jerks > 0) {
    text += parameters::text_on(
        axis, fmt::format("in the direction of the holding $torque: {}\n", proportion_text(jerks.agreement)));
    text += fmt::format("of one count: {}; largest {} counts; median duration {} s\n",
                        proportion_text(jerks.magnitudes.one_count), jerks.magnitudes.max,
                        text::short_number(jerks.magnitudes.median_duration));
  }
  return text + creep_text(point.creep, point.creep_agreement) + "\n";
}

constexpr const char* legend =
    "watched: time in which a jerk could have begun, summed over all moves\n"
    "rate: jerks per second watched; Garwood's bounds, widened where the jerks of a trial vary more than\n"
    "independent ones (dispersion above 1)\n"
    "score: Laplace's statistic of the intervals against their permutations within each move: mean 0 and\n"
    "standard deviation 1 without a trend, whatever the distribution of the intervals; negative if jerks "
    "slow\n"
    "down. p: proportion of permutations in which they would seem to slow down as much. A trend does not "
    "tell its\n"
    "cause: creep, or noise that moves the rotor to where it is quieter\n"
    "creep at constant torque: onset of the next jerk, predicted from the state a dwell after the error "
    "became 0\n";

}  // namespace

std::string jerk_text(const JerkReport& report) {
  const std::string level = text::percent(report.confidence);
  std::string text = text::printable(report.name) + "\n\n";
  for (const PointJerks& point : report.points) text += point_text(point, level, report.axis);
  return text + legend;
}

}  // namespace zerocount::jerks
