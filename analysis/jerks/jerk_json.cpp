#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "analysis/jerks/jerk_report.hpp"
#include "analysis/text/report_json.hpp"

namespace zerocount::jerks {
namespace {

using Json = nlohmann::ordered_json;

Json rates_json(const std::vector<JerkRate>& rates) {
  Json json = Json::array();
  for (const JerkRate& rate : rates) {
    json.push_back({{"from", rate.from},
                    {"to", rate.to},
                    {"moves", rate.moves},
                    {"exposure", rate.exposure},
                    {"jerks", rate.jerks},
                    {"rate", rate.rate},
                    {"rate_low", rate.bounds.low},
                    {"rate_high", rate.bounds.high},
                    {"poisson_low", rate.poisson.low},
                    {"poisson_high", rate.poisson.high},
                    {"dispersion", rate.dispersion}});
  }
  return json;
}

Json intervals_json(const JerkIntervals& intervals) {
  Json json{{"n", intervals.n}, {"mean", intervals.mean}};
  for (std::size_t i = 0; i < intervals.quantiles.size(); ++i) {
    const std::string name = fmt::format("p{:02.0f}", 100.0 * jerk_interval_probabilities[i]);
    json[name] = intervals.quantiles[i].value;
    json[name + "_low"] = intervals.quantiles[i].low;
    json[name + "_high"] = intervals.quantiles[i].high;
  }
  return json;
}

Json slowing_json(const TrendSummary& slowing) {
  return {{"moves", slowing.moves},       {"tested", slowing.tested},
          {"slowing", slowing.slowing},   {"quickening", slowing.quickening},
          {"score", slowing.summed},      {"stouffer", slowing.stouffer},
          {"p_value", slowing.p_slowing}, {"permutations", slowing.permutations}};
}

Json proportion_json(const statistics::ClusteredProportion& proportion) {
  return {{"hits", proportion.hits},
          {"jerks", proportion.events},
          {"share", proportion.value},
          {"share_low", proportion.korn_graubard.low},
          {"share_high", proportion.korn_graubard.high},
          {"independent", proportion.effective_events}};
}

Json magnitudes_json(const JerkMagnitudes& magnitudes) {
  return {{"one_count", proportion_json(magnitudes.one_count)},
          {"counts", magnitudes.counts},
          {"mean", magnitudes.mean},
          {"max", magnitudes.max},
          {"median_duration", magnitudes.median_duration},
          {"longest_duration", magnitudes.longest_duration}};
}

Json creep_json(const CreepComparison& creep, const CreepAgreement& agreement) {
  Json json{{"trials", creep.trials}};
  if (!creep.not_applicable.empty()) {
    json["not_applicable"] = creep.not_applicable;
    return json;
  }
  json["ended"] = agreement.ended;
  json["foretold"] = agreement.predicted;
  json["lasting"] = agreement.lasting;
  json["lasting_foretold"] = agreement.lasting_predicted;
  json["too_short"] = creep.too_short;
  json["unsteady"] = creep.unsteady;
  json["median_deviation"] = agreement.median_deviation;
  json["largest_deviation"] = agreement.largest_deviation;
  return json;
}

}  // namespace

Json jerk_json(const JerkReport& report) {
  Json points = Json::array();
  for (const PointJerks& point : report.points) {
    const JerkStatistics& jerks = point.statistics;
    points.push_back({{"point", point.point},
                      {"label", point.label},
                      {"trials", jerks.trials},
                      {"moves", jerks.moves},
                      {"arrived", jerks.arrived},
                      {"lost", jerks.lost},
                      {"trials_with_jerks", jerks.with_jerks},
                      {"jerks", jerks.jerks},
                      {"rates", rates_json(jerks.rates)},
                      {"interval", intervals_json(jerks.intervals)},
                      {"slowing", slowing_json(jerks.slowing)},
                      {"agreement", proportion_json(jerks.agreement)},
                      {"magnitude", magnitudes_json(jerks.magnitudes)},
                      {"creep", creep_json(point.creep, point.creep_agreement)}});
  }
  return {{"name", report.name}, {"confidence", report.confidence}, {"points", std::move(points)}};
}

std::string jerk_json_text(const JerkReport& report) {
  return text::json_text(jerk_json(report));
}

}  // namespace zerocount::jerks
