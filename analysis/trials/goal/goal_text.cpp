#include "analysis/trials/goal/goal_text.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/statistics/clusters/machine_proportion.hpp"
#include "analysis/basis/statistics/proportion.hpp"
#include "analysis/basis/statistics/sample_size.hpp"
#include "analysis/basis/text/text.hpp"
#include "core/numerics/roots.hpp"
#include "core/text/text.hpp"
#include "experiments/parameters/study_units.hpp"
#include "results/layout/measure_table.hpp"

namespace zerocount::goal {
namespace {

/// Text of the bounds of a proportion: "at least 97.1 %, at most 98 %".
std::string with_bounds(const BoundedProportion& proportion) {
  return fmt::format("at least {}, at most {}", text::percent_at_least(proportion.low),
                     text::percent_at_most(proportion.high));
}

constexpr int goal_digits = 6;  // of what a goal asks for

/// Text of the error band or tolerance of a goal: "|error| ≤ 1 count", "|position error| ≤ 10 nm".
std::string band_text(const study::Goal& goal) {
  if (goal.tolerance)
    return fmt::format("|position error{}| ≤ ", of_mass(goal)) +
           text::quantity_text(*goal.tolerance, parameters::unit_on(goal.axis, "rad"), goal_digits);
  if (goal.band == 0) return "error 0" + of_mass(goal);
  return fmt::format("|error{}| ≤ {}", of_mass(goal), text::counted(goal.band, "count"));
}

/// Text of the value of a limit of a goal, with its unit: "200 counts", "45 N", "1 µm".
std::string value_text(const study::GoalLimit& limit, parameters::AxisKind axis) {
  study::StudyFeatures features{.axis = axis, .motion = true, .position_error = true};
  features.tolerances.count = 1;
  const auto stem = [](std::string_view name) { return name.substr(0, name.find('[')); };
  const auto measures = layout::measure_table(features);
  const auto measure = std::ranges::find_if(measures, [&](const layout::Measure& one) {
    return stem(one.field.column.name) == stem(limit.measure);
  });
  const std::string unit = measure == measures.end() ? "1" : measure->field.column.unit;
  return text::quantity_text(limit.limit.value, parameters::unit_on(axis, unit), goal_digits);
}

/// Text of the limits of a goal: ", overshoot ≤ 200 counts, peak_torque ≤ 45 N"; empty without limits.
std::string limits_text(const study::Goal& goal) {
  std::string text;
  for (const study::GoalLimit& limit : goal.limits)
    text += fmt::format(", {} {} {}", study::name_in(goal, limit.measure),
                        text::sign_of(limit.limit.relation), value_text(limit, goal.axis));
  return text;
}

/// Text that names the moves of a trial that the goal judges: "move 3", "moves 0, 1"; empty if it judges all.
std::string moves_text(const study::Goal& goal) {
  if (goal.on.empty()) return {};
  return fmt::format("move{} {}", goal.on.size() == 1 ? "" : "s", fmt::join(goal.on, ", "));
}

/// The name of the goal as the beginning of a line: "large: "; empty if the goal has no name.
std::string name_text(const study::Goal& goal) {
  return goal.name.empty() ? "" : goal.name + ": ";
}

std::string ending_of(trial::Outcome outcome, std::string_view of_mass) {
  switch (outcome) {
    case trial::Outcome::zero_count:
      return fmt::format("it ends at zero counts{}", of_mass);
    case trial::Outcome::one_count:
      return "it ends within one count of the target";
    case trial::Outcome::off_target:
      return "it ends more than one count away: stalled, or still moving to the target";
    case trial::Outcome::oscillating:
      return "it ends oscillating by more than one count";
    case trial::Outcome::nonfinite:
      return "it failed numerically";
    case trial::Outcome::open_loop:
      break;
  }
  return "it has no target";
}

/// The line indented by two blanks; an empty line stays empty.
std::string indented(const std::string& line) {
  return line.empty() ? line : "  " + line;
}

/// The number of machines in the counts, and the numbers of trials and moves of one machine.
/// @param counts counts of a study with machines
statistics::MachineStudy shape_of(const measures::MoveCounts& counts) {
  return {std::ssize(counts.machines), counts.machines.front().trials, counts.machines.front().moves};
}

/// Text of the proportions in the worst world, and of the number of worlds with each verdict.
std::string readings_of_worlds(const study::Goal& goal, const measures::MoveCounts& counts,
                               const ClaimVerdict& verdict) {
  const std::size_t worst = worst_worlds_first(goal, verdict).front();
  std::string text = fmt::format(
      "  it must hold in each of {} worlds: met in {}, missed in {}, undecided in {}\n",
      verdict.worlds.size(), worlds_that(Status::met, verdict).size(),
      worlds_that(Status::missed, verdict).size(), worlds_that(Status::undecided, verdict).size());
  if (goal.machines) {
    text += fmt::format("  machines that meet it: {} in world {}, the worst; in the worst of all {}\n",
                        text::percent_near(verdict.worlds[worst].machines.value), worst,
                        with_bounds(verdict.machines));
  }
  text +=
      fmt::format("  moves that meet it: {} in world {}, the worst; in the worst of all {}\n",
                  text::percent_near(verdict.worlds[worst].moves.value), worst, with_bounds(verdict.moves));
  return counts.machines.empty() ? text : text + indented(one_machine_text(goal, shape_of(counts), verdict));
}

/// One line with the number of machines that meet all claims together; empty if fewer than two claims are on
/// machines.
std::string together_text(const Question& question, const measures::PointSummary& point) {
  const auto all = machines_meeting_all(question, point);
  if (!all) return {};
  return fmt::format("  machines that meet all claims on machines together: {} of {}, as observed\n",
                     all->machines, all->of);
}

}  // namespace

std::string of_mass(const study::Goal& goal) {
  if (goal.of_either) return std::string(study::of_closing_mass({.motor_closes = true, .load_closes = true}));
  return goal.of ? fmt::format(" of the {}", study::mass_text(*goal.of)) : "";
}

std::string after_text(const study::TimeLimit& limit, const std::string& time) {
  return limit.after_profile ? time + " after the profile" : "after " + time;
}

std::string goal_sentence(const study::Goal& goal) {
  const std::string on = moves_text(goal);
  const std::string moves = on.empty() ? "the moves" : "the repetitions of " + on;
  const std::string machines =
      goal.machines
          ? fmt::format("{} of at least {} of machines", moves, text::percent(*goal.machines))
          : (on.empty() ? std::string("all moves") : "all repetitions of " + on) + " of all machines";
  return fmt::format("{}{} for good {}{} in at least {} of {}, with {} confidence", name_text(goal),
                     band_text(goal), after_text(goal.within, fmt::format("{:.4g} s", goal.within.time)),
                     limits_text(goal), text::percent(goal.moves), machines, text::percent(goal.confidence));
}

std::string claim_sentence(const Question& question) {
  std::vector<std::string> sentences;
  for (const JudgedCriterion& part : question.parts) sentences.push_back(goal_sentence(*part.goal));
  return fmt::format("{}", fmt::join(sentences, "; "));
}

std::string question_sentence(const Question& question) {
  if (!question.goal())
    return fmt::format("success: all moves of a trial end at zero counts{}", question.of_mass);
  return (has_several(question) ? "the goals: " : "the goal: ") + claim_sentence(question);
}

std::string doing_text(const Question& question) {
  if (!question.goal()) return fmt::format("end at zero counts{}", question.of_mass);
  return has_several(question) ? "meet the goals that are about them" : "meet the goal";
}

std::string missing_text(const Question& question) {
  if (!question.goal()) return fmt::format("does not end at zero counts{}", question.of_mass);
  if (has_several(question)) return "misses a goal";
  return fmt::format("misses the goal: {} for good {}{}", band_text(*question.goal()),
                     after_text(question.goal()->within, fmt::format("{} s", question.goal()->within.time)),
                     limits_text(*question.goal()));
}

std::string ending_text(const Question& question, std::span<const trial::MoveOutcome> moves) {
  if (!question.goal()) return ending_of(trial::worst_outcome(moves), question.of_mass);
  const auto is_asked = [&](const trial::MoveOutcome& move) {
    return std::ranges::any_of(
        question.parts, [&](const JudgedCriterion& part) { return measures::asks(part.criterion, move); });
  };
  const auto asked = std::ranges::count_if(moves, is_asked);
  const auto met = std::ranges::count_if(moves, [&](const trial::MoveOutcome& move) {
    return is_asked(move) && meets(question, {&move, 1});
  });
  return fmt::format("{} of {} move{} the goal{}", met, asked, asked == 1 ? " meets" : "s meet",
                     has_several(question) ? "s" : "");
}

std::string goals_text(const Question& question, const measures::PointSummary& point,
                       const Verdict& verdict) {
  const auto readings = [&](const JudgedCriterion& part, const ClaimVerdict& of_goal) {
    const measures::MoveCounts counts = point.goals[part.number].sum({.setting = of_goal.setting});
    return (question.settings.empty()
                ? ""
                : fmt::format(" {}, the worst:\n", under_text(question, of_goal.setting))) +
           readings_text(*part.goal, counts, of_goal) +
           (of_goal.of_load ? fmt::format("  of the load, {} of all moves meet it{}: {}\n",
                                          text::percent_near(of_goal.of_load->value),
                                          question.settings.empty()
                                              ? ""
                                              : under_text(question, of_goal.load_setting) + ", its worst",
                                          with_bounds(*of_goal.of_load))
                            : "");
  };
  if (!has_several(question))
    return readings(question.parts.front(), verdict) + together_text(question, point);
  std::string text;
  for (std::size_t goal = 0; goal < question.parts.size(); ++goal) {
    const JudgedCriterion& part = question.parts[goal];
    const ClaimVerdict& worst = worst_of_goal(verdict, goal);
    text += fmt::format("  {}{}\n{}", name_text(*part.goal), text_of(worst.status), readings(part, worst));
  }
  return text + together_text(question, point);
}

std::string readings_text(const study::Goal& goal, const measures::MoveCounts& counts,
                          const ClaimVerdict& verdict) {
  if (!verdict.worlds.empty()) return readings_of_worlds(goal, counts, verdict);
  std::string text = fmt::format("  of all moves of all machines, {} meet it: {} of {}, {}\n",
                                 text::percentage(counts.met, counts.moves), counts.met, counts.moves,
                                 with_bounds(verdict.moves));
  if (counts.machines.empty()) return text;
  const std::int64_t machines = std::ssize(counts.machines);
  const std::int64_t moves = counts.machines.front().moves;
  text += fmt::format("  machines without a miss in their {}: {} of {}", text::counted(moves, "move"),
                      verdict.machines_without_miss, machines);
  if (!goal.machines) return text + '\n';
  text += fmt::format("; {} of all machines\n", with_bounds(verdict.without_miss));
  text += fmt::format(
      "  machines that meet it in at least {} of their moves: {} of {} by their {}; {} of all "
      "machines\n",
      text::percent(goal.moves), verdict.machines_meeting, machines, text::counted(moves, "move"),
      with_bounds(verdict.machines));
  return text + indented(one_machine_text(goal, shape_of(counts), verdict));
}

std::string one_machine_text(const study::Goal& goal, const statistics::MachineStudy& study,
                             const ClaimVerdict& verdict) {
  if (!goal.machines || verdict.status != Status::undecided) return {};
  const double at_limit = statistics::chance_to_show(study, goal.moves, study.moves);
  if (at_limit <= 1.0 - goal.confidence) return {};
  const bool one_move_each = study.trials == study.moves;
  std::string text = fmt::format(
      "{}{} cannot show that one machine meets it in {} of its moves: {}{} without a miss can; a machine "
      "just below that has no miss in as few with a probability of {}{}",
      text::counted(study.moves, "move"), one_move_each ? "" : " in " + text::counted(study.trials, "trial"),
      text::percent(goal.moves), statistics::trials_for_claim(goal.moves, goal.confidence, 0),
      one_move_each ? "" : " trials", one_move_each ? "" : "up to ", text::percent_near(at_limit));
  if (!verdict.worlds.empty()) return text + '\n';
  // The lowest proportion at which all machines alike show so many without a miss.
  const auto can_be_alike = [&](double p) {
    return statistics::chance_to_show(study, p, study.moves) >= verdict.without_miss.low;
  };
  const double alike = numerics::bisect({goal.moves, 0.0}, can_be_alike, numerics::within(1e-9)).holds;
  const double shown = std::ceil(1e4 * alike) * 1e-4;
  if (verdict.machines_without_miss > 0 && at_limit >= verdict.without_miss.low && shown < goal.moves)
    text += fmt::format("; all {} machines that had none may be at {}", verdict.machines_without_miss,
                        text::percent(shown));
  return text + '\n';
}

std::string needs_sentence(const study::Goal& goal, const Needs& needs, bool on_machines) {
  const std::string chance = text::percent(probability_of_needs);
  if (needs.trials == 0) {
    return fmt::format(
        "The proportion is so close to the goal that no study of up to 10⁹ trials{} decides it with a "
        "probability of {}",
        on_machines ? " on 10⁵ machines" : "", chance);
  }
  if (needs.machines == 0)
    return fmt::format("About {} decide it with a probability of {}, judging by the present trials",
                       text::counted(needs.trials, "trial"), chance);
  const std::int64_t each = needs.trials / needs.machines;
  return fmt::format(
      "About {} with {} each decide it with a probability of {}, {}",
      text::counted(needs.machines, "machine"), text::counted(each, "trial"), chance,
      goal.machines ? "if other machines are like the present ones" : "judging by the present trials");
}

std::vector<std::string> status_words() {
  std::vector<std::string> words;
  for (const Status status : {Status::met, Status::missed, Status::undecided})
    words.emplace_back(text_of(status));
  return words;
}

document::Description<Needs> needs_description() {
  return document::Description<Needs>()
      .value(document::in_data("machine_count", "number of machines; 0 without machines"), &Needs::machines)
      .value(document::in_data("trials", "trials of a design point"), &Needs::trials);
}

document::Description<BoundedProportion> load_description() {
  return document::Description<BoundedProportion>()
      .value(document::in_data("of", "the mass"),
             [](const BoundedProportion&) { return study::mass_text(motion::EncoderPlace::load); })
      .value(
          document::in_data("rate", "proportion of its moves that meet the goal, with one-sided bounds", "1"),
          [](const BoundedProportion& rate) { return bounded(rate); });
}

const Needs* practicable(const std::optional<Needs>& needs) {
  return needs && needs->trials > 0 ? &*needs : nullptr;
}

}  // namespace zerocount::goal
