#include "analysis/law_identification/law_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/identification/estimate_json.hpp"
#include "analysis/text/text.hpp"
#include "core/friction/law.hpp"

namespace zerocount::law_identification {
namespace {

using identification::EstimateStatus;
using identification::ParameterEstimate;
using Json = nlohmann::ordered_json;

/// Difference of the information criterion that is strong evidence (Kass & Raftery, J. Am. Stat. Assoc. 90,
/// 1995, 773: 6 to 10 strong, above 10 very strong).
constexpr double strong_evidence = 10.0;

std::string word_of(const IdentifiedLaw& law) {
  return std::string(friction::traits_of(law.law).word);
}

std::string table_of(const LawComparison& comparison) {
  std::vector<std::vector<std::string>> cells{{"law", "fitted",
                                               "residual, " + parameters::unit_on(comparison.axis, "rad"),
                                               "of the travel", "BIC − least", "encoder and noise"}};
  for (const IdentifiedLaw& law : comparison.laws) {
    cells.push_back({word_of(law), fmt::format("{}", law.fitted), fmt::format("{:.3g}", law.misfit),
                     fmt::format("{:.3g} %", 100.0 * law.misfit_over_travel),
                     fmt::format("{:.1f}", law.information_criterion),
                     law.checks.passed ? "explain the residuals" : "do not explain them"});
  }
  return text::aligned_table(cells, {false, true, true, true, true, false});
}

/// A sentence: the law with the least criterion, its lead over the next, and if it explains the records.
std::string verdict_of(const LawComparison& comparison) {
  const IdentifiedLaw& best = comparison.laws.front();
  std::string text;
  if (comparison.laws.size() > 1) {
    const IdentifiedLaw& next = comparison.laws[1];
    text = next.information_criterion > strong_evidence
               ? fmt::format("{} is the nearest of these laws; {} is next, {:.0f} higher in BIC.\n",
                             word_of(best), word_of(next), next.information_criterion)
               : fmt::format(
                     "The BIC of {} and {} differ by {:.1f} only: the records do not distinguish them.\n",
                     word_of(best), word_of(next), next.information_criterion);
  }
  if (best.checks.passed) return text;
  return text + fmt::format("LACK OF FIT: {} does not explain the records: {}.\n", word_of(best),
                            record_fit::reason_of_misfit(best.checks));
}

std::string parameters_of(const IdentifiedLaw& law) {
  std::vector<std::vector<std::string>> cells{identification::estimate_heads()};
  for (const ParameterEstimate& parameter : law.parameters) {
    cells.push_back(identification::estimate_row(parameter));
  }
  std::string text = text::aligned_table(cells, {false, true, false, true, true, false});
  for (const ParameterEstimate& parameter : law.parameters) {
    if (parameter.status != EstimateStatus::not_identifiable) continue;
    text += fmt::format("{} is not identifiable from this, because {}.\n", parameter.name, parameter.reason);
  }
  if (!law.converged) text += "The fit to all readings did not converge within its steps.\n";
  return text;
}

Json law_json(const IdentifiedLaw& law) {
  Json object{{"law", word_of(law)},
              {"fitted", law.fitted},
              {"misfit", law.misfit},
              {"misfit_over_travel", law.misfit_over_travel},
              {"bic_above_least", law.information_criterion},
              {"explained", law.checks.passed},
              {"spread", law.checks.spread},
              {"expected_spread", law.checks.expected_spread},
              {"widening", law.checks.widening},
              {"converged", law.converged},
              {"parameters", Json::array()}};
  for (const ParameterEstimate& parameter : law.parameters) {
    object["parameters"].push_back(identification::estimate_json(parameter));
  }
  object["manifest"] = law.fragment;
  return object;
}

}  // namespace

std::string law_fragment(Records records, const LawModel& model, const LawPoint& point,
                         const IdentifiedLaw& law) {
  std::string text = "# Identified from";
  for (const TestRecord& record : records) {
    text += fmt::format("{} {}", &record == &records.front() ? "" : ",", text::printable(record.name));
  }
  text += ".\n# The central 95 % of each distribution are the confidence interval.\n";
  for (const ParameterEstimate& parameter : law.parameters) {
    if (parameter.name != "series_compliance" || parameter.status != EstimateStatus::estimated) continue;
    text += fmt::format("# A fixture gives way by {} {}; a manifest has none.\n",
                        identification::with_digits(parameter.value, parameter), parameter.unit);
  }
  if (!law.checks.passed) {
    text += "# Lack of fit: encoder and noise do not explain the residuals; do not rely on these values.\n";
  }
  if (records.front().axis == parameters::AxisKind::linear) text += "axis: linear\n";
  for (const std::string group : {"plant", "friction"}) {
    std::string lines = group == "plant" ? model.plant_lines : fmt::format("  model: {}\n", word_of(law));
    for (const ParameterEstimate& parameter : law.parameters) {
      if (!parameter.key.starts_with(group + ".")) continue;
      lines += identification::manifest_line(parameter, parameter.key.substr(group.size() + 1));
    }
    if (group == "friction") lines += parameters::unit_on(records.front().axis, model.fixed_lines(point));
    // A map that contains only comments would not be a map.
    const bool any =
        group == "friction" || !model.plant_lines.empty() ||
        std::any_of(law.parameters.begin(), law.parameters.end(), [&](const auto& parameter) {
          return parameter.key.starts_with(group + ".") && parameter.status == EstimateStatus::estimated;
        });
    text += fmt::format("{}{}:\n{}", any ? "" : "# ", group, lines);
  }
  return text;
}

std::string comparison_text(const LawComparison& comparison) {
  const IdentifiedLaw& best = comparison.laws.front();
  std::string text = table_of(comparison);
  text += fmt::format("{} readings, of which {:.0f} count as independent in BIC.\n", comparison.readings,
                      comparison.effective_readings);
  for (const ComparedRecord& record : comparison.records) {
    if (!record.note.empty()) text += fmt::format("{}: {}\n", text::printable(record.name), record.note);
    if (record.excluded > 0) {
      text +=
          fmt::format("{}: {} samples masked by --exclude\n", text::printable(record.name), record.excluded);
    }
  }
  text += verdict_of(comparison);
  text += fmt::format("\nParameters of {}\n\n", word_of(best)) + parameters_of(best);
  return text + "\nTo paste into a manifest:\n\n" + best.fragment;
}

std::string comparison_json(const LawComparison& comparison) {
  Json json;
  json["kind"] = "laws";
  json["axis"] = parameters::axis_labels.at(static_cast<std::size_t>(comparison.axis));
  json["readings"] = comparison.readings;
  json["effective_readings"] = comparison.effective_readings;
  json["sample_time"] = comparison.sample_time;
  json["records"] = Json::array();
  for (const ComparedRecord& record : comparison.records) {
    json["records"].push_back({{"name", text::printable(record.name)},
                               {"samples", record.samples},
                               {"excluded", record.excluded},
                               {"note", text::printable(record.note)}});
  }
  json["laws"] = Json::array();
  for (const IdentifiedLaw& law : comparison.laws) json["laws"].push_back(law_json(law));
  json["manifest"] = comparison.laws.front().fragment;
  return json.dump(2) + "\n";
}

}  // namespace zerocount::law_identification
