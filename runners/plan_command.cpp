#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/proportion.hpp"
#include "analysis/sample_size.hpp"
#include "analysis/text.hpp"
#include "runners/commands.hpp"
#include "runners/option_values.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* plan_help =
    "Says how many trials a claim needs, before they are run. With --success: how many show that at\n"
    "least this share of axes succeeds, if none, one, two, … of them fail; with --true-success also\n"
    "the chance that they do, and with --power the plan that has this chance. With --halfwidth: how\n"
    "many bring the bounds of a rate so close.\n"
    "\n"
    "Example: zerocount plan --success 0.999 --confidence 0.95\n"
    "         zerocount plan --success 0.99 --true-success 0.995 --power 0.9\n"
    "         zerocount plan --halfwidth 0.005\n";

constexpr std::int64_t default_failures = 3;
constexpr double worst_case_rate = 0.5;

/// What the words ask for.
struct PlanRequest {
  double confidence{summary_confidence};
  std::optional<double> success, true_success, power, halfwidth;
  std::int64_t failures{default_failures};
};

PlanRequest request_of(const Arguments& arguments) {
  PlanRequest request;
  request.confidence = probability_option(arguments, "confidence").value_or(summary_confidence);
  request.success = probability_option(arguments, "success");
  request.true_success = probability_option(arguments, "true-success");
  request.power = probability_option(arguments, "power");
  request.halfwidth = probability_option(arguments, "halfwidth");
  request.failures = arguments.whole_number("failures", 0, 1000).value_or(default_failures);
  if (!request.success && !request.halfwidth) arguments.refuse("expected --success or --halfwidth");
  if (request.power && !(request.success && request.true_success))
    arguments.refuse("option '--power' needs --success and --true-success");
  if (!request.success && arguments.has("failures")) arguments.refuse("option '--failures' needs --success");
  return request;
}

std::vector<ClaimPlan> plans_of(const PlanRequest& request) {
  std::vector<ClaimPlan> plans;
  if (!request.success) return plans;
  for (std::int64_t failures = 0; failures <= request.failures; ++failures)
    plans.push_back({failures, trials_for_claim(*request.success, request.confidence, failures)});
  if (!request.power) return plans;
  const ClaimPlan strong =
      plan_with_power(*request.success, request.confidence, *request.true_success, *request.power);
  if (strong.failures > request.failures) plans.push_back(strong);
  return plans;
}

/// The first plan with the power, if any is asked for.
bool has_power(const PlanRequest& request, const ClaimPlan& plan) {
  return request.power &&
         chance_of_claim(plan.trials, plan.failures, *request.true_success) >= *request.power;
}

Json plan_json(const PlanRequest& request) {
  Json json{{"confidence", request.confidence}};
  if (request.success) {
    json["success"] = *request.success;
    if (request.true_success) json["true_success"] = *request.true_success;
    if (request.power) json["power"] = *request.power;
    Json plans = Json::array();
    for (const ClaimPlan& plan : plans_of(request)) {
      Json entry{{"failures", plan.failures}, {"trials", plan.trials}};
      if (request.true_success)
        entry["chance"] = chance_of_claim(plan.trials, plan.failures, *request.true_success);
      if (request.power) entry["has_power"] = has_power(request, plan);
      plans.push_back(std::move(entry));
    }
    json["plans"] = std::move(plans);
  }
  if (request.halfwidth) {
    const double rate = request.true_success.value_or(worst_case_rate);
    json["halfwidth"] = {{"halfwidth", *request.halfwidth},
                         {"rate", rate},
                         {"trials", trials_for_halfwidth(*request.halfwidth, request.confidence, rate)}};
  }
  return json;
}

std::string claim_text(const PlanRequest& request) {
  std::vector<TextColumn> columns{{"failures at most", true, {}}, {"trials", true, {}}};
  if (request.true_success) columns.push_back({"chance to show it", true, {}});
  if (request.power) columns.push_back({"power", false, {}});
  for (const ClaimPlan& plan : plans_of(request)) {
    columns[0].cells.push_back(std::to_string(plan.failures));
    columns[1].cells.push_back(std::to_string(plan.trials));
    if (request.true_success)
      columns[2].cells.push_back(
          short_number(chance_of_claim(plan.trials, plan.failures, *request.true_success)));
    if (request.power) columns[3].cells.push_back(has_power(request, plan) ? "enough" : "too little");
  }
  std::string text =
      fmt::format("to show that at least {:.6g} % of axes succeed, with {:.6g} % confidence\n\n{}",
                  100.0 * *request.success, 100.0 * request.confidence, aligned_table(columns));
  if (request.true_success)
    text += fmt::format("\nchance: if {:.6g} % of axes succeed in truth\n", 100.0 * *request.true_success);
  return text;
}

std::string halfwidth_text(const PlanRequest& request) {
  const double rate = request.true_success.value_or(worst_case_rate);
  return fmt::format("{} trials bring the {:.6g} % bounds of a rate of {:.6g} % within ±{:.6g} %{}\n",
                     trials_for_halfwidth(*request.halfwidth, request.confidence, rate),
                     100.0 * request.confidence, 100.0 * rate, 100.0 * *request.halfwidth,
                     request.true_success ? "" : ", the worst case");
}

std::string plan_text(const PlanRequest& request) {
  std::string text;
  if (request.success) text += claim_text(request);
  if (request.success && request.halfwidth) text += "\n";
  if (request.halfwidth) text += halfwidth_text(request);
  return text;
}

ExitCode print_plan(const Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"table", "json"});
  const PlanRequest request = request_of(arguments);
  fmt::print("{}", format == "json" ? plan_json(request).dump(2) + "\n" : plan_text(request));
  return ExitCode::success;
}

}  // namespace

Command plan_command() {
  return {{"plan",
           "",
           0,
           0,
           {{"success", "P", "share of axes that is to be shown to succeed at least"},
            {"confidence", "LEVEL", "of the claim, or of the bounds (default 0.95)"},
            {"failures", "K", "list plans for 0 to K failures (default 3)"},
            {"true-success", "P", "share that succeeds in truth: says the chance of each plan"},
            {"power", "P", "find the plan with this chance"},
            {"halfwidth", "H", "half the distance of the two-sided bounds of a rate"},
            {"format", "FORMAT", "table (default) or json"}}},
          "say how many trials a claim needs",
          plan_help,
          print_plan};
}

}  // namespace zerocount
