#include "runners/result_commands/report_parts.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/document/blocks.hpp"
#include "analysis/report/page.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "core/failure/failure.hpp"
#include "runners/commands/command.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/tuning/tune_plan.hpp"

namespace zerocount::result_commands {
namespace {

/// The design point that the report describes, with its study and summary.
struct ReportedPoint {
  const reading::AllTrialsFile& file;
  const summary::StudySummary& summary;
  summary::ChosenPoint chosen;

  const study::Study& study() const { return file.study(); }
  std::string name() const { return file.path().string(); }
};

/// An answer, with a title that tells it from the others if a part of the report has several; otherwise
/// empty.
struct TitledAnswer {
  std::string title;
  document::Answer answer;
};
using Answers = std::vector<TitledAnswer>;

Answers limits_part(const ReportedPoint& asked, const trials::Effort& effort) {
  return {{"", design_commands::causes_answer(asked.study(), asked.chosen.point, effort)}};
}

Answers worst_part(const ReportedPoint& asked, const trials::Effort& effort) {
  return {{"", design_commands::worst_of(asked.study(), asked.chosen.point, effort)}};
}

Answers learn_part(const ReportedPoint& asked, const trials::Effort&) {
  return {{"", learned_of(asked.name(), asked.summary, asked.chosen)}};
}

/// Index of the world in which the goal's success rate is lowest (a world is one draw of the values that all
/// machines share and nobody knows); nothing without worlds.
std::optional<std::int64_t> worst_world(const ReportedPoint& asked) {
  const study::Study& study = asked.study();
  if (study.worlds == 0) return std::nullopt;
  if (!asked.summary.question.goal())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: without a goal it is not known which of its worlds is the worst; "
                              "'zerocount rare' is asked of one with --world",
                              asked.name()));
  const goal::Verdict verdict = summary::judge_point(asked.summary, asked.chosen).verdict;
  return static_cast<std::int64_t>(goal::worst_worlds_first(study.goals[verdict.goal], verdict).front());
}

/// Answers of the part `rare` of the report: the probability that a move fails, as estimated for rare
/// failures. One answer for each setting (condition at an age); a single answer without settings. With worlds
/// (draws of the values that nobody knows): only in the worst world.
Answers rare_part(const ReportedPoint& asked, const trials::Effort& effort) {
  const study::Study& study = asked.study();
  const std::optional<std::int64_t> world = worst_world(asked);
  const std::string in_world = world ? fmt::format("In world {}, the worst", *world) : "";
  if (study.settings.empty())
    return {{in_world, design_commands::rare_of(study, {asked.chosen.point, world, {}}, effort)}};
  Answers answers;
  const auto settings = study.settings.total();
  for (std::int64_t i = 0; i < settings; ++i) {
    answers.push_back(
        {fmt::format("{}{}Under condition {}", in_world, world ? ". " : "",
                     study::label_of(study.settings, i)),
         design_commands::rare_of(study, {asked.chosen.point, world, i}, effort.part(settings - i))});
  }
  return answers;
}

struct Part {
  std::string_view name;
  const char* question;
  bool judges_moves;  ///< Whether the part simulates moves that are judged, so that the study needs targets.
  Answers (*answer)(const ReportedPoint&, const trials::Effort&);
  /// Approximate or maximum number of trials that the part simulates.
  std::int64_t (*trials)(const ReportedPoint&);
};

constexpr std::array<Part, 4> all_parts{{
    {"limits", "What limits it?", true, limits_part,
     [](const ReportedPoint& a) { return design_commands::trials_of_causes(a.study(), a.chosen.point); }},
    {"worst", "Which machine does it suit worst?", true, worst_part,
     [](const ReportedPoint& a) {
       return tuning::trials_of_worst_machines(a.study(), trials::replicates_of(a.study(), a.chosen.point));
     }},
    {"learn", "Which unknown should be measured next?", false, learn_part,
     [](const ReportedPoint&) { return std::int64_t{0}; }},
    {"rare", "How often does a move fail that plain trials do not show?", true, rare_part,
     [](const ReportedPoint& a) { return design_commands::usual_rare_trials * a.study().settings.total(); }},
}};

const Part& part_named(std::string_view name) {
  return *std::ranges::find(all_parts, name, &Part::name);
}

std::string all_names() {
  std::vector<std::string_view> names;
  names.reserve(all_parts.size());
  for (const Part& part : all_parts) names.push_back(part.name);
  return fmt::format("{}", fmt::join(names, ","));
}

/// Section of the report with the answers of a part, as HTML and figures.
report::PageSection section_of(const Part& part, const Answers& answers) {
  report::PageSection section{std::string(part.name), part.question, "", {}};
  for (const auto& [title, answer] : answers) {
    report::PageSection one = report::answer_section("", "", answer);
    if (!title.empty()) section.html += fmt::format("<h3>{}</h3>\n", document::markup(title));
    section.html += one.html;
    for (report::Figure& figure : one.figures) {
      // The names of the figures of a page differ.
      if (!section.figures.empty()) figure.name += fmt::format("-{}", section.figures.size() + 1);
      if (!title.empty()) figure.title = title + ": " + figure.title;
      section.figures.push_back(std::move(figure));
    }
  }
  return section;
}

/// Section of the report with the answers of a part. If it cannot be answered, the section shows the reason.
report::PageSection answered(const Part& part, const ReportedPoint& asked, const trials::Effort& effort) {
  const auto stopped = [&] {
    return std::string(effort.is_interrupted() ? "interrupted" : "the budget is not enough");
  };
  std::string missing;
  try {
    if (effort.is_interrupted()) throw trial::Interrupted{};
    if (part.judges_moves) {
      commands::require_simulable(asked.file);
      goal::require_targets(asked.study(), asked.name());
    }
    return section_of(part, part.answer(asked, effort));
  } catch (const Failure& failure) {
    if (failure.code() == ExitCode::machine_failed) throw;
    missing = failure.code() == ExitCode::interrupted ? stopped() : failure.what();
  } catch (const trials::Spent&) {
    missing = stopped();
  } catch (const trial::Interrupted&) {
    missing = stopped();
  }
  return {std::string(part.name),
          part.question,
          fmt::format("<p class=\"warning\">Left out: {}</p>\n", document::markup(missing)),
          {}};
}

/// Speed with which this computer simulates the study, trials/s; nothing if it cannot be measured.
std::optional<double> speed_of(const ReportedPoint& asked, const trials::Effort& effort) {
  try {
    commands::require_simulable(asked.file);
    return tuning::measured_speed(asked.study(), effort);
  } catch (const Failure&) {
    return std::nullopt;
  } catch (const trial::Interrupted&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<command_line::OptionSpec> part_options() {
  std::vector<std::string> words{"all"};
  for (const Part& part : all_parts) words.emplace_back(part.name);
  return {
      command_line::list_of(
          std::move(words),
          {"with", "PARTS", "add answers of other commands: all, or some of " + all_names()}),
      command_line::needing(
          {"with"}, {"budget", "B",
                     "budget of these answers together: a number of trials, or a time such as 60s or 5min"})};
}

std::vector<std::string_view> parts_option(const command_line::Arguments& arguments) {
  const std::optional<std::string> text = arguments.value("with");
  std::vector<std::string> asked;
  if (text) {
    std::istringstream names(*text);
    for (std::string name; std::getline(names, name, ',');) asked.push_back(name);
  }
  const auto wants = [&](std::string_view name) { return std::ranges::find(asked, name) != asked.end(); };
  for (const std::string& name : asked) {
    if (name != "all" && std::ranges::find(all_parts, name, &Part::name) == all_parts.end())
      arguments.refuse(
          fmt::format("option '--with': '{}' is not a part; expected all, or some of {}", name, all_names()));
  }
  std::vector<std::string_view> parts;
  for (const Part& part : all_parts) {
    if (wants(part.name) || wants("all")) parts.push_back(part.name);
  }
  if (text && parts.empty()) arguments.refuse("option '--with': expected all, or some of " + all_names());
  return parts;
}

std::vector<report::PageSection> part_sections(const PartsSubject& subject,
                                               const std::vector<std::string_view>& names,
                                               const command_line::Budget& budget,
                                               const std::stop_token& stop) {
  std::vector<report::PageSection> sections;
  if (names.empty()) return sections;
  const summary::StudySummary summary = summary::summarise(subject.file);
  const ReportedPoint asked{subject.file, summary, summary::choose_point(summary, subject.point)};
  const trials::Effort effort = trials::Effort(stop).limited_to(budget.trials, budget.seconds);
  const bool simulates =
      std::ranges::any_of(names, [&](std::string_view name) { return part_named(name).trials(asked) > 0; });
  const std::optional<double> speed = simulates ? speed_of(asked, effort) : std::nullopt;
  const auto seconds_of = [&](std::string_view name) {
    const auto trials = std::min(part_named(name).trials(asked), effort.trials_left());
    return std::min(static_cast<double>(trials) / *speed, effort.seconds_left());
  };
  if (speed) {
    std::vector<std::string> each;
    double all = 0.0;
    for (const std::string_view name : names) {
      all += seconds_of(name);
      each.push_back(fmt::format("{} {}", name, status::duration_text(seconds_of(name))));
    }
    status::tell("the parts take at most {}: {}; Ctrl-C leaves out what remains\n",
                 status::duration_text(std::min(all, effort.seconds_left())), fmt::join(each, ", "));
  }
  status::StatusLine line;
  for (std::size_t i = 0; i < names.size(); ++i) {
    line.show([&] { return std::string(names[i]); });
    sections.push_back(answered(part_named(names[i]), asked, effort.part(i + 1 < names.size() ? 2 : 1)));
  }
  return sections;
}

}  // namespace zerocount::result_commands
