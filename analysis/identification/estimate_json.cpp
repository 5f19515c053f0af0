#include "analysis/identification/estimate_json.hpp"

#include <string>

#include <nlohmann/json.hpp>

namespace zerocount::identification {
namespace {

std::string status_word(EstimateStatus status) {
  switch (status) {
    case EstimateStatus::estimated:
      return "estimated";
    case EstimateStatus::known:
      return "given";
    case EstimateStatus::kept:
      return "kept";
    case EstimateStatus::not_identifiable:
      break;
  }
  return "not_identifiable";
}

}  // namespace

nlohmann::ordered_json estimate_json(const ParameterEstimate& estimate) {
  using Json = nlohmann::ordered_json;
  Json object;
  object["name"] = estimate.name;
  object["key"] = estimate.key.empty() ? Json() : Json(estimate.key);
  object["unit"] = estimate.unit;
  object["status"] = status_word(estimate.status);
  object["value"] = estimate.value;
  object["standard_error"] = estimate.standard_error;
  object["low"] = estimate.low;
  object["high"] = estimate.high;
  if (!estimate.reason.empty()) object["reason"] = estimate.reason;
  return object;
}

}  // namespace zerocount::identification
