#include <utility>
#include <vector>

#include "runners/answers/answer_format.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"

namespace zerocount::design_commands {
namespace {

constexpr const char* plan_help =
    "Prints how many trials a claim needs. With a MANIFEST or a PILOT alone: the machines and trials\n"
    "that can meet the goal of the manifest, if no move misses it; or that decide it with a probability\n"
    "of 90 %, by what the pilot's results leave likely.\n"
    "--success P: the number of trials that shows that at least the proportion P of axes succeeds,\n"
    "if none, one, two, … of the trials fail; with --true-success also the probability that the\n"
    "plan shows it, and with --power the plan that has this probability. --halfwidth H: the number\n"
    "of trials for bounds of a rate within ± H.\n"
    "With machines, the trials of one machine are not independent. --machines-share P: the number of machines, and\n"
    "of trials on each, that shows that at least the proportion P of all machines succeeds in --success\n"
    "of its trials. With --halfwidth, --machine-sd is the standard deviation of the success probability\n"
    "between machines: assumed, or measured in a pilot FILE with machines (at the point where it is largest;\n"
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
    "         zerocount plan --halfwidth 0.02 --machine-sd 0.1 --true-success 0.9\n"
    "         zerocount plan --halfwidth 0.02 pilot.h5\n"
    "         zerocount plan --success 0.97 --machines-share 0.9\n"
    "         zerocount plan --margin success_rate=0.02 --margin arrival_time=5% --power 0.9 gains.yaml\n";

document::Answer plan_answer(const command_line::Arguments& arguments) {
  const bool has_operand = !arguments.operands().empty();
  if (arguments.has("margin")) {
    if (!has_operand) arguments.refuse("option '--margin' needs a MANIFEST");
    return equivalence_plan(arguments);
  }
  if (!arguments.has("success") && !arguments.has("halfwidth") && has_operand) return goal_plan(arguments);
  if (arguments.has("set")) arguments.refuse("option '--set' needs a MANIFEST");
  return claim_plan(arguments);
}

ExitCode plan(const command_line::Arguments& arguments) {
  return answers::print(arguments, plan_answer(arguments));
}

std::vector<document::AnswerType> plan_types() {
  std::vector<document::AnswerType> types = goal_plan_types();
  for (document::AnswerType& type : claim_plan_types()) types.push_back(std::move(type));
  types.push_back(equivalence_plan_type());
  return types;
}

}  // namespace

commands::Command plan_command() {
  using command_line::excluding;
  using command_line::needing;
  return {
      {"plan",
       "[PILOT|MANIFEST]",
       {excluding({"margin"}, {"success", "P", "minimum proportion of successful axes to be shown"}),
        needing({"success", "halfwidth", "margin"},
                {"confidence", "LEVEL", "confidence of the claim, or of the bounds (default 0.95)"}),
        needing({"success"}, {"failures", "K", "list plans for 0 to K failures (default 3)"}),
        excluding(
            {"machines-share"},
            needing({"success", "halfwidth"},
                    {"true-success", "P", "assumed true proportion: adds the probability of each plan"})),
        excluding({"machines-share"},
                  needing({"true-success", "margin"}, {"power", "P", "find the plan with this probability"})),
        excluding({"margin"}, {"halfwidth", "H", "half-width of the two-sided bounds of a rate"}),
        needing({"success"},
                {"machines-share", "P",
                 "minimum proportion of machines to be shown to succeed in --success of their trials"}),
        needing({"halfwidth"},
                {"machine-sd", "SD", "standard deviation of the success probability between machines"}),
        {"margin", "MEASURE=M", "largest accepted difference of two equal studies; may be repeated", true},
        {"set", "KEY=VALUE", "with a MANIFEST: override a manifest key; may be repeated", true},
        answers::format_option()},
       0,
       1},
      "print how many trials a claim needs",
      plan_help,
      plan,
      plan_types};
}

}  // namespace zerocount::design_commands
