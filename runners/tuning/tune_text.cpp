#include "runners/tuning/tune_text.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/goal/goal_text.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "runners/tuning/limits_text.hpp"

namespace zerocount::tuning {
namespace {

using Json = nlohmann::ordered_json;
using NamedValues = std::vector<std::pair<std::string, double>>;

Json values_json(const NamedValues& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values) json[name] = value;
  return json;
}

Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

std::string values_text(const NamedValues& values) {
  std::string text;
  for (const auto& [name, value] : values)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, text::short_number(value));
  return text;
}

std::string_view word_of(goal::Status status) {
  return status == goal::Status::missed ? "unreachable" : goal::text_of(status);
}

std::string criterion_number(double value) {
  return std::isfinite(value) ? text::short_number(value) : "not within the hold";
}

std::string margin_limit(const std::optional<double>& limit) {
  return limit ? fmt::format("wanted: {:g}", *limit) : "off";
}

std::string margin_number(double margin) {
  return std::isfinite(margin) ? text::short_number(margin) : "∞";
}

/// The loops that were examined.
std::string_view loops_text(const SmallestMargins& margins) {
  if (!margins.sliding) return " before they slide";
  return margins.before_sliding ? " before they slide and while they slide" : " while they slide";
}

std::string margins_text(const TuneAnswer& answer, const study::LoopMargins& wanted) {
  if (answer.blind)
    return "margins: none, because the controller is a plugin, whose transfer function is not known\n";
  const SmallestMargins& m = answer.margins;
  return fmt::format(
      "smallest margins of {} machines{}: gain {} dB ({}), phase {}° ({}), delay {} samples "
      "({})\n{}",
      m.machines, loops_text(m), margin_number(m.gain), margin_limit(wanted.gain), margin_number(m.phase),
      margin_limit(wanted.phase), m.delay >= 10.0 ? "10 or more" : text::short_number(m.delay),
      margin_limit(wanted.delay), m.stable ? "" : "  the linear loop of a machine is unstable\n");
}

/// kp, ki and kd in the other system of units, where they are free.
std::string other_units(const TuneAnswer& answer, const study::Study& study) {
  const trial::TrialParameters p = study::study_trial(answer.proof->study, 0, 0).parameters;
  if (p.controller.blocks.structure != loop::ControlStructure::pid || p.controller.user.plugin) return "";
  const bool si = study.units.gains == parameters::GainUnits::si;
  const theory::AnalogueGains analogue = theory::analogue_gains(p.controller, p.encoder);
  const loop::ControllerParameters& c = p.controller;
  if (si)
    return fmt::format("  in counts and samples: kp {}, ki {}, kd {}\n", text::short_number(c.kp),
                       text::short_number(c.ki), text::short_number(c.kd));
  return fmt::format("  in SI units: kp {}, ki {}, kd {}\n", text::short_number(analogue.kp),
                     text::short_number(analogue.ki), text::short_number(analogue.kd));
}

std::string gains_table(const TuneAnswer& answer) {
  std::vector<text::TextColumn> columns{
      {"parameter", false, {}}, {"tuned", true, {}}, {"unit", false, {}}, {"range", false, {}}};
  const bool room = !answer.room.empty();
  if (room) columns.push_back({"goal seems met from", true, {}});
  if (room) columns.push_back({"to", true, {}});
  for (std::size_t i = 0; i < answer.free.size(); ++i) {
    const study::FreeParameter& one = answer.free[i];
    columns[0].cells.push_back(one.name);
    columns[1].cells.push_back(text::short_number(answer.gains[i]));
    columns[2].cells.push_back(one.unit);
    columns[3].cells.push_back(
        fmt::format("{} … {}", text::short_number(one.low), text::short_number(one.high)));
    if (!room) continue;
    columns[4].cells.push_back(text::short_number(answer.room[i].low));
    columns[5].cells.push_back(text::short_number(answer.room[i].high));
  }
  return text::aligned_table(columns);
}

std::string alternatives_text(const TuneAnswer& answer) {
  if (answer.alternatives.empty()) return "";
  std::vector<text::TextColumn> columns{
      {"control", false, {}},
      {"best values", false, {}},
      {"goal", false, {}},
      {answer.proof && !answer.proof->verdict.worlds.empty() ? "moves that meet it (worst world)"
                                                             : "moves that meet it",
       true,
       {}},
      {"at least", true, {}},
      {"criterion", true, {}}};
  for (const Alternative& one : answer.alternatives) {
    const bool added = one.gains.size() > answer.free.size();
    columns[0].cells.push_back(added ? "observer added" : values_text(one.fixed));
    columns[1].cells.push_back(one.verdict ? values_text(one.gains) : "none keeps the margins");
    columns[2].cells.emplace_back(one.verdict ? goal::text_of(one.verdict->status) : "");
    columns[3].cells.push_back(one.verdict ? fmt::format("{:.4g} %", 100.0 * one.verdict->moves.value) : "");
    columns[4].cells.push_back(one.verdict ? fmt::format("{:.4g} %", 100.0 * one.verdict->moves.low) : "");
    columns[5].cells.push_back(one.verdict ? criterion_number(one.criterion) : "");
  }
  return "\nother controls, each at its own best values, on other machines than its search:\n\n" +
         text::aligned_table(columns);
}

/// A few points of the frontier, evenly spread over it.
std::string frontier_text(const TuneAnswer& answer) {
  constexpr std::int64_t most = 6;
  if (answer.frontier.size() < 2) return "";
  std::vector<text::TextColumn> columns{
      {"criterion", true, {}}, {"rate of the goal", true, {}}, {"values", false, {}}};
  for (const std::int64_t i : statistics::spread_over(std::ssize(answer.frontier), most)) {
    const TriedPoint& one = answer.frontier[static_cast<std::size_t>(i)];
    NamedValues values;
    for (std::size_t k = 0; k < one.values.size(); ++k)
      values.emplace_back(answer.free[k].name, one.values[k]);
    columns[0].cells.push_back(criterion_number(one.estimate.criterion));
    columns[1].cells.push_back(fmt::format("{:.2f} %", 100.0 * one.estimate.rate));
    columns[2].cells.push_back(values_text(values));
  }
  return "\nsuccess and speed, by the search (its rates are a little too good):\n\n" +
         text::aligned_table(columns);
}

Json object_of(const WorstMachine& worst) {
  return {
      {"rig", worst.rig}, {"trial", worst.trial}, {"met", worst.met}, {"inputs", values_json(worst.inputs)}};
}

}  // namespace

std::string headline(const TuneAnswer& answer) {
  switch (answer.status) {
    case goal::Status::met:
      return "met: the goal is met by these values";
    case goal::Status::missed:
      return "unreachable in these ranges: the best values found miss the goal";
    case goal::Status::undecided:
      break;
  }
  return "undecided: the trials of the proof do not decide whether the best values found meet the goal";
}

std::vector<std::string> proof_lines(const TuneAnswer& answer, const study::Study& study) {
  const Proof& proof = *answer.proof;
  const bool on_rigs = study.rigs > 0;
  std::vector<std::string> lines{fmt::format(
      "proof: {} moves{} that the search never saw, of which {}{:.5g} % meet the goal, at least {:.5g} %",
      proof.study.trials * study.moves,
      on_rigs ? fmt::format(" on {} machines", proof.study.rigs) : std::string(),
      study.worlds > 0 ? fmt::format("in the worst of {} new worlds ", study.worlds) : std::string(),
      100.0 * proof.verdict.moves.value, 100.0 * proof.verdict.moves.low)};
  if (study.goal->machines)
    lines.push_back(fmt::format("at least {:.5g} % of machines meet it in {:g} % of their moves",
                                100.0 * proof.verdict.machines.low, 100.0 * study.goal->moves));
  if (!proof.verdict.worlds.empty()) {
    lines.push_back(
        fmt::format("by world: met in {}, missed in {}, undecided in {} ('zerocount summary' of the "
                    "proof says what the bad ones have in common)",
                    goal::worlds_that(goal::Status::met, proof.verdict).size(),
                    goal::worlds_that(goal::Status::missed, proof.verdict).size(),
                    goal::worlds_that(goal::Status::undecided, proof.verdict).size()));
  }
  if (proof.attempts > 1)
    lines.push_back(fmt::format("it is attempt {}: the bounds allow for all of them", proof.attempts));
  if (proof.needs) lines.push_back(goal::needs_sentence(*study.goal, *proof.needs, on_rigs));
  return lines;
}

std::string worst_text(const WorstMachine& worst, bool on_rigs) {
  return fmt::format("worst machine: {} {}, {:.4g} % of its moves meet the goal; {}\n",
                     on_rigs ? "rig" : "trial", worst.rig, 100.0 * worst.met, values_text(worst.inputs));
}

std::string worst_text(const WorstInBox& in_box, const WorstInBox& likely) {
  std::string text = fmt::format(
      "worst in the box of the central 99.9 % of each input: {:.4g} % of {} moves meet the goal\n"
      "worst of the likely machines: {:.4g} % of {} moves meet the goal\n",
      100.0 * in_box.met, in_box.moves, 100.0 * likely.met, likely.moves);
  std::vector<text::TextColumn> columns{{"input", false, {}}, {"in the box", true, {}}, {"likely", true, {}}};
  for (std::size_t i = 0; i < in_box.inputs.size(); ++i) {
    columns[0].cells.push_back(in_box.inputs[i].first);
    columns[1].cells.push_back(text::short_number(in_box.inputs[i].second));
    columns[2].cells.push_back(text::short_number(likely.inputs[i].second));
  }
  return text + text::aligned_table(columns) +
         (in_box.searched.rigs > 0 && !in_box.searched.profiles.empty()
              ? fmt::format("with the profiles of rig {}, likely: of rig {}\n", in_box.rig, likely.rig)
              : std::string());
}

namespace {

Json machine_json(const WorstInBox& worst) {
  return {{"rig", worst.rig},
          {"trial", worst.trial},
          {"moves", worst.moves},
          {"met", worst.met},
          {"inputs", values_json(worst.inputs)},
          {"quantiles", worst.quantiles}};
}

}  // namespace

std::string worst_json(const WorstMachine& worst, const WorstInBox& in_box, const WorstInBox& likely) {
  Json json = object_of(worst);
  json["box"] = machine_json(in_box);
  json["likely"] = machine_json(likely);
  return text::json_text(json);
}

std::string json_of(const TuneAnswer& answer) {
  Json gains = Json::object();
  for (std::size_t i = 0; i < answer.gains.size(); ++i) gains[answer.free[i].name] = answer.gains[i];
  Json json{{"status", word_of(answer.status)}, {"gains", gains}, {"proof", nullptr}};
  if (answer.proof) {
    const goal::Verdict& verdict = answer.proof->verdict;
    json["proof"] = {{"rate", verdict.moves.value},          {"rate_low", verdict.moves.low},
                     {"machines_low", verdict.machines.low}, {"rigs", answer.proof->study.rigs},
                     {"trials", answer.proof->study.trials}, {"seed", answer.proof->study.seed},
                     {"attempts", answer.proof->attempts},   {"criterion", finite_or_null(answer.criterion)}};
    if (!answer.proof->study.goal->machines) json["proof"]["machines_low"] = nullptr;
    if (!verdict.worlds.empty()) {
      json["proof"]["worlds"] = Json::object();
      for (const goal::Status status : {goal::Status::met, goal::Status::missed, goal::Status::undecided})
        json["proof"]["worlds"][std::string(goal::text_of(status))] =
            goal::worlds_that(status, verdict).size();
    }
    json["needed"] = nullptr;
    if (answer.proof->needs && answer.proof->needs->trials > 0)
      json["needed"] = {{"rigs", answer.proof->needs->rigs}, {"trials", answer.proof->needs->trials}};
    json["margins"] = {{"gain", finite_or_null(answer.margins.gain)},
                       {"phase", finite_or_null(answer.margins.phase)},
                       {"delay", answer.margins.delay},
                       {"stable", answer.margins.stable},
                       {"machines", answer.margins.machines}};
    if (answer.blind) json["margins"] = nullptr;
    json["delay_lost"] = answer.delay_lost ? Json(*answer.delay_lost) : Json();
  }
  json["at_edges"] = answer.at_edges;
  json["room"] = Json::object();
  for (const Room& one : answer.room) json["room"][one.name] = {one.low, one.high};
  json["alternatives"] = Json::array();
  for (const Alternative& one : answer.alternatives) {
    Json alternative{{"fixed", values_json(one.fixed)},
                     {"gains", values_json(one.gains)},
                     {"rate", nullptr},
                     {"rate_low", nullptr},
                     {"status", nullptr},
                     {"criterion", nullptr}};
    if (one.verdict) {
      alternative["rate"] = one.verdict->moves.value;
      alternative["rate_low"] = one.verdict->moves.low;
      alternative["status"] = goal::text_of(one.verdict->status);
      alternative["criterion"] = finite_or_null(one.criterion);
    }
    json["alternatives"].push_back(std::move(alternative));
  }
  json["frontier"] = Json::array();
  for (const TriedPoint& one : answer.frontier) {
    Json values = Json::object();
    for (std::size_t i = 0; i < one.values.size(); ++i) values[answer.free[i].name] = one.values[i];
    json["frontier"].push_back({{"gains", values},
                                {"rate", one.estimate.rate},
                                {"criterion", finite_or_null(one.estimate.criterion)}});
  }
  json["limits"] = limits_array(answer.limits);
  json["worst"] = answer.worst ? object_of(*answer.worst) : Json();
  json["wider_band_rate"] = answer.wider_band_rate ? Json(*answer.wider_band_rate) : Json();
  json["searched"] = {{"points", answer.points},
                      {"trials", answer.trials},
                      {"seconds", answer.seconds},
                      {"converged", answer.converged}};
  return text::json_text(json);
}

std::string text_of(const TuneAnswer& answer, const study::Study& study, const std::string& output) {
  std::string text = fmt::format("goal: {}\n", goal::goal_sentence(*study.goal));
  const std::string searched = fmt::format("searched: {} points, {} trials, {:.0f} s{}\n", answer.points,
                                           answer.trials, answer.seconds,
                                           answer.converged ? ""
                                                            : "; the last generation still improved, "
                                                              "a larger --budget may find better values");
  if (!answer.proof) {
    return text +
           fmt::format("unreachable: none of {} points that were tried keeps the margins\n",
                       answer.examined) +
           searched + "tune.margins: {gain: …, phase: …, delay: …} makes them smaller, or off\n";
  }
  text += headline(answer) + "\n\n" + gains_table(answer) + other_units(answer, study) + "\n";
  for (const std::string& line : proof_lines(answer, study)) text += line + "\n";
  text += fmt::format("{}: {} by the proof{}\n", study.tuning->minimise, criterion_number(answer.criterion),
                      study.worlds > 0 ? ", of all worlds together" : "");
  if (answer.status != goal::Status::met && study.tuning->minimise.starts_with("band_settling_time"))
    text += fmt::format("  {:g} % of the moves{} would be within the band for good after {} s\n",
                        100.0 * study.goal->moves, study.worlds > 0 ? ", of all worlds together," : "",
                        criterion_number(answer.late_limit));
  if (answer.wider_band_rate)
    text += fmt::format("  within ±{} counts {:.4g} % of the {} would meet the goal\n", study.goal->band + 1,
                        100.0 * *answer.wider_band_rate, study.goal->machines ? "machines" : "moves");
  text += margins_text(answer, study.tuning->margins);
  if (answer.status == goal::Status::met) {
    text +=
        answer.delay_lost
            ? fmt::format("the goal seems lost at controller.delay = {:.3g} samples; it is {:g} here\n",
                          *answer.delay_lost, answer.delay)
            : fmt::format("the goal seems met up to 5 samples more of controller.delay; it is {:g} here\n",
                          answer.delay);
  }
  for (const std::string& edge : answer.at_edges) text += edge + ": values beyond may be better\n";
  if (answer.worst) text += worst_text(*answer.worst, study.rigs > 0);
  if (!answer.limits.empty())
    text += "\nwhat limits it, each by simulation on the machines of the search:\n\n" +
            limits_text(answer.limits, study.goal->machines.has_value(), study.worlds > 0);
  text += alternatives_text(answer);
  text += frontier_text(answer);
  return text + "\n" + searched + fmt::format("wrote {}: the proof, with the tuned manifest\n", output);
}

}  // namespace zerocount::tuning
