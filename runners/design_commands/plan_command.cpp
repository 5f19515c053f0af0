#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/rig_statistics.hpp"
#include "analysis/statistics/sample_size.hpp"
#include "analysis/summary/summary.hpp"
#include "analysis/text/percent.hpp"
#include "analysis/text/text.hpp"
#include "results/reading/study_file.hpp"
#include "runners/command_line/option_values.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/design_commands/equivalence_plan.hpp"
#include "runners/design_commands/goal_plan.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::design_commands {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* plan_help =
    "Prints how many trials a claim needs. With a MANIFEST or a PILOT alone: the rigs and trials\n"
    "that can meet the goal of the manifest, if no move misses it; or that decide it with a probability\n"
    "of 90 %, by what the pilot's results leave likely.\n"
    "--success P: the number of trials that shows that at least the proportion P of axes succeeds,\n"
    "if none, one, two, … of the trials fail; with --true-success also the probability that the\n"
    "plan shows it, and with --power the plan that has this probability. --halfwidth H: the number\n"
    "of trials for bounds of a rate within ± H.\n"
    "With rigs, the trials of one rig are not independent. --rigs-share P: the number of rigs, and\n"
    "of trials on each, that shows that at least the proportion P of all rigs succeeds in --success\n"
    "of its trials. With --halfwidth, --rig-sd is the standard deviation of the success probability\n"
    "between rigs: assumed, or measured in a pilot FILE with rigs (at the point where it is largest;\n"
    "that point also gives the rate).\n"
    "--margin MEASURE=M, with a MANIFEST: the number of trials with which 'zerocount compare' shows,\n"
    "with the probability --power, that two equal studies differ by less than M (a number, or\n"
    "PERCENT% of the measure), at all points and for all --margin together; by a simulated pilot.\n"
    "\n"
    "Example: zerocount plan gains.yaml\n"
    "         zerocount plan pilot.h5\n"
    "         zerocount plan --success 0.999 --confidence 0.95\n"
    "         zerocount plan --success 0.99 --true-success 0.995 --power 0.9\n"
    "         zerocount plan --halfwidth 0.005\n"
    "         zerocount plan --halfwidth 0.02 --rig-sd 0.1 --true-success 0.9\n"
    "         zerocount plan --halfwidth 0.02 pilot.h5\n"
    "         zerocount plan --success 0.97 --rigs-share 0.9\n"
    "         zerocount plan --margin success_rate=0.02 --margin settling_time=5% --power 0.9 gains.yaml\n";

constexpr std::int64_t default_failures = 3;
constexpr double worst_case_rate = 0.5;

/// The parsed options.
struct PlanRequest {
  double confidence{statistics::summary_confidence};
  std::optional<double> success, true_success, power, halfwidth;
  std::optional<double> rig_sd, rigs_share;
  std::int64_t failures{default_failures};
  std::string pilot;  ///< source of rig_sd and the rate, for the text

  double rate() const { return true_success.value_or(worst_case_rate); }
};

/// Takes the standard deviation and the rate from the point of a pilot study whose rigs differ most.
void measure_pilot(PlanRequest& request, const std::string& path) {
  const summary::StudySummary summary = summary::summarise_file(path);
  const measures::PointSummary* worst = nullptr;
  for (const measures::PointSummary& point : summary.points) {
    const double sd = point.rigs.success_sd;
    if (!std::isnan(sd) && (worst == nullptr || sd > worst->rigs.success_sd)) worst = &point;
  }
  if (worst == nullptr) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: has no differences between rigs; expected the results of a study with "
                              "`rigs` and several trials on each",
                              path));
  }
  const double rate = worst->success_rate().value;
  if (!(rate > 0.0 && rate < 1.0)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: no point has both successes and failures; expected "
                                                   "--rig-sd and --true-success in place of a pilot",
                                                   path));
  }
  request.rig_sd = worst->rigs.success_sd;
  if (!request.true_success) request.true_success = rate;
  request.pilot =
      fmt::format("{}, point {}", path,
                  text::printable(summary.labels[static_cast<std::size_t>(worst - summary.points.data())]));
}

PlanRequest request_of(const command_line::Arguments& arguments) {
  PlanRequest request;
  request.confidence =
      command_line::probability_option(arguments, "confidence").value_or(statistics::summary_confidence);
  request.success = command_line::probability_option(arguments, "success");
  request.true_success = command_line::probability_option(arguments, "true-success");
  request.power = command_line::probability_option(arguments, "power");
  request.halfwidth = command_line::probability_option(arguments, "halfwidth");
  request.failures = arguments.whole_number("failures", 0, 1000).value_or(default_failures);
  request.rigs_share = command_line::probability_option(arguments, "rigs-share");
  request.rig_sd = command_line::probability_option(arguments, "rig-sd");
  if (!arguments.operands().empty()) {
    if (request.rig_sd) arguments.refuse("expected --rig-sd or a pilot FILE, not both");
    if (!request.halfwidth) arguments.refuse("a pilot FILE needs --halfwidth");
    measure_pilot(request, arguments.operands()[0]);
  }
  if (request.rig_sd && !request.halfwidth) arguments.refuse("option '--rig-sd' needs --halfwidth");
  if (request.rigs_share && !request.success) arguments.refuse("option '--rigs-share' needs --success");
  if (request.rigs_share && (request.power || request.true_success))
    arguments.refuse("option '--rigs-share' plans without a failure: expected no --power or --true-success");
  if (!request.success && !request.halfwidth) arguments.refuse("expected --success or --halfwidth");
  if (request.power && !(request.success && request.true_success))
    arguments.refuse("option '--power' needs --success and --true-success");
  if (!request.success && arguments.has("failures")) arguments.refuse("option '--failures' needs --success");
  return request;
}

std::vector<statistics::ClaimPlan> plans_of(const PlanRequest& request) {
  std::vector<statistics::ClaimPlan> plans;
  if (!request.success) return plans;
  for (std::int64_t failures = 0; failures <= request.failures; ++failures)
    plans.push_back({failures, statistics::trials_for_claim(*request.success, request.confidence, failures)});
  if (!request.power) return plans;
  const statistics::ClaimPlan strong = statistics::plan_with_power(*request.success, request.confidence,
                                                                   *request.true_success, *request.power);
  if (strong.failures > request.failures) plans.push_back(strong);
  return plans;
}

/// Probability that the plan shows the claim, at the assumed true proportion.
double chance(const PlanRequest& request, const statistics::ClaimPlan& plan) {
  return statistics::chance_of_claim(plan.trials, plan.failures, *request.true_success);
}

/// Whether the plan has the requested power.
bool has_power(const PlanRequest& request, const statistics::ClaimPlan& plan) {
  return request.power && chance(request, plan) >= *request.power;
}

constexpr std::array<std::int64_t, 8> listed_trials_per_rig{1, 2, 5, 10, 20, 50, 100, 1000};

std::vector<statistics::RigPlan> halfwidth_plans(const PlanRequest& request) {
  std::vector<statistics::RigPlan> plans;
  plans.reserve(listed_trials_per_rig.size());
  for (const std::int64_t trials : listed_trials_per_rig) {
    plans.push_back({statistics::rigs_for_halfwidth(*request.halfwidth, request.confidence, request.rate(),
                                                    *request.rig_sd, trials),
                     trials});
  }
  return plans;
}

/// Plans in which more rigs need fewer trials on each. The rank of the tolerance statement rises in steps
/// with the number of rigs, so that some larger numbers need more trials on each: these are left out.
std::vector<statistics::RigPlan> tolerance_plans(const PlanRequest& request) {
  const std::int64_t fewest = statistics::min_rigs_for_tolerance(*request.rigs_share, request.confidence);
  std::vector<statistics::RigPlan> plans;
  for (const std::int64_t rigs : {fewest, fewest + (fewest + 1) / 2, 2 * fewest, 4 * fewest}) {
    const statistics::RigPlan plan =
        statistics::plan_tolerance(*request.rigs_share, *request.success, request.confidence, rigs);
    if (plans.empty() || plan.trials_per_rig < plans.back().trials_per_rig) plans.push_back(plan);
  }
  return plans;
}

Json rig_plans_json(const std::vector<statistics::RigPlan>& plans) {
  Json json = Json::array();
  for (const statistics::RigPlan& plan : plans) {
    json.push_back({{"rigs", plan.rigs},
                    {"trials_per_rig", plan.trials_per_rig},
                    {"trials", plan.rigs * plan.trials_per_rig}});
  }
  return json;
}

std::string rig_plans_text(const std::vector<statistics::RigPlan>& plans) {
  std::vector<std::vector<std::string>> cells{{"rigs", "trials on each", "trials"}};
  for (const statistics::RigPlan& plan : plans) {
    cells.push_back({std::to_string(plan.rigs), std::to_string(plan.trials_per_rig),
                     std::to_string(plan.rigs * plan.trials_per_rig)});
  }
  return text::aligned_table(cells, {true, true, true});
}

Json plan_json(const PlanRequest& request) {
  Json json{{"confidence", request.confidence}};
  if (request.rigs_share) {
    json["success"] = *request.success;
    json["rigs_share"] = *request.rigs_share;
    json["rig_plans"] = rig_plans_json(tolerance_plans(request));
  } else if (request.success) {
    json["success"] = *request.success;
    if (request.true_success) json["true_success"] = *request.true_success;
    if (request.power) json["power"] = *request.power;
    Json plans = Json::array();
    for (const statistics::ClaimPlan& plan : plans_of(request)) {
      Json entry{{"failures", plan.failures}, {"trials", plan.trials}};
      if (request.true_success) entry["chance"] = chance(request, plan);
      if (request.power) entry["has_power"] = has_power(request, plan);
      plans.push_back(std::move(entry));
    }
    json["plans"] = std::move(plans);
  }
  if (request.halfwidth) {
    json["halfwidth"] = {{"halfwidth", *request.halfwidth}, {"rate", request.rate()}};
    if (request.rig_sd) {
      json["halfwidth"]["rig_sd"] = *request.rig_sd;
      json["halfwidth"]["rig_plans"] = rig_plans_json(halfwidth_plans(request));
    } else {
      const statistics::SequentialCost cost =
          statistics::sequential_cost(*request.halfwidth, request.confidence, request.rate());
      json["halfwidth"]["trials"] = cost.fixed;
      json["halfwidth"]["trials_with_stop"] = cost.sequential;
    }
  }
  return json;
}

std::string claim_text(const PlanRequest& request) {
  std::vector<text::TextColumn> columns{{"failures at most", true, {}}, {"trials", true, {}}};
  if (request.true_success) columns.push_back({"chance to show it", true, {}});
  if (request.power) columns.push_back({"power", false, {}});
  for (const statistics::ClaimPlan& plan : plans_of(request)) {
    columns[0].cells.push_back(std::to_string(plan.failures));
    columns[1].cells.push_back(std::to_string(plan.trials));
    if (request.true_success) columns[2].cells.push_back(text::short_number(chance(request, plan)));
    if (request.power) columns[3].cells.push_back(has_power(request, plan) ? "enough" : "too little");
  }
  std::string text = fmt::format("to show that at least {} of axes succeed, with {} confidence\n\n{}",
                                 text::percent(*request.success), text::percent(request.confidence),
                                 text::aligned_table(columns));
  if (request.true_success)
    text += fmt::format("\nchance: if {} of axes succeed in truth\n", text::percent(*request.true_success));
  return text;
}

std::string tolerance_text(const PlanRequest& request) {
  return fmt::format(
      "to show that at least {} of rigs hold zero in at least {} of moves, with {} "
      "confidence\n\n{}\nif no trial fails; trials of one move or more\n",
      text::percent(*request.rigs_share), text::percent(*request.success), text::percent(request.confidence),
      rig_plans_text(tolerance_plans(request)));
}

std::string rig_halfwidth_text(const PlanRequest& request, double rate) {
  return fmt::format(
      "to bring the {} bounds of a success rate of {} within ±{}, with a standard deviation of "
      "{}\nbetween rigs{}\n\n{}\nmore trials on a rig help little once they outnumber "
      "{:.3g}: what differs between rigs remains\n",
      text::percent(request.confidence), text::percent(rate), text::percent(*request.halfwidth),
      text::percent(*request.rig_sd), request.pilot.empty() ? "" : " (" + request.pilot + ")",
      rig_plans_text(halfwidth_plans(request)), rate * (1.0 - rate) / (*request.rig_sd * *request.rig_sd));
}

std::string halfwidth_text(const PlanRequest& request) {
  const double rate = request.rate();
  if (request.rig_sd) return rig_halfwidth_text(request, rate);
  const statistics::SequentialCost cost =
      statistics::sequential_cost(*request.halfwidth, request.confidence, rate);
  return fmt::format(
      "{} trials bring the {} bounds of a rate of {} within ±{}{}\n"
      "with `stop`, which decides by the outcomes when to end, it takes about {}: {:.1f} times as "
      "many, because\nits bounds hold at whatever number of trials it ends\n",
      cost.fixed, text::percent(request.confidence), text::percent(rate), text::percent(*request.halfwidth),
      request.true_success ? "" : ", the worst case", cost.sequential, cost.ratio());
}

std::string plan_text(const PlanRequest& request) {
  std::string text;
  if (request.success) text += request.rigs_share ? tolerance_text(request) : claim_text(request);
  if (request.success && request.halfwidth) text += "\n";
  if (request.halfwidth) text += halfwidth_text(request);
  return text;
}

/// Refuses options of other questions beside --margin.
void require_equivalence_options(const command_line::Arguments& arguments) {
  for (const char* const option :
       {"success", "failures", "true-success", "halfwidth", "rigs-share", "rig-sd"}) {
    if (arguments.has(option))
      arguments.refuse(fmt::format("option '--{}' does not go with '--margin'", option));
  }
  if (arguments.operands().empty()) arguments.refuse("option '--margin' needs a MANIFEST");
}

ExitCode print_plan(const command_line::Arguments& arguments) {
  if (arguments.has("margin")) {
    require_equivalence_options(arguments);
    return print_equivalence_plan(arguments);
  }
  const bool asked = arguments.has("success") || arguments.has("halfwidth") || arguments.has("rigs-share");
  if (!asked && !arguments.operands().empty()) {
    for (const char* const option : {"power", "confidence", "failures", "true-success", "rig-sd"}) {
      if (arguments.has(option))
        arguments.refuse(
            fmt::format("option '--{}' has no effect on the plan of a goal: the goal has its own "
                        "confidence, and sizes are for a probability of 90 %",
                        option));
    }
    return print_goal_plan(arguments);
  }
  if (arguments.has("set")) arguments.refuse("option '--set' needs a MANIFEST");
  const std::string format = arguments.choice("format");
  const PlanRequest request = request_of(arguments);
  standard_output::write(format == "json" ? plan_json(request).dump(2) + "\n" : plan_text(request));
  return ExitCode::success;
}

}  // namespace

commands::Command plan_command() {
  return {
      {"plan",
       "[PILOT|MANIFEST]",
       {{"success", "P", "minimum proportion of successful axes to be shown"},
        {"confidence", "LEVEL", "of the claim, or of the bounds (default 0.95)"},
        {"failures", "K", "list plans for 0 to K failures (default 3)"},
        {"true-success", "P", "assumed true proportion: adds the probability of each plan"},
        {"power", "P", "find the plan with this probability"},
        {"halfwidth", "H", "half-width of the two-sided bounds of a rate"},
        {"rigs-share", "P", "minimum proportion of rigs to be shown to succeed in --success of their trials"},
        {"rig-sd", "SD", "standard deviation of the success probability between rigs"},
        {"margin", "MEASURE=M", "largest accepted difference of two equal studies; may be repeated", true},
        {"set", "KEY=VALUE", "with a MANIFEST: override a manifest key; may be repeated", true},
        command_line::format_option({"table", "json"})},
       0,
       1},
      "print how many trials a claim needs",
      plan_help,
      print_plan};
}

}  // namespace zerocount::design_commands
