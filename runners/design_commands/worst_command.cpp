#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/text/text.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/goal/question_text.hpp"
#include "core/text/text.hpp"
#include "experiments/yaml/text_file.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/timeline_option.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/status/progress.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

namespace zerocount::design_commands {
namespace {

using document::everywhere;
using document::in_data;
using tuning::JudgedMachine;
using tuning::WorstMachine;
using tuning::WorstMachines;

constexpr const char* worst_help =
    "Finds the machine that a gain suits worst: of the machines of the study, and in the box of the\n"
    "central 99.9 % of each quantity that differs between machines, where it is sought from the\n"
    "worst of the study, from the corners, and from points between them; then among the likely\n"
    "machines, whose normal scores have a sum of squares within the 99.9 % quantile. Each is judged\n"
    "by 256 trials of its own. -o writes the manifest of the worst machine of the box: its values\n"
    "are fixed, and `run` repeats these trials. With conditions and ages the search is made under\n"
    "each, and the answer is of the worst; --condition and --age choose one. Without a goal moves are\n"
    "to end at zero counts. Of several points --point chooses one.\n"
    "\n"
    "Example: zerocount worst my-axis.yaml -o worst.yaml\n";

struct Search {
  const study::Study& study;
  WorstMachines found;
  /// Path of the manifest to write for the worst machine; nothing: none is written.
  std::optional<std::filesystem::path> manifest{};
};

std::string headline(const Search& search) {
  const JudgedMachine& worst = search.found.in_box;
  return "worst in the box of the central 99.9 % of each input: " +
         (worst.is_previous ? fmt::format("none is worse than {} of the study",
                                          machine_name(search.found.of_study, search.study.machines > 0))
                            : fmt::format("{:.4g} % of {} moves {}{}", 100.0 * worst.met, worst.moves,
                                          goal::meeting_predicate(goal::question_of(search.study)),
                                          study::setting_phrase(search.study.settings, worst.setting)));
}

/// Sentence that tells how to simulate again the machine whose manifest was written.
std::string replay_sentence(const Search& search) {
  const JudgedMachine& machine = search.found.in_box;
  if (!search.manifest || yaml::is_standard_stream(*search.manifest) || machine.manifest.empty()) return "";
  return fmt::format(
      "{0} has its manifest{1}; its worst trial: zerocount trace {2} --trial {3}", search.manifest->string(),
      search.found.with_profiles ? fmt::format(", with the profiles of machine {}", machine.machine)
                                 : std::string(),
      text::shell_path(*search.manifest), machine.trial);
}

document::Description<JudgedMachine> judged_description() {
  return document::Description<JudgedMachine>()
      .value(optional(everywhere("condition", "condition",
                                 "the condition under which it runs, in a study with conditions")),
             &JudgedMachine::setting_name)
      .value(optional(everywhere("goal", "goal that its moves meet the least often",
                                 "the goal that its moves meet the least often, of several")),
             &JudgedMachine::goal)
      .value(everywhere("moves", "moves", "moves by which the machine is judged"), &JudgedMachine::moves)
      .value(proportion("met", "moves that do as asked", "proportion of these moves that meet the goal"),
             &JudgedMachine::met);
}

/// Columns of data about one of the worst machines that the search found.
/// @param other_key key of the column that says whether it equals the machine found before
/// @param other_machine text that names this other machine
document::Description<JudgedMachine> found_description(const std::string& other_key,
                                                       const std::string& other_machine) {
  return document::Description<JudgedMachine>()
      .value(in_data("machine", "machine of the study with its profiles; 0 without machines"),
             &JudgedMachine::machine)
      .value(in_data("trial", "its worst trial, of its manifest"), &JudgedMachine::trial)
      .include(judged_description(), std::identity())
      .value(in_data("inputs", "the quantities that differ between machines, by parameter"),
             &JudgedMachine::inputs)
      .value(in_data("quantiles", "their quantiles", "1"), &JudgedMachine::quantiles)
      .value(in_data(other_key, "whether it is " + other_machine), &JudgedMachine::is_previous);
}

/// A row of the table for people: text that says which worst machine it is, and the machine.
using NamedMachine = std::pair<std::string, JudgedMachine>;

std::vector<NamedMachine> machine_rows(const Search& search) {
  const tuning::WorstMachines& found = search.found;
  std::vector<NamedMachine> rows{{"worst of the study, by new trials", found.again}};
  if (found.in_box.is_previous) rows.back().first += ", also in the box";
  if (!found.in_box.is_previous) rows.emplace_back("worst in the box", found.in_box);
  if (found.likely.is_previous) rows.back().first += ", also of the likely machines";
  if (!found.likely.is_previous) rows.emplace_back("worst of the likely machines", found.likely);
  return rows;
}

document::Description<NamedMachine> machine_columns() {
  return document::Description<NamedMachine>()
      .value({.heading = "machine"}, &NamedMachine::first)
      .include(judged_description(), &NamedMachine::second);
}

/// Columns of a table of machine inputs, each with its heading: the edges of the box, and the worst machines.
/// Null for a machine that equals the one before it.
auto inputs_side_by_side(const WorstMachines& found) {
  const auto if_other = [](const JudgedMachine& one) { return one.is_previous ? nullptr : &one.inputs; };
  return std::vector<std::pair<const char*, const NamedValues*>>{{"box from", &found.edges.low},
                                                                 {"median", &found.edges.median},
                                                                 {"to", &found.edges.high},
                                                                 {"worst of the study", &found.again.inputs},
                                                                 {"worst in the box", if_other(found.in_box)},
                                                                 {"likely", if_other(found.likely)}};
}

/// Name of a machine input, with its value in each column of inputs_side_by_side(); nothing where a column
/// does not have it.
struct InputRow {
  std::string name;
  std::vector<std::optional<double>> values{};
};

std::vector<InputRow> input_rows(const Search& search) {
  std::vector<InputRow> rows;
  for (const auto& [name, in_box] : search.found.in_box.inputs) {
    InputRow& row = rows.emplace_back(InputRow{name});
    for (const auto& [heading, inputs] : inputs_side_by_side(search.found)) {
      row.values.emplace_back();
      if (inputs == nullptr) continue;
      const auto found = std::ranges::find(*inputs, name, &NamedValues::value_type::first);
      if (found != inputs->end()) row.values.back() = found->second;
    }
  }
  return rows;
}

document::Description<InputRow> input_columns() {
  document::Description<InputRow> columns;
  columns.value({.heading = "input"}, &InputRow::name);
  for (std::size_t i = 0; const auto& [heading, inputs] : inputs_side_by_side({}))
    columns.value({.heading = heading}, [i = i++](const InputRow& row) { return row.values[i]; });
  return columns;
}

document::AnswerDescription<Search> worst_answer() {
  document::AnswerDescription<Search> answer{
      {.name = "worst", .meaning = "the machine that a gain suits worst"}, {}};
  answer.items.headline(headline)
      .include(worst_description(), [](const Search& s) { return s.found.of_study; })
      .sentence([](const Search& s) {
        return "worst of the study: " + worst_machine_text(s.found.of_study, s.study);
      })
      .object(in_data("again", "the worst machine of the study, judged by new trials"), judged_description(),
              [](const Search& s) { return s.found.again; })
      .object(in_data("box", "the worst machine in the box of the central 99.9 % of each input"),
              found_description("of_study", "the worst machine of the study"),
              [](const Search& s) { return s.found.in_box; })
      .object(in_data("likely", "the worst of the likely machines"),
              found_description("in_box", "the machine of the box"),
              [](const Search& s) { return s.found.likely; })
      .table(document::to_people("each machine by trials of its own"), machine_columns(), machine_rows)
      .table(document::to_people("what differs between machines, in the units of the manifest"),
             input_columns(), input_rows)
      .sentence(replay_sentence);
  return answer;
}

/// Folder to which paths in the operand's manifest are relative; nothing for a results file.
std::optional<std::filesystem::path> folder_of(const std::filesystem::path& operand) {
  if (commands::is_results_file(operand)) return std::nullopt;
  return std::filesystem::absolute(yaml::is_stream(operand) ? "." : operand).parent_path();
}

[[noreturn]] void refuse_manifest(const std::filesystem::path& output, const std::string& why) {
  throw Failure(ExitCode::bad_input,
                fmt::format("{}: no manifest describes the worst machine: {}", output.string(), why));
}

/// Checks before a search that every machine which it may find can be described by a manifest.
/// @param output path for the manifest
/// @throws Failure (bad_input) if some machine cannot
void require_manifest(const ExaminedPoint& examined, const std::filesystem::path& output) {
  const std::string why = tuning::refusal_of_manifests(examined.study, examined.point);
  if (!why.empty()) refuse_manifest(output, why);
}

ExitCode find_worst(const command_line::Arguments& arguments,
                    const std::optional<std::filesystem::path>& output) {
  const ExaminedPoint examined = point_to_examine(arguments);
  if (output) require_manifest(examined, *output);
  const status::InterruptionWatch interruption(status::InterruptionWatch::Unstopped::end);
  Search search{examined.study, unless_interrupted([&] {
                  return tuning::worst_machines(examined.study,
                                                trials::replicates_of(examined.study, examined.point),
                                                folder_of(arguments.operands()[0]), interruption.token());
                }),
                output};
  search.found.of_study.trial = examined.trial_in_whole(search.found.of_study.trial);
  const ExitCode code = answers::print(arguments, worst_answer(), search);
  if (!output) return code;
  const JudgedMachine& machine = search.found.in_box;
  if (machine.manifest.empty()) refuse_manifest(*output, machine.no_manifest);
  command_line::write_text(*output, machine.manifest);
  return code;
}

ExitCode worst(const command_line::Arguments& arguments) {
  const std::optional<std::filesystem::path> output = command_line::text_place(arguments, "output");
  return commands::recorded(commands::timeline_place(arguments), "worst",
                            [&] { return find_worst(arguments, output); });
}

}  // namespace

document::Answer worst_of(const study::Study& study, std::int64_t point, const trials::Effort& effort) {
  return worst_answer().of(
      {study, tuning::worst_machines(study, trials::replicates_of(study, point), std::nullopt, effort)});
}

std::string values_text(const NamedValues& values) {
  std::string text;
  for (const auto& [name, value] : values)
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", name, text::short_number(value));
  return text;
}

std::string machine_name(const WorstMachine& worst, bool on_machines) {
  return fmt::format("{} {}", on_machines ? "machine" : "trial", worst.machine);
}

std::string worst_machine_text(const WorstMachine& worst, const study::Study& study) {
  return fmt::format("{}, {:.4g} % of its moves {}{}{}{}", machine_name(worst, study.machines > 0),
                     100.0 * worst.met, goal::meeting_predicate(goal::question_of(study)),
                     claim_text(study, worst.claim), worst.inputs.empty() ? "" : "; ",
                     values_text(worst.inputs));
}

document::Description<WorstMachine> worst_description() {
  return document::Description<WorstMachine>()
      .include(named_claim_columns(), &WorstMachine::names)
      .value(in_data("machine",
                     "number of the machine in the study, or of its trial where no trials share a machine"),
             &WorstMachine::machine)
      .value(in_data("trial", "its worst trial"), &WorstMachine::trial)
      .value(in_data("met", "proportion of its moves that meet the goal", "1"), &WorstMachine::met)
      .value(in_data("inputs", "what it has drawn, by parameter"), &WorstMachine::inputs);
}

commands::Command worst_command() {
  return {{"worst",
           "MANIFEST|FILE",
           {answers::format_option(),
            command_line::written_file(
                {"output,o", "MANIFEST", "write a manifest of the worst machine in the box"}),
            named_point_option(), condition_option(), age_option(), commands::timeline_option(), set_option(),
            command_line::force_option()}},
          "the machine that a gain suits worst",
          worst_help,
          worst,
          [] { return std::vector{worst_answer().complete_type()}; }};
}

}  // namespace zerocount::design_commands
