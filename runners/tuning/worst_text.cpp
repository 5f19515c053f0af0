#include "runners/tuning/worst_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/goal/question.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"

namespace zerocount::tuning {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string unit_text(const WorstMachine& worst, bool on_rigs) {
  return fmt::format("{} {}", on_rigs ? "rig" : "trial", worst.rig);
}

OrderedJson judgement(const JudgedMachine& machine) {
  return {{"moves", machine.moves}, {"met", machine.met}};
}

OrderedJson machine_json(const JudgedMachine& machine) {
  OrderedJson json{{"rig", machine.rig}, {"trial", machine.trial}};
  json.update(judgement(machine));
  json["inputs"] = values_json(machine.inputs);
  json["quantiles"] = machine.quantiles;
  return json;
}

std::string judgement_text(const JudgedMachine& machine, std::string_view meet) {
  return fmt::format("{:.4g} % of {} moves {}", 100.0 * machine.met, machine.moves, meet);
}

std::string inputs_table(const WorstMachines& worst) {
  std::vector<text::TextColumn> columns{{"input", false, {}}, {"in the box", true, {}}};
  if (!worst.likely_is_in_box) columns.push_back({"likely", true, {}});
  for (std::size_t i = 0; i < worst.in_box.inputs.size(); ++i) {
    columns[0].cells.push_back(worst.in_box.inputs[i].first);
    columns[1].cells.push_back(text::short_number(worst.in_box.inputs[i].second));
    if (!worst.likely_is_in_box)
      columns[2].cells.push_back(text::short_number(worst.likely.inputs[i].second));
  }
  return text::aligned_table(columns);
}

}  // namespace

std::string values_text(const NamedValues& values) {
  std::string text;
  for (const auto& [name, value] : values)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, text::short_number(value));
  return text;
}

OrderedJson values_json(const NamedValues& values) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

OrderedJson worst_object(const WorstMachine& worst) {
  return {
      {"rig", worst.rig}, {"trial", worst.trial}, {"met", worst.met}, {"inputs", values_json(worst.inputs)}};
}

std::string worst_text(const WorstMachine& worst, const study::Study& study) {
  return fmt::format("worst machine: {}, {:.4g} % of its moves {}{}{}\n", unit_text(worst, study.rigs > 0),
                     100.0 * worst.met, words_of(goal::question_of(study)).meet,
                     worst.inputs.empty() ? "" : "; ", values_text(worst.inputs));
}

std::string worst_json(const WorstMachines& worst) {
  OrderedJson json = worst_object(worst.of_study);
  json["again"] = judgement(worst.again);
  json["box"] = machine_json(worst.in_box);
  json["box"]["of_study"] = worst.in_box_is_of_study;
  json["likely"] = machine_json(worst.likely);
  json["likely"]["in_box"] = worst.likely_is_in_box;
  return text::json_text(json);
}

std::string worst_text(const WorstMachines& worst, const study::Study& study) {
  const std::string_view meet = words_of(goal::question_of(study)).meet;
  std::string text = worst_text(worst.of_study, study);
  text += fmt::format("  in new trials {}\n", judgement_text(worst.again, meet));
  text += worst.in_box_is_of_study
              ? fmt::format(
                    "worst in the box of the central 99.9 % of each input: none is worse than {} of "
                    "the study\n",
                    unit_text(worst.of_study, study.rigs > 0))
              : fmt::format("worst in the box of the central 99.9 % of each input: {}\n",
                            judgement_text(worst.in_box, meet));
  text += fmt::format("worst of the likely machines: {}\n",
                      worst.likely_is_in_box ? "the same machine" : judgement_text(worst.likely, meet));
  text += inputs_table(worst);
  if (worst.with_profiles)
    text += worst.likely_is_in_box ? fmt::format("with the profiles of rig {}\n", worst.in_box.rig)
                                   : fmt::format("with the profiles of rig {}, likely: of rig {}\n",
                                                 worst.in_box.rig, worst.likely.rig);
  return text;
}

}  // namespace zerocount::tuning
