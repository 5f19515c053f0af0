#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "analysis/comparison/comparison_report.hpp"
#include "analysis/text/report_json.hpp"

namespace zerocount::comparison {
namespace {

using Json = nlohmann::ordered_json;

Json trials_json(const std::optional<double>& trials) {
  return trials ? Json(static_cast<std::int64_t>(*trials)) : Json(nullptr);
}

Json interval_json(const statistics::ConfidenceInterval& bounds) {
  return Json::array({bounds.low, bounds.high});
}

Json file_json(const ComparedFile& file) {
  const layout::Provenance& build = file.header.provenance;
  return {{"path", file.path},
          {"name", file.header.name},
          {"zerocount_version", build.zerocount_version},
          {"git_commit", build.git_commit},
          {"engine", layout::name_of(file.header.engine)},
          {"created", build.created},
          {"seed", file.header.seed},
          {"trials", file.header.trials}};
}

Json measure_json(const MeasureComparison& measure) {
  return {{"measure", measure.measure},
          {"unit", measure.unit},
          {"verdict", to_string(measure.change)},
          {"gate", to_string(measure.verdict)},
          {"baseline", measure.baseline},
          {"current", measure.current},
          {"baseline_n", measure.baseline_n},
          {"current_n", measure.current_n},
          {"effect", measure.effect},
          {"effect_bounds", interval_json(measure.bounds)},
          {"margin", measure.margin},
          {"changed_fails", measure.changed_fails},
          {"detectable_change", measure.detectable_change},
          {"test", measure.test},
          {"p", measure.p},
          {"adjusted_p", measure.adjusted_p},
          {"improvement_p", measure.improvement_p},
          {"adjusted_improvement_p", measure.adjusted_improvement_p},
          {"trials_to_decide", trials_json(measure.trials_to_decide)},
          {"decided_margin", measure.decided_margin},
          {"max_trials_margin", measure.max_trials_margin},
          {"note", measure.note}};
}

Json requirement_json(const RequirementResult& requirement) {
  return {{"require", requirement.text},
          {"quantity", requirement.quantity},
          {"unit", requirement.unit},
          {"verdict", to_string(requirement.verdict)},
          {"limit", requirement.limit},
          {"value", requirement.value},
          {"n", requirement.n},
          {"bounds", interval_json(requirement.bounds)},
          {"trials_to_decide", trials_json(requirement.trials_to_decide)}};
}

Json undecided_json(const measures::UndecidedMoves& moves) {
  Json json{{"moves", moves.moves}};
  for (const measures::UndecidedCount& each : measures::undecided_counts) json[each.name] = moves.*each.count;
  return json;
}

Json point_json(const PointComparison& point) {
  Json json{{"label", point.label},
            {"verdict", to_string(point.verdict)},
            {"baseline_point", point.baseline_point},
            {"current_point", point.current_point},
            {"baseline_trials", point.baseline_trials},
            {"current_trials", point.current_trials},
            {"pairs", point.pairs},
            {"baseline_undecided", undecided_json(point.baseline_undecided)},
            {"current_undecided", undecided_json(point.current_undecided)},
            {"measures", Json::array()},
            {"requirements", Json::array()}};
  for (const MeasureComparison& measure : point.measures) json["measures"].push_back(measure_json(measure));
  for (const RequirementResult& one : point.requirements)
    json["requirements"].push_back(requirement_json(one));
  if (point.goal) {
    json["goal"] = {{"baseline", goal::text_of(point.goal->baseline)},
                    {"current", goal::text_of(point.goal->current)}};
  }
  return json;
}

}  // namespace

std::string comparison_json(const StudyComparison& comparison) {
  const VerdictCounts counts = count_verdicts(comparison);
  Json json{
      {"verdict", to_string(comparison.verdict)},
      {"sentence", verdict_sentence(comparison)},
      {"baseline", file_json(comparison.baseline)},
      {"current", file_json(comparison.current)},
      {"baseline_label", comparison.baseline_label.empty() ? Json(nullptr) : Json(comparison.baseline_label)},
      {"layer", to_string(comparison.layer)},
      {"layer_reason", comparison.layer_reason},
      {"equal_to_the_bit", comparison.equal_to_the_bit},
      {"first_difference", comparison.first_difference},
      {"manifest_differences", Json::array()},
      {"changed_inputs", comparison.changed_inputs},
      {"confidence", comparison.confidence},
      {"false_discovery_rate", comparison.false_discovery_rate},
      {"tests", comparison.tests},
      {"counts",
       {{"passed", counts.passed},
        {"regression", counts.regressions},
        {"changed", counts.changed},
        {"inconclusive", counts.inconclusive},
        {"not_measured", counts.not_measured},
        {"worse", counts.worse},
        {"better", counts.better},
        {"equivalent", counts.equivalent},
        {"not_worse", counts.not_worse},
        {"undecided", counts.undecided}}},
      {"trials_to_decide", trials_json(comparison.trials_to_decide)},
      {"decision_probability", decision_probability},
      {"max_trials_to_decide", comparison.max_trials_to_decide},
      {"notes", comparison.notes},
      {"points", Json::array()}};
  for (const manifest::ManifestDifference& one : comparison.manifest_differences) {
    json["manifest_differences"].push_back(
        {{"key", one.key}, {"baseline", one.baseline}, {"current", one.current}});
  }
  for (const PointComparison& point : comparison.points) json["points"].push_back(point_json(point));
  return text::json_text(json);
}

}  // namespace zerocount::comparison
