#include <nlohmann/json.hpp>

#include "analysis/identification/estimate_json.hpp"
#include "analysis/identification/identification.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::identification {
namespace {

using Json = nlohmann::ordered_json;

Json parameter_json(const ParameterEstimate& parameter) {
  Json object = estimate_json(parameter);
  if (parameter.status == EstimateStatus::estimated && !parameter.key.empty()) {
    object["distribution"] = distribution_text(parameter);
  }
  return object;
}

Json record_json(const RecordSummary& record) {
  return {{"name", text::printable(record.name)},
          {"samples", record.samples},
          {"duration", record.duration},
          {"counted", record.counted},
          {"unit", record.unit},
          {"branches", record.branches},
          {"reversals", record.reversals},
          {"holds", record.holds},
          {"ring_downs", record.ring_downs},
          {"misfit", record.misfit},
          {"noise", record.noise},
          {"excluded", record.excluded},
          {"note", text::printable(record.note)}};
}

Json checks_json(const record_fit::ResidualChecks& checks) {
  return {{"observations", checks.observations},
          {"spread", checks.spread},
          {"expected_spread", checks.expected_spread},
          {"spread_chance", checks.spread_chance},
          {"runs", checks.runs},
          {"expected_runs", checks.expected_runs},
          {"runs_chance", checks.runs_chance},
          {"correlation_length", checks.correlation_length},
          {"expected_correlation_length", checks.expected_correlation_length},
          {"passed", checks.passed},
          {"reason", checks.passed ? Json() : Json(reason_of_misfit(checks))},
          {"widening", checks.widening}};
}

Json line_json(const Identification& identification) {
  if (!identification.residual_line) return {};
  const record_fit::ResidualLine& line = *identification.residual_line;
  return {{"record", text::printable(identification.records[line.record].name)},
          {"frequency", line.frequency}};
}

/// Matrices in the order of the parameters, of logarithms except for n and the time offset.
Json errors_json(const JointErrors& errors) {
  Json object{{"parameters", errors.names}, {"covariance", Json::array()}, {"correlation", Json::array()}};
  for (Eigen::Index i = 0; i < errors.covariance.rows(); ++i) {
    Json covariances = Json::array();
    Json correlations = Json::array();
    for (Eigen::Index j = 0; j < errors.covariance.cols(); ++j) {
      covariances.push_back(errors.covariance(i, j));
      correlations.push_back(errors.correlation(i, j));
    }
    object["covariance"].push_back(std::move(covariances));
    object["correlation"].push_back(std::move(correlations));
  }
  return object;
}

}  // namespace

std::string identification_json(const Identification& identification) {
  Json json;
  json["axis"] = parameters::axis_labels.at(static_cast<std::size_t>(identification.axis));
  json["parameters"] = Json::array();
  for (const ParameterEstimate& parameter : identification.parameters) {
    json["parameters"].push_back(parameter_json(parameter));
  }
  json["sample_time"] = identification.sample_time;
  json["correlations"] = Json::array();
  for (const Identification::Correlation& pair : identification.correlations) {
    json["correlations"].push_back({{"one", pair.one}, {"other", pair.other}, {"value", pair.value}});
  }
  json["errors"] = errors_json(identification.errors);
  json["records"] = Json::array();
  for (const RecordSummary& record : identification.records) json["records"].push_back(record_json(record));
  json["residuals"] = checks_json(identification.checks);
  json["residual_line"] = line_json(identification);
  json["search_ended"] = identification.search_ended;
  json["manifest"] = manifest_fragment(identification);
  return json.dump(2) + "\n";
}

}  // namespace zerocount::identification
