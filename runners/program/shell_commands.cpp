#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "runners/commands/command.hpp"
#include "runners/program/commands.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::program {
namespace {

constexpr std::size_t max_words = 10000;  // of a line that is completed

/// Study of a manifest or a results file, for a command that lists its names.
study::Study named_study(const command_line::Arguments& arguments, const std::string& file) {
  if (!commands::is_results_file(file)) return commands::load_study(file, arguments);
  if (arguments.has("set")) arguments.refuse("option '--set' needs a manifest instead of a results file");
  const reading::ResultsFile results(file, reading::Require::any_part);
  return layout::recorded_study(results.header(), file, nullptr);
}

std::vector<std::string> goal_names(const study::Study& study) {
  std::vector<std::string> names;
  for (const study::Goal& goal : study.goals) {
    if (!goal.name.empty()) names.push_back(goal.name);
  }
  return names;
}

std::vector<std::string> age_texts(const study::Study& study) {
  std::vector<std::string> texts;
  for (const double age : study.settings.ages.at) texts.push_back(fmt::format("{}", age));
  return texts;
}

/// A kind of names in a study that options have as values, such as its design points, and the function that
/// lists them.
struct StudyList {
  std::string_view word;
  std::vector<std::string> (*names)(const study::Study&);
};

constexpr std::array<StudyList, 4> study_lists{{
    {"points", [](const study::Study& study) { return study.points.labels; }},
    {"conditions", [](const study::Study& study) { return study.settings.conditions; }},
    {"ages", age_texts},
    {"goals", goal_names},
}};

ExitCode print_completion(const command_line::Arguments& arguments) {
  const std::span<const std::string> operands = arguments.operands();
  const std::string& what = operands.front();
  if (what == "candidates") {
    print_candidates(commands(), operands.subspan(1));
    return ExitCode::success;
  }
  const auto listing = std::ranges::find(study_lists, what, &StudyList::word);
  const bool lists = listing != study_lists.end();
  if (operands.size() != (lists ? 2 : 1))
    arguments.refuse(lists ? what + " need a manifest or a results file" : "unexpected second operand");
  if (!lists) {
    standard_output::write(completion_script(what));
    return ExitCode::success;
  }
  for (const std::string& name : listing->names(named_study(arguments, operands[1])))
    standard_output::write(name + "\n");
  return ExitCode::success;
}

ExitCode print_manual(const command_line::Arguments&) {
  standard_output::write(manual_page(commands(), layout::current_provenance().zerocount_version));
  return ExitCode::success;
}

}  // namespace

commands::Command completion_command() {
  return {{"completion",
           "bash|zsh|fish | points|conditions|ages|goals FILE | candidates -- WORD...",
           {command_line::of_operands(
               {"points", "conditions", "ages", "goals"},
               {"set", "KEY=VALUE", "override a key of that manifest; may be repeated", true})},
           1,
           max_words,
           {"bash", "zsh", "fish", "points", "conditions", "ages", "goals", "candidates"}},
          "print the completion of commands and options for a shell",
          "Prints a script that completes commands, options, keys of --set, names in a study, figures\n"
          "and files. 'points FILE' prints the labels of the design points of a manifest or results\n"
          "file; so 'conditions', 'ages' and 'goals' print theirs. The script asks the program by\n"
          "'candidates' what may stand in place of the last word of a line.\n"
          "\n"
          "Examples:\n"
          "  source <(zerocount completion bash)\n"
          "  source <(zerocount completion zsh)                  or, where ~/.zfunc is in $fpath:\n"
          "  zerocount completion zsh > ~/.zfunc/_zerocount\n"
          "  zerocount completion fish > ~/.config/fish/completions/zerocount.fish\n",
          print_completion};
}

commands::Command manual_command() {
  return {{"manual", "", {}, 0, 0},
          "print the manual page",
          "Prints the manual page zerocount(1).\n"
          "\n"
          "Example: zerocount manual | man -l -\n",
          print_manual};
}

}  // namespace zerocount::program
