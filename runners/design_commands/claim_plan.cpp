#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/statistics/clusters/machine_statistics.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/sample_size.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "experiments/study/setting_study.hpp"
#include "results/reading/all_trials_file.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"

namespace zerocount::design_commands {
namespace {

using document::Description;
using document::everywhere;
using document::in_data;
using statistics::ClaimPlan;
using statistics::MachinePlan;
using statistics::SequentialCost;

constexpr std::int64_t default_failures = 3;
constexpr double worst_case_rate = 0.5;

/// Options of the command `plan` for a claim about a rate or for its bounds; nothing where an option is
/// missing.
struct PlanRequest {
  double confidence{statistics::summary_confidence};
  std::optional<double> success{}, true_success{}, power{}, halfwidth{};
  std::optional<double> machine_sd{}, machines_share{};
  std::int64_t failures{default_failures};
  /// Text that names the pilot study from which machine_sd and the success rate are taken; empty: no pilot.
  std::string pilot{};

  double rate() const { return true_success.value_or(worst_case_rate); }
};

/// Success rates at a design point of a pilot study; if the pilot has settings (conditions at ages), in one
/// of them.
struct PilotPoint {
  std::string label;
  double rate{0.0};  ///< Success rate of the pilot's trials, 0 to 1.
  /// Standard deviation, between machines, of the probability that a trial of a machine succeeds.
  double machine_sd{0.0};
};

/// Design point and setting (condition at an age) of a pilot study at which the success rates of its machines
/// differ most. Nothing if no machine has several trials.
/// @param path results file of the pilot
std::optional<PilotPoint> worst_point(const std::string& path) {
  std::optional<PilotPoint> worst;
  const auto take = [&](const summary::StudySummary& summary, std::string_view setting) {
    for (std::size_t i = 0; i < summary.points.size(); ++i) {
      const measures::PointSummary& point = summary.points[i];
      const double sd = point.machines.success_sd;
      if (!std::isnan(sd) && (!worst || sd > worst->machine_sd))
        worst = {study::label_under(summary.labels[i], setting), point.success_rate().value, sd};
    }
  };
  const study::Study study = commands::described_study(path);
  if (study.settings.empty()) {
    take(summary::summarise_file(path), "");
    return worst;
  }
  const reading::AllTrialsFile file(path);
  for (std::int64_t i = 0; i < study.settings.total(); ++i)
    take(summary::summarise(file.in_setting(i)), study::label_of(study.settings, i));
  return worst;
}

/// Takes the standard deviation between machines and the success rate from the point of a pilot study whose
/// machines differ most, and stores them in the request.
void measure_pilot(PlanRequest& request, const std::string& path) {
  const std::optional<PilotPoint> worst = worst_point(path);
  if (!worst) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: has no differences between machines; expected the results of a study with "
                              "`machines` and several trials on each",
                              path));
  }
  if (!(worst->rate > 0.0 && worst->rate < 1.0)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: no point has both successes and failures; expected "
                                                   "--machine-sd and --true-success in place of a pilot",
                                                   path));
  }
  request.machine_sd = worst->machine_sd;
  if (!request.true_success) request.true_success = worst->rate;
  request.pilot = fmt::format("{}, point {}", path, text::printable(worst->label));
}

PlanRequest request_of(const command_line::Arguments& arguments) {
  const auto probability = [&](const char* option) {
    return command_line::probability_option(arguments, option);
  };
  PlanRequest request{.confidence = probability("confidence").value_or(statistics::summary_confidence),
                      .success = probability("success"),
                      .true_success = probability("true-success"),
                      .power = probability("power"),
                      .halfwidth = probability("halfwidth"),
                      .machine_sd = probability("machine-sd"),
                      .machines_share = probability("machines-share"),
                      .failures = arguments.whole_number("failures", 0, 1000).value_or(default_failures)};
  if (!request.success && !request.halfwidth) arguments.refuse("expected --success or --halfwidth");
  if (request.power && !request.success) arguments.refuse("option '--power' needs --success");
  if (arguments.operands().empty()) return request;
  if (request.machine_sd) arguments.refuse("expected --machine-sd or a pilot FILE, not both");
  if (!request.halfwidth) arguments.refuse("a pilot FILE needs --halfwidth");
  measure_pilot(request, arguments.operands()[0]);
  return request;
}

/// Numbers of trials and allowed failures that demonstrate a claim, with the probability that the claim is
/// demonstrated at the assumed true proportion.
struct ClaimRow {
  ClaimPlan plan;
  std::optional<double> chance{};
  std::optional<bool> has_power{};
};

/// The request for a plan, with the plans that answer it. Lists of plans that were not asked for are empty.
struct Plans : PlanRequest {
  std::vector<ClaimRow> claims{};
  std::vector<MachinePlan> tolerance{};
  std::vector<MachinePlan> halfwidth_on_machines{};
  std::optional<SequentialCost> halfwidth_without_machines{};
};

std::vector<ClaimRow> claim_plans(const PlanRequest& request) {
  std::vector<ClaimRow> rows;
  const auto add = [&](const ClaimPlan& plan) {
    ClaimRow& row = rows.emplace_back(ClaimRow{plan});
    if (!request.true_success) return;
    row.chance = statistics::chance_of_claim(plan.trials, plan.failures, *request.true_success);
    if (request.power) row.has_power = *row.chance >= *request.power;
  };
  for (std::int64_t failures = 0; failures <= request.failures; ++failures)
    add({failures, statistics::trials_for_claim(*request.success, request.confidence, failures)});
  if (!request.power) return rows;
  const ClaimPlan strong = statistics::plan_with_power(*request.success, request.confidence,
                                                       *request.true_success, *request.power);
  if (strong.failures > request.failures) add(strong);
  return rows;
}

std::vector<MachinePlan> halfwidth_plans(const PlanRequest& request) {
  constexpr std::array<std::int64_t, 8> listed_trials_per_machine{1, 2, 5, 10, 20, 50, 100, 1000};
  std::vector<MachinePlan> plans;
  plans.reserve(listed_trials_per_machine.size());
  for (const std::int64_t trials : listed_trials_per_machine) {
    plans.push_back({statistics::machines_for_halfwidth(*request.halfwidth, request.confidence,
                                                        request.rate(), *request.machine_sd, trials),
                     trials});
  }
  return plans;
}

/// Numbers of machines and of trials on each that demonstrate a tolerance statement (a proportion of all
/// machines succeeds with a given rate). More machines need fewer trials on each. The rank of the tolerance
/// statement rises in steps with the number of machines, so some larger numbers need more trials on each;
/// these are left out.
std::vector<MachinePlan> tolerance_plans(const PlanRequest& request) {
  const std::int64_t fewest =
      statistics::min_machines_for_tolerance(*request.machines_share, request.confidence);
  std::vector<MachinePlan> plans;
  for (const std::int64_t machines : {fewest, fewest + (fewest + 1) / 2, 2 * fewest, 4 * fewest}) {
    const MachinePlan plan =
        statistics::plan_tolerance(*request.machines_share, *request.success, request.confidence, machines);
    if (plans.empty() || plan.trials_per_machine < plans.back().trials_per_machine) plans.push_back(plan);
  }
  return plans;
}

Plans plans_of(PlanRequest request) {
  Plans plans{std::move(request)};
  if (plans.machines_share) {
    plans.tolerance = tolerance_plans(plans);
  } else if (plans.success) {
    plans.claims = claim_plans(plans);
  }
  if (plans.halfwidth && plans.machine_sd) plans.halfwidth_on_machines = halfwidth_plans(plans);
  if (plans.halfwidth && !plans.machine_sd)
    plans.halfwidth_without_machines =
        statistics::sequential_cost(*plans.halfwidth, plans.confidence, plans.rate());
  return plans;
}

// Items.

std::string with_confidence(const PlanRequest& request) {
  return fmt::format("with {} confidence", text::percent(request.confidence));
}

/// First line of the answer, about one plan: the first that has the wanted power, or else the plan without a
/// failure.
std::string claim_headline(const Plans& plans) {
  const std::vector<ClaimRow>& rows = plans.claims;
  const auto strong = std::ranges::find(rows, std::optional(true), &ClaimRow::has_power);
  const ClaimRow& row = strong == rows.end() ? rows.front() : *strong;
  return fmt::format(
      "{} trials, {}, show{} that at least {} of axes succeed, {}", row.plan.trials,
      row.plan.failures == 0 ? "none of which fails"
                             : fmt::format("at most {} of which fail", row.plan.failures),
      row.chance ? fmt::format(" with a probability of {}", text::percent_near(*row.chance)) : "",
      text::percent(*plans.success), with_confidence(plans));
}

std::string tolerance_headline(const Plans& plans) {
  const MachinePlan& fewest = plans.tolerance.front();
  return fmt::format(
      "{} machines with {} trials each, none of which fails, show that at least {} of machines hold zero in "
      "at least {} of moves, {}; trials of one move or more",
      fewest.machines, fewest.trials_per_machine, text::percent(*plans.machines_share),
      text::percent(*plans.success), with_confidence(plans));
}

std::string halfwidth_headline(const Plans& plans) {
  if (!plans.halfwidth) return "";
  const std::string aim =
      fmt::format("the {} bounds of a success rate of {} within ±{}", text::percent(plans.confidence),
                  text::percent(plans.rate()), text::percent(*plans.halfwidth));
  if (plans.halfwidth_without_machines)
    return fmt::format("{} trials bring {}{}", plans.halfwidth_without_machines->fixed, aim,
                       plans.true_success ? "" : ", the worst case");
  const std::vector<MachinePlan>& on_machines = plans.halfwidth_on_machines;
  return fmt::format("{} to {} machines bring {}, with a standard deviation of {} between machines{}",
                     on_machines.back().machines, on_machines.front().machines, aim,
                     text::percent(*plans.machine_sd), plans.pilot.empty() ? "" : " (" + plans.pilot + ")");
}

std::string halfwidth_sentence(const Plans& plans) {
  if (plans.halfwidth_without_machines)
    return "`stop` takes more: its bounds hold at whatever number of trials the outcomes let it end";
  if (plans.halfwidth_on_machines.empty()) return "";
  const double rate = plans.rate();
  return fmt::format(
      "more trials on a machine help little once they outnumber {:.3g}: what differs between machines "
      "remains",
      rate * (1.0 - rate) / (*plans.machine_sd * *plans.machine_sd));
}

Description<MachinePlan> plan_columns() {
  return Description<MachinePlan>()
      .value(everywhere("machine_count", "machines", "number of machines"), &MachinePlan::machines)
      .value(everywhere("trials_per_machine", "trials on each", "trials on each"),
             &MachinePlan::trials_per_machine)
      .value(everywhere("trials", "trials", "trials on all machines"),
             [](const MachinePlan& plan) { return plan.machines * plan.trials_per_machine; });
}

Description<ClaimRow> claim_columns() {
  return Description<ClaimRow>()
      .value(everywhere("failures", "failures at most", "failures at most"),
             [](const ClaimRow& row) { return row.plan.failures; })
      .value(everywhere("trials", "trials", "trials"), [](const ClaimRow& row) { return row.plan.trials; })
      .value(everywhere("chance", "chance to show it",
                        "probability that the plan shows the claim, if true_success is the proportion", "1"),
             &ClaimRow::chance)
      .value(everywhere("has_power", "power is enough",
                        "whether this probability is at least the power that is asked for"),
             &ClaimRow::has_power);
}

Description<Plans> halfwidth_description() {
  return Description<Plans>()
      .value(in_data("halfwidth", "half-width of the bounds", "1"),
             [](const Plans& p) { return *p.halfwidth; })
      .value(in_data("rate", "assumed rate", "1"), [](const Plans& p) { return p.rate(); })
      .value(in_data("machine_sd", "standard deviation of the success probability between machines", "1"),
             [](const Plans& p) { return p.machine_sd; })
      .table({.key = "machine_plans", .meaning = "machines and trials; none without machine_sd"},
             plan_columns(), &Plans::halfwidth_on_machines)
      .value(
          everywhere("trials", "trials, decided beforehand", "trials without machines, decided beforehand"),
          [](const Plans& p) {
            return p.halfwidth_without_machines ? std::optional(p.halfwidth_without_machines->fixed)
                                                : std::nullopt;
          })
      .value(everywhere("trials_with_stop", "trials with `stop`, about",
                        "trials without machines, decided by the outcomes"),
             [](const Plans& p) {
               return p.halfwidth_without_machines ? std::optional(p.halfwidth_without_machines->sequential)
                                                   : std::nullopt;
             })
      .sentence(halfwidth_sentence);
}

document::AnswerDescription<Plans> answer_named(const char* name, const char* meaning, const char* csv_table,
                                                std::string (*headline)(const Plans&)) {
  document::AnswerDescription<Plans> answer{{.name = name, .meaning = meaning, .csv_table = csv_table}, {}};
  answer.items.headline(headline).value(
      in_data("confidence", "confidence of the claim, or of the bounds", "1"), &Plans::confidence);
  return answer;
}

/// Adds to the answer the plans that bring the bounds of a rate within a half-width. They may be asked for
/// beside a claim.
document::AnswerDescription<Plans> with_halfwidth(document::AnswerDescription<Plans> answer) {
  answer.items.object(everywhere("halfwidth", "trials for these bounds", "plan of the bounds of a rate"),
                      halfwidth_description(),
                      [](const Plans& plans) { return plans.halfwidth ? &plans : nullptr; });
  return answer;
}

document::AnswerDescription<Plans> success_answer() {
  document::AnswerDescription<Plans> answer = answer_named(
      "plan-success", "trials that show a proportion of successful axes", "plans", claim_headline);
  answer.items.value(in_data("success", "proportion of axes to be shown to succeed", "1"), &Plans::success)
      .value({"true_success", "assumed true proportion", "assumed true proportion", "1",
              document::Notation::given_percent},
             &Plans::true_success)
      .value(in_data("power", "probability that is asked for", "1"), &Plans::power)
      .table({.key = "plans", .meaning = "plans by the number of failures"}, claim_columns(), &Plans::claims)
      .sentence(halfwidth_headline);
  return with_halfwidth(std::move(answer));
}

document::AnswerDescription<Plans> machines_answer() {
  document::AnswerDescription<Plans> answer =
      answer_named("plan-machines", "machines and trials that show a proportion of successful machines",
                   "machine_plans", tolerance_headline);
  answer.items
      .value(in_data("success", "proportion of its moves in which a machine holds zero", "1"),
             &Plans::success)
      .value(in_data("machines_share", "proportion of machines to be shown to succeed", "1"),
             &Plans::machines_share)
      .table({.key = "machine_plans", .meaning = "machines and trials, if no trial fails"}, plan_columns(),
             &Plans::tolerance)
      .sentence(halfwidth_headline);
  return with_halfwidth(std::move(answer));
}

document::AnswerDescription<Plans> halfwidth_answer() {
  return with_halfwidth(answer_named("plan-halfwidth",
                                     "trials that bring the bounds of a rate within a half-width", "",
                                     halfwidth_headline));
}

}  // namespace

document::Answer claim_plan(const command_line::Arguments& arguments) {
  const Plans plans = plans_of(request_of(arguments));
  return (plans.machines_share ? machines_answer()
          : plans.success      ? success_answer()
                               : halfwidth_answer())
      .of(plans);
}

std::vector<document::AnswerType> claim_plan_types() {
  return {success_answer().complete_type(), machines_answer().complete_type(),
          halfwidth_answer().complete_type()};
}

}  // namespace zerocount::design_commands
