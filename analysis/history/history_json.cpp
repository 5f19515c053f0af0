#include <nlohmann/json.hpp>

#include "analysis/history/series.hpp"
#include "analysis/text/report_json.hpp"

namespace zerocount::history {
namespace {

using nlohmann::ordered_json;

ordered_json comparison_json(const RunRecord& run, const ValueComparison& compared) {
  return {{"verdict", compared.verdict},
          {"baseline_created",
           run.comparison ? ordered_json(run.comparison->baseline_created) : ordered_json(nullptr)},
          {"baseline_commit",
           run.comparison ? ordered_json(run.comparison->baseline_commit) : ordered_json(nullptr)},
          {"baseline", compared.baseline},
          {"effect", compared.effect},
          {"effect_bounds", ordered_json::array({compared.bounds.low, compared.bounds.high})},
          {"margin", compared.margin},
          {"p", compared.p}};
}

ordered_json run_json(const SeriesRun& one) {
  const auto& [run, value] = one;
  return {{"created", run.created},
          {"git_commit", run.git_commit},
          {"zerocount_version", run.zerocount_version},
          {"study_sha256", run.study_sha256},
          {"seed", run.seed},
          {"trials", run.trials},
          {"n", value.n},
          {"value", value.value},
          {"low", value.bounds.low},
          {"high", value.bounds.high},
          {"comparison", value.comparison ? comparison_json(run, *value.comparison) : ordered_json(nullptr)}};
}

ordered_json place_json(const RunRecord& run) {
  return {{"created", run.created}, {"git_commit", run.git_commit}};
}

ordered_json change_json(const Series& series, const SeriesChange& change) {
  const RunRecord& significant = series.runs[change.significant].run;
  const ordered_json before = change.since_baseline
                                  ? ordered_json{{"created", significant.comparison->baseline_created},
                                                 {"git_commit", significant.comparison->baseline_commit}}
                                  : place_json(series.runs[change.first - 1].run);
  return {{"before", change.before},
          {"after", change.after},
          {"since_baseline", change.since_baseline},
          {"last_run_before", before},
          {"first_run_after", place_json(series.runs[change.first].run)},
          {"significant_since", place_json(significant)},
          {"z", change.z},
          {"p", change.p},
          {"sentence", change_sentence(series, change)}};
}

ordered_json series_json(const Series& series) {
  ordered_json json{
      {"study", series.study},         {"series_sha256", series.series_sha256},
      {"point", series.point},         {"measure", series.measure},
      {"unit", series.unit},           {"test", series.test == SeriesTest::levels ? "levels" : "baseline"},
      {"runs", ordered_json::array()}, {"changes", ordered_json::array()}};
  for (const SeriesRun& one : series.runs) json["runs"].push_back(run_json(one));
  for (const SeriesChange& one : series.changes) json["changes"].push_back(change_json(series, one));
  return json;
}

}  // namespace

std::string history_json(const History& history) {
  ordered_json json{{"false_alarm_probability", false_alarm_probability},
                    {"false_alarm_runs", false_alarm_runs},
                    {"threshold", history.threshold},
                    {"max_p", history.max_p},
                    {"series", ordered_json::array()}};
  for (const Series& series : history.series) json["series"].push_back(series_json(series));
  return text::json_text(json);
}

}  // namespace zerocount::history
