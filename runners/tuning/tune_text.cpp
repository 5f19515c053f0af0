#include "runners/tuning/tune_text.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/goal/goal_text.hpp"
#include "analysis/statistics/spread_over.hpp"
#include "analysis/text/report_json.hpp"
#include "analysis/text/text.hpp"
#include "core/loop/encoder.hpp"
#include "core/theory/gains.hpp"
#include "runners/tuning/limits_text.hpp"
#include "runners/tuning/worst_text.hpp"

namespace zerocount::tuning {
namespace {

using Json = nlohmann::ordered_json;

NamedValues named(const std::vector<study::FreeParameter>& free, const Values& values) {
  NamedValues named;
  for (std::size_t i = 0; i < values.size(); ++i) named.emplace_back(free[i].name, values[i]);
  return named;
}

Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

std::string_view word_of(goal::Status status) {
  return status == goal::Status::missed ? "unreachable" : goal::text_of(status);
}

std::string criterion_number(double value) {
  return std::isfinite(value) ? text::short_number(value) : "not within the hold";
}

/// "gain margin 7.2 dB (at least 6 wanted)".
std::string margin_text(const char* name, double margin, const char* unit,
                        const std::optional<double>& wanted) {
  return fmt::format("{} margin {}{} ({})", name, std::isfinite(margin) ? text::short_number(margin) : "∞",
                     unit, wanted ? fmt::format("at least {:g} wanted", *wanted) : "none wanted");
}

/// The loops that were examined.
std::string_view loops_text(const SmallestMargins& margins) {
  if (!margins.sliding) return " before they slide";
  return margins.before_sliding ? " before they slide and while they slide" : " while they slide";
}

std::string margins_text(const SmallestMargins& margins, const study::LoopMargins& wanted) {
  return fmt::format("{}, {}, {}", margin_text("gain", margins.gain, " dB", wanted.gain),
                     margin_text("phase", margins.phase, "°", wanted.phase),
                     margin_text("delay", margins.delay,
                                 margins.delay >= 10.0 ? " samples or more" : " samples", wanted.delay));
}

std::string margins_text(const TuneAnswer& answer, const study::LoopMargins& wanted) {
  if (answer.blind)
    return "margins: none, because the controller is a plugin, whose transfer function is not known\n";
  if (!answer.margins) return "";
  return fmt::format("smallest margins of {} machines{}: {}\n{}", answer.margins->machines,
                     loops_text(*answer.margins), margins_text(*answer.margins, wanted),
                     answer.margins->stable ? "" : "  the linear loop of a machine is unstable\n");
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
  for (std::size_t i = 0; i < answer.free.size(); ++i) {
    const study::FreeParameter& one = answer.free[i];
    columns[0].cells.push_back(one.name);
    columns[1].cells.push_back(text::short_number(answer.gains[i]));
    columns[2].cells.push_back(one.unit);
    columns[3].cells.push_back(
        fmt::format("{} … {}", text::short_number(one.low), text::short_number(one.high)));
  }
  return text::aligned_table(columns);
}

std::string room_table(const TuneAnswer& answer) {
  if (answer.room.empty()) return "";
  std::vector<text::TextColumn> columns{
      {"parameter", false, {}}, {"goal seems met from", true, {}}, {"to", true, {}}, {"unit", false, {}}};
  for (std::size_t i = 0; i < answer.room.size(); ++i) {
    columns[0].cells.push_back(answer.room[i].name);
    columns[1].cells.push_back(text::short_number(answer.room[i].low));
    columns[2].cells.push_back(text::short_number(answer.room[i].high));
    columns[3].cells.push_back(answer.free[i].unit);
  }
  return "\nroom of each parameter, the others as tuned:\n\n" + text::aligned_table(columns);
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
    columns[0].cells.push_back(one.name);
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
    columns[0].cells.push_back(criterion_number(one.estimate.criterion));
    columns[1].cells.push_back(fmt::format("{:.2f} %", 100.0 * one.estimate.rate));
    columns[2].cells.push_back(values_text(named(answer.free, one.values)));
  }
  return "\nsuccess and speed, by the search (its rates are a little too good):\n\n" +
         text::aligned_table(columns);
}

Json margins_json(const SmallestMargins& margins) {
  return {{"gain", finite_or_null(margins.gain)},
          {"phase", finite_or_null(margins.phase)},
          {"delay", margins.delay},
          {"stable", margins.stable},
          {"machines", margins.machines}};
}

/// The margins that the nearest point lacks, and by how much: dB, degrees, samples.
NamedValues lacking(const NearestPoint& nearest, const study::LoopMargins& wanted) {
  NamedValues lacking;
  if (!nearest.margins.stable) return lacking;
  const auto add = [&](const char* name, double found, const std::optional<double>& least) {
    if (least && found < *least) lacking.emplace_back(name, *least - found);
  };
  add("gain", nearest.margins.gain, wanted.gain);
  add("phase", nearest.margins.phase, wanted.phase);
  add("delay", nearest.margins.delay, wanted.delay);
  return lacking;
}

Json nearest_json(const TuneAnswer& answer, const study::LoopMargins& wanted) {
  if (!answer.nearest) return {};
  return {{"gains", values_json(named(answer.free, answer.nearest->values))},
          {"margins", margins_json(answer.nearest->margins)},
          {"lacking", values_json(lacking(*answer.nearest, wanted))}};
}

}  // namespace

std::string headline(const TuneAnswer& answer, const study::Study& study) {
  if (!answer.proof) {
    if (answer.status == goal::Status::undecided)
      return fmt::format(
          "undecided: of {} points that were tried some keep the margins, but the search lost them "
          "to faster ones that do not; a larger --budget may find them",
          answer.examined);
    return fmt::format("unreachable in these ranges: none of {} points that were tried keeps the margins",
                       answer.examined);
  }
  const bool of_machines = study.goal->machines.has_value();
  const goal::Verdict& verdict = answer.proof->verdict;
  switch (answer.status) {
    case goal::Status::met:
      return "met: the goal is met by these values";
    case goal::Status::missed:
      return fmt::format(
          "unreachable in these ranges: at the best values found {:.4g} % of the {}{} meet the goal, and at "
          "least {:g} % are wanted",
          100.0 * (of_machines ? verdict.machines.value : verdict.moves.value),
          of_machines ? "machines" : "moves", study.worlds > 0 ? " of the worst world" : "",
          100.0 * study.goal->machines.value_or(study.goal->moves));
    case goal::Status::undecided:
      break;
  }
  return "undecided: the trials of the proof do not decide whether the best values found meet the goal";
}

std::vector<std::string> nearest_lines(const TuneAnswer& answer, const study::Study& study) {
  if (!answer.nearest) return {};
  const SmallestMargins& margins = answer.nearest->margins;
  const std::string at = values_text(named(answer.free, answer.nearest->values));
  if (!margins.stable) {
    return {
        fmt::format("the loop of a machine is unstable at all of them; nearest, at {}, by {} of gain", at,
                    std::isfinite(margins.gain) ? text::short_number(margins.gain) + " dB" : "any factor")};
  }
  std::vector<std::string> lines{
      fmt::format("nearest: {}, with {}", at, margins_text(margins, study.tuning->margins))};
  for (const auto& [name, amount] : lacking(*answer.nearest, study.tuning->margins)) {
    lines.push_back(fmt::format("  its {} margin is {} {} too small", name, text::short_number(amount),
                                name == "gain"    ? "dB"
                                : name == "phase" ? "degrees"
                                                  : "samples"));
  }
  return lines;
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

std::string json_of(const TuneAnswer& answer, const study::Study& study) {
  Json json{{"status", word_of(answer.status)},
            {"gains", values_json(named(answer.free, answer.gains))},
            {"proof", nullptr}};
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
    json["margins"] = answer.margins ? margins_json(*answer.margins) : Json();
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
    json["frontier"].push_back({{"gains", values_json(named(answer.free, one.values))},
                                {"rate", one.estimate.rate},
                                {"criterion", finite_or_null(one.estimate.criterion)}});
  }
  json["limits"] = limits_array(answer.limits);
  json["worst"] = answer.worst ? worst_object(*answer.worst) : Json();
  json["wider_band_rate"] = answer.wider_band_rate ? Json(*answer.wider_band_rate) : Json();
  json["searched"] = {{"points", answer.points},
                      {"trials", answer.trials},
                      {"seconds", answer.seconds},
                      {"converged", answer.converged}};
  json["nearest"] = nearest_json(answer, study.tuning->margins);
  json["spent_trials"] = answer.spent_trials;
  json["left_out"] = answer.left_out;
  return text::json_text(json);
}

namespace {

/// "19986 of 20000 trials in 21 s", "14688 trials in 4 of 4 s".
std::string spent_text(const TuneAnswer& answer) {
  const TuneBudget& budget = answer.budget;
  return fmt::format("{}{} trials in {:.3g}{} s", answer.spent_trials,
                     budget.trials ? fmt::format(" of {}", *budget.trials) : "", answer.seconds,
                     budget.seconds ? fmt::format(" of {:g}", *budget.seconds) : "");
}

std::string effort_text(const TuneAnswer& answer) {
  std::string text =
      fmt::format("searched: {} points, {} trials{}\nspent: {}\n", answer.points, answer.trials,
                  answer.converged || answer.points == 0
                      ? ""
                      : "; the last generation still improved, a larger --budget may find better values",
                  spent_text(answer));
  if (answer.left_out.empty()) return text;
  return text + fmt::format("not found out, because the budget is not enough: {}\n",
                            fmt::join(answer.left_out, "; "));
}

/// The time after which the wanted proportion of moves are within the band for good.
std::string late_sentence(const TuneAnswer& answer, const study::Study& study) {
  const std::string moves = fmt::format("{:g} % of the moves{}", 100.0 * study.goal->moves,
                                        study.worlds > 0 ? " of all worlds together" : "");
  if (!std::isfinite(answer.late_limit))
    return fmt::format("  fewer than {} are within the band for good at the end of the hold\n", moves);
  return fmt::format("  {} are within the band for good after {} s\n", moves,
                     text::short_number(answer.late_limit));
}

/// "band_settling_time.p95 by the proof: 0.0385 s".
std::string criterion_sentence(const TuneAnswer& answer, const study::Study& study) {
  const std::string& unit = criterion_of(study).measure->field.column.unit;
  return fmt::format(
      "{} by the proof{}: {}{}\n", study.tuning->minimise, study.worlds > 0 ? ", of all worlds together" : "",
      criterion_number(answer.criterion),
      std::isfinite(answer.criterion) && unit != "1" && !unit.empty() ? " " + unit : std::string());
}

/// What the search and the examination of the loops say of a study without a proof.
std::string unproven_text(const TuneAnswer& answer, const study::Study& study) {
  std::string text;
  for (const std::string& line : nearest_lines(answer, study)) text += line + "\n";
  return text + effort_text(answer) +
         "no results file is written: there are no values to prove\n"
         "tune.margins: {gain: …, phase: …, delay: …} makes the margins smaller, or off\n";
}

}  // namespace

std::string proven_text(const TuneAnswer& answer, const study::Study& study, const std::string& output) {
  std::string text = fmt::format("goal: {}\n{}\n", goal::goal_sentence(*study.goal), headline(answer, study));
  if (!answer.proof) return text + unproven_text(answer, study);
  text += "\n" + gains_table(answer) + other_units(answer, study) + "\n";
  for (const std::string& line : proof_lines(answer, study)) text += line + "\n";
  text += criterion_sentence(answer, study);
  if (answer.status != goal::Status::met && study.tuning->minimise.starts_with("band_settling_time"))
    text += late_sentence(answer, study);
  for (const std::string& edge : answer.at_edges) text += edge + ": values beyond may be better\n";
  if (answer.worst) text += worst_text(*answer.worst, study);
  return text + fmt::format("wrote {}: the proof, with the tuned manifest\n", output);
}

std::string rest_text(const TuneAnswer& answer, const study::Study& study) {
  if (!answer.proof) return "";
  std::string text;
  if (answer.wider_band_rate)
    text += fmt::format("within ±{} counts {:.4g} % of the {} would meet the goal\n", study.goal->band + 1,
                        100.0 * *answer.wider_band_rate, study.goal->machines ? "machines" : "moves");
  text += margins_text(answer, study.tuning->margins);
  if (answer.delay_sought) {
    text +=
        answer.delay_lost
            ? fmt::format("the goal seems lost at controller.delay = {:.3g} samples; it is {:g} here\n",
                          *answer.delay_lost, answer.delay)
            : fmt::format("the goal seems met up to 5 samples more of controller.delay; it is {:g} here\n",
                          answer.delay);
  }
  text += room_table(answer) + alternatives_text(answer);
  if (!answer.limits.empty())
    text += "\nwhat limits it, each by simulation on the machines of the search:\n\n" +
            limits_text(answer.limits, goal::question_of(study));
  return text + frontier_text(answer) + "\n" + effort_text(answer);
}

}  // namespace zerocount::tuning
