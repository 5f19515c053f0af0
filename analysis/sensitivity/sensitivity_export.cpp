#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/sensitivity/sensitivity.hpp"
#include "analysis/text/report_json.hpp"
#include "results/reading/csv.hpp"

namespace zerocount::sensitivity {
namespace {

using Json = nlohmann::ordered_json;

Json factor_json(const FactorSensitivity& factor) {
  Json json{{"name", factor.name}, {"matters", factor.matters}};
  for (const FactorNumber& measure : factor_numbers) {
    const BoundedNumber& number = factor.*measure.number;
    json[measure.name] = {{"value", number.value}, {"low", number.low}, {"high", number.high}};
  }
  return json;
}

Json output_json(const OutputSensitivity& output) {
  Json factors = Json::array();
  for (const FactorSensitivity& factor : output.factors) factors.push_back(factor_json(factor));
  Json left_out = Json::array();
  for (const FactorLeftOut& factor : output.left_out) {
    left_out.push_back({{"name", factor.name}, {"reason", factor.reason}});
  }
  return {{"output", output.output},
          {"unit", output.unit},
          {"meaning", output.meaning},
          {"estimated", output.estimated},
          {"conclusion", output.conclusion},
          {"notes", output.notes},
          {"trials", output.trials},
          {"mean", output.mean},
          {"standard_deviation", output.standard_deviation},
          {"factors", std::move(factors)},
          {"left_out", std::move(left_out)}};
}

std::string csv_header() {
  std::string line = "point,label,output,factor,matters";
  for (const FactorNumber& measure : factor_numbers) {
    line += fmt::format(",{0},{0}_low,{0}_high", measure.name);
  }
  return line + "\n";
}

std::string csv_row(const PointSensitivity& point, const OutputSensitivity& output,
                    const FactorSensitivity& factor) {
  std::string line = fmt::format("{},{},{},{},{}", point.point, reading::csv_field(point.label),
                                 output.output, reading::csv_field(factor.name), factor.matters ? 1 : 0);
  for (const FactorNumber& measure : factor_numbers) {
    const BoundedNumber& number = factor.*measure.number;
    for (const double value : {number.value, number.low, number.high})
      line += fmt::format(",{}", reading::number_text(value));
  }
  return line + "\n";
}

}  // namespace

std::string sensitivity_json(const StudySensitivity& sensitivity) {
  Json points = Json::array();
  for (const PointSensitivity& point : sensitivity.points) {
    Json outputs = Json::array();
    for (const OutputSensitivity& output : point.outputs) outputs.push_back(output_json(output));
    points.push_back({{"point", point.point}, {"label", point.label}, {"outputs", std::move(outputs)}});
  }
  const Json json{{"name", sensitivity.name},
                  {"design_is_saltelli", sensitivity.from_saltelli},
                  {"confidence", sensitivity.confidence},
                  {"points", std::move(points)}};
  return text::json_text(json);
}

std::string sensitivity_csv(const StudySensitivity& sensitivity) {
  std::string text = csv_header();
  for (const PointSensitivity& point : sensitivity.points) {
    for (const OutputSensitivity& output : point.outputs) {
      for (const FactorSensitivity& factor : output.factors) text += csv_row(point, output, factor);
    }
  }
  return text;
}

}  // namespace zerocount::sensitivity
