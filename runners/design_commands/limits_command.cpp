#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/statistics/distributions.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/trials/goal/goal_text.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "analysis/trials/theory/point_theory.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/stage_progress.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/status/progress.hpp"
#include "runners/tuning/effects/effects.hpp"
#include "runners/tuning/tune_plan.hpp"

namespace zerocount::design_commands {
namespace {

using document::everywhere;
using document::Notation;
using document::Visibility;
using tuning::Limit;

constexpr const char* limits_help =
    "Tells what stands between a point and its goal: the rate of the goal with each cause of\n"
    "failures switched off alone, and with the best pair of causes. Each parameter that has an ideal\n"
    "value is a cause where the point has another one: creep, friction's fall, delays, each error of\n"
    "encoder and converter, each disturbance and so on; and a rigid axis, a wider torque range, a\n"
    "finer converter and encoder, twice the sample rate, a feed-forward that fits, a faster profile,\n"
    "and control without filters or integral are tried. The gains are not tuned again.\n"
    "A cause is named where machines, or trials, gain by it more often than chance allows; the\n"
    "bound allows for the number of causes. Where nothing is missed, none is simulated. Then with\n"
    "effects added that a study may assume away: encoder noise, a sample of delay, and the lowest\n"
    "mode of the load that costs at most 1 %. All are simulated with the same random numbers, on all\n"
    "machines, or as many as --budget is enough for; a mode, which takes long, on the first.\n"
    "Without a goal the rate is that of moves that end at zero counts. Of several goals, conditions\n"
    "and ages each rate is that of the worst; --condition and --age choose one. Of several points\n"
    "--point chooses one.\n"
    "\n"
    "Example: zerocount limits my-axis.yaml\n";

/// Text such as "17 % fewer", which compares the failures with a cause switched off with those of the
/// unchanged point.
std::string failures_text(const Limit& limit) {
  if (!limit.avoided) return "";
  return fmt::format("{:.0f} % {}", std::abs(100.0 * *limit.avoided),
                     *limit.avoided >= 0.0 ? "fewer" : "more");
}

template <class Member>
auto gain_of(Member member) {
  return [member](const Limit& limit) {
    return limit.gain ? std::optional((*limit.gain).*member) : std::nullopt;
  };
}

/// Columns of a table of success rates with an effect switched off or added.
/// @param effect item of the first column, the name of the effect (Limit::effect)
document::Description<Limit> limit_columns(const document::Item& effect) {
  return document::Description<Limit>()
      .value(effect, &Limit::effect)
      .value(
          proportion(
              "rate", "rate",
              "proportion of moves, or of machines, that meet the question; unknown if it is not simulated"),
          &Limit::rate)
      .include(named_claim_columns("of goal", "condition or age"), &Limit::worst)
      .value({.key = "rates",
              .meaning = "the rates of all goals under all conditions, where there are several",
              .unit = "1",
              .shown = Visibility::in_json,
              .optional = true},
             &Limit::rates)
      .value({.heading = "failures", .shown = Visibility::to_people, .numeric = true}, failures_text)
      .value(
          optional(everywhere("gained", "gained",
                              "machines, or trials, that meet the worst goal more often without the cause")),
          gain_of(&tuning::PairedGain::gained))
      .value(optional(everywhere("lost", "lost", "machines, or trials, that meet it less often")),
             gain_of(&tuning::PairedGain::lost))
      .value(
          {.key = "p_value",
           .heading = "by chance",
           .meaning = "probability of as many gained if as many were to lose (sign test), for this row alone",
           .unit = "1",
           .notation = Notation::two_digits,
           .optional = true},
          gain_of(&tuning::PairedGain::p_value))
      .value({.key = "shown",
              .meaning = "whether it is shown to raise the rate, allowing for the number of causes",
              .shown = Visibility::in_json,
              .optional = true},
             gain_of(&tuning::PairedGain::shown))
      .value(document::to_people("shown to raise the rate"),
             [](const Limit& limit) { return limit.is_shown_cause() ? "yes" : ""; })
      .value(
          everywhere("note", "remark", "what the rate does not show, what is assumed, or why there is none"),
          [](const Limit& limit) { return limit.note.empty() ? std::nullopt : std::optional(limit.note); });
}

/// Text that names the effects which were not simulated: "; not simulated, for the reasons in their rows:
/// twice the sample rate".
std::string not_simulated_text(const std::vector<Limit>& limits) {
  std::vector<std::string> names;
  for (const Limit& one : limits)
    if (!one.rate) names.push_back(one.effect);
  return names.empty()
             ? ""
             : fmt::format("; not simulated, for the reasons in their rows: {}", fmt::join(names, ", "));
}

/// Sentence that says which causes were not tried, and whether there were too few machines to show a cause.
std::string causes_sentence(const std::vector<Limit>& limits) {
  std::int64_t tried = 0;
  std::int64_t machines = 0;
  for (const Limit& one : limits) {
    if (!one.gain) continue;
    ++tried;
    machines = one.gain->machines;
  }
  if (tried == 0) return "";
  const std::int64_t needed = tuning::machines_to_show_a_gain(tried);
  const tuning::ClaimNames& worst = limits.front().worst;
  std::vector<std::string> names;
  for (const std::optional<std::string>& name : {worst.goal, worst.setting})
    if (name) names.push_back(*name);
  return (names.empty()
              ? ""
              : fmt::format("gained, lost: in {}, the worst with nothing switched off; each rate is "
                            "that of the worst in its row\n",
                            fmt::join(names, ", "))) +
         (machines < needed
              ? fmt::format("{} machines cannot show a cause, at least {} can\n", machines, needed)
              : "") +
         fmt::format(
             "not tried: other values of {} that have no ideal one, other gains, another friction law{}",
             fmt::join(tuning::sections_with_other_values(), ", "), not_simulated_text(limits));
}

/// Figure of the success rates with each cause switched off, with none, and the rate that is asked for. No
/// figure if no cause was simulated, because nothing is missed.
std::vector<document::Figure> limits_figures(const std::vector<Limit>& limits) {
  using nlohmann::ordered_json;
  using report::datum;
  document::FigureData data{"limits",
                            {{"cause", "switched off", ""},
                             {"rate", "rate of the goal", "1"},
                             {"low", "lower 95 % bound", "1"},
                             {"high", "upper 95 % bound", "1"}}};
  if (limits.empty()) return {};
  for (const Limit& one : limits) {
    if (!one.rate) continue;
    // As if each machine, or trial, met or missed the goal as a whole.
    const statistics::ConfidenceInterval bounds =
        statistics::wilson_interval(*one.rate, static_cast<double>(one.estimate.machines),
                                    statistics::two_sided_normal_quantile(statistics::summary_confidence));
    data.rows.push_back({data.rows.empty() ? "nothing off" : one.effect, datum(*one.rate), datum(bounds.low),
                         datum(bounds.high)});
  }
  if (data.rows.size() < 2) return {};
  const document::FigureData lines{"lines",
                                   {{"rate", "", "1"}, {"line", "", ""}},
                                   {ordered_json::array({datum(*limits.front().rate), "as it is"}),
                                    ordered_json::array({limits.front().asked, "asked for"})}};
  return {report::figure_of(
      "tuning-limits", "tuning-limits", "What limits it?",
      "The rate of the goal with a cause of failures switched off, on the same machines with the same random "
      "numbers, with 95 % bounds of a machine's chance. A bar that ends far above the rate as it is names "
      "what to improve; what the goal asks for is dashed.",
      {std::move(data), lines})};
}

struct PointLimits {
  const study::Study& study;
  trials::Replicates machines;
  std::vector<Limit> limits;
  std::vector<Limit> additions;
};

/// Sentence that says how many machines and trials were simulated.
std::string simulated_sentence(const PointLimits& found) {
  const std::int64_t all = trials::replicates_of(found.study, found.machines.point).count;
  const std::string machines = std::string(found.study.machines > 0 ? "machines" : "trials") +
                               " of the study" +
                               (found.study.settings.empty() ? "" : " under each condition");
  return (found.machines.count < all
              ? fmt::format("simulated: the first {} of {} {}, as many as the budget is enough for",
                            found.machines.count, all, machines)
              : fmt::format("simulated: the {} {}", all, machines)) +
         ", in each row with the same random numbers; pairs of causes first on some of them";
}

/// Sentence that names the control loops which are unstable or too slow by the linear theory; empty unless
/// most moves miss the goal. Perhaps switching off a cause does not help then.
std::string theory_sentence(const PointLimits& found) {
  constexpr double most = 0.5;
  if (found.limits.front().holds || found.limits.front().rate.value_or(0.0) > most) return "";
  const tuning::ClaimPlace worst = tuning::place_of_claim(found.study, found.limits.front().estimate.worst);
  std::vector<theory::KnownRotor> rotors;
  std::vector<std::string> objections;
  for (const theory::LoopRanges& loop :
       theory::examine(found.study, found.machines.point, static_cast<std::int64_t>(worst.setting), rotors)
           .loops) {
    const std::string stability = theory::stability_text(loop);
    if (stability != "stable") objections.push_back(fmt::format("{}: {}", loop.name, stability));
  }
  return objections.empty()
             ? ""
             : fmt::format("by the linear theory (`zerocount check`), {}", fmt::join(objections, "; "));
}

/// First line of the answer, such as "96.5 % of the moves meet the goal; with no delay 100 %".
std::string limits_headline(const PointLimits& found) {
  const Limit& base = found.limits.front();
  const std::size_t worst = base.estimate.worst;
  const std::string rate =
      fmt::format("{} of the {}", text::percent_near(base.rate.value()), rated_words(found.study, worst));
  if (misses_nothing(base)) return rate + ": these trials show no limit";
  const Limit* const main = tuning::main_cause(found.limits);
  if (main == nullptr) return rate + "; no cause of failures is shown";
  std::string text =
      fmt::format("{}; with {} {}", rate, main->effect, text::percent_near(main->estimate.rates[worst]));
  if (main->estimate.worst != worst)
    text += fmt::format(", and the worst is then {} of the {}", text::percent_near(*main->rate),
                        rated_words(found.study, main->estimate.worst));
  return text;
}

document::AnswerDescription<PointLimits> limits_answer() {
  document::AnswerDescription<PointLimits> answer{
      {.name = "limits", .meaning = "what stands between a point and its goal", .csv_table = "limits"}, {}};
  answer.items.headline(limits_headline)
      .sentence(theory_sentence)
      .include(limits_description("with causes of failures switched off"), &PointLimits::limits)
      .table(everywhere("additions", "with an effect added that the study may assume away",
                        "rates with an effect added to those of the study"),
             limit_columns({.key = "effect", .heading = "added", .meaning = "effect that is added"}),
             &PointLimits::additions)
      .sentence(simulated_sentence);
  return answer;
}

/// Approximate number of times that `limits` simulates all the machines.
double runs_of(const study::Study& study, const trials::Replicates& machines) {
  constexpr double additions = 10.0;  // two, and the modes that are tried
  return tuning::runs_of_causes(study, machines.point, machines.count) + additions;
}

constexpr std::int64_t fewest_machines = 16;
constexpr double part_of_speed = 0.5;  // some causes double the samples, and the speed is a guess

/// As many machines of the study as the effort is enough for, at most all of them.
/// @throws trials::Spent if these are too few to show anything
trials::Replicates affordable_machines(const study::Study& study, std::int64_t point,
                                       const trials::Effort& effort) {
  trials::Replicates machines = trials::replicates_of(study, point);
  double speed = std::numeric_limits<double>::infinity();
  if (!std::isinf(effort.seconds_left())) speed = part_of_speed * tuning::measured_speed(study, effort);
  const std::int64_t trials = tuning::affordable_trials(effort, speed);
  const std::int64_t worlds = std::max<std::int64_t>(study.worlds, 1);
  constexpr int rounds = 3;  // pairs take a larger part of fewer machines
  for (int round = 0; round < rounds; ++round) {
    const double each = runs_of(study, machines) * static_cast<double>(machines.trials_each);
    const auto affordable = static_cast<std::int64_t>(static_cast<double>(trials) / each);
    if (affordable >= machines.count) return machines;
    machines.count = affordable / worlds * worlds;
    if (machines.count < fewest_machines) throw trials::Spent{};
  }
  return machines;
}

/// Failure for a budget that is too small, whose message names the smallest budget that is enough.
/// @throws trial::Interrupted if `stop` is requested
Failure too_small(const command_line::Budget& budget, const study::Study& study, std::int64_t point,
                  const std::stop_token& stop) {
  constexpr double margin = 1.5;  // the speed is measured anew, in a part of the time
  const std::int64_t worlds = std::max<std::int64_t>(study.worlds, 1);
  trials::Replicates machines = trials::replicates_of(study, point);
  machines.count = std::min(machines.count, (fewest_machines + worlds - 1) / worlds * worlds);
  const double trials = std::ceil(runs_of(study, machines) * static_cast<double>(machines.trials()));
  const std::string least =
      budget.trials ? fmt::format("{:.0f} trials", trials)
                    : fmt::format("about {:.2g} s",
                                  margin * trials / (part_of_speed * tuning::measured_speed(study, stop)));
  return {budget.trials ? ExitCode::bad_input : ExitCode::inconclusive,
          fmt::format("option '--budget': it is not enough: the causes of failures of this point take about "
                      "{} trials on all its {}; expected {} or more, for the first {}",
                      trials_of_causes(study, point), study.machines > 0 ? "machines" : "trials", least,
                      machines.count)};
}

ExitCode limits(const command_line::Arguments& arguments) {
  const ExaminedPoint examined = point_to_examine(arguments);
  const command_line::Budget budget = command_line::budget_option(arguments);
  const status::InterruptionWatch interruption(status::InterruptionWatch::Unstopped::end);
  const trials::Effort effort =
      trials::Effort(interruption.token()).limited_to(budget.trials, budget.seconds);
  commands::StageProgress progress("zerocount limits", false);
  std::optional<document::Answer> answer;
  const bool ended = unless_interrupted([&] {
    return trials::within(effort, [&] {
      answer = causes_answer(examined.study, examined.point, effort,
                             [&](const std::string& stage) { progress.enter(stage); });
    });
  });
  if (ended) return answers::print(arguments, *answer);
  throw too_small(budget, examined.study, examined.point, interruption.token());
}

}  // namespace

document::Answer causes_answer(const study::Study& study, std::int64_t point, const trials::Effort& effort,
                               const tuning::TellStage& tell) {
  if (tell) tell("the point as it is");
  const trials::Replicates machines = affordable_machines(study, point, effort);
  const tuning::EffectRuns runs(study, machines, effort);
  std::vector<Limit> found = tuning::find_causes(runs, tell);
  std::vector<Limit> additions;
  if (!trials::within(effort, [&] { additions = tuning::additions_to(runs, tell); }))
    additions = {{"what a study may assume away", std::nullopt, "the budget ended"}};
  return limits_answer().of({study, machines, std::move(found), std::move(additions)});
}

std::int64_t trials_of_causes(const study::Study& study, std::int64_t point) {
  const trials::Replicates machines = trials::replicates_of(study, point);
  return std::llround(runs_of(study, machines) * static_cast<double>(machines.trials()));
}

std::string rated_words(const study::Study& study, std::size_t claim) {
  const tuning::ClaimPlace place = tuning::place_of_claim(study, claim);
  const goal::Question question = only(goal::question_of(study), place.goal);
  return fmt::format("{} {}{}{}{}", goal::is_of_machines(question) ? "machines" : "moves",
                     goal::meeting_predicate(question),
                     study.goals.empty() ? "" : goal::of_mass(study.goals[place.goal]),
                     claim_text(study, place), question.worlds > 0 ? " in the worst world" : "");
}

document::Description<std::vector<Limit>> limits_description(const std::string& title) {
  return document::Description<std::vector<Limit>>()
      .table({.key = "limits",
              .heading = title,
              .meaning = "rates with each cause of failures switched off, that with none of them first"},
             limit_columns({.key = "cause",
                            .heading = "switched off",
                            .meaning = "cause of failures that is switched off"}),
             std::identity())
      .sentence(causes_sentence)
      .figures(limits_figures);
}

commands::Command limits_command() {
  return {{"limits",
           "MANIFEST|FILE",
           {answers::format_option(),
            named_point_option(),
            condition_option(),
            age_option(),
            set_option(),
            {"budget", "B", "budget of all simulations: a number of trials, or a time such as 60s or 5min"}}},
          "what stands between a point and its goal",
          limits_help,
          limits,
          [] { return std::vector{limits_answer().complete_type()}; }};
}

}  // namespace zerocount::design_commands
