#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <sstream>
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

/// Escape sequence for a character that man(7) would otherwise print as another one; empty if it needs none.
std::string_view escape_of(char c) {
  switch (c) {
    case '\\':
      return "\\e";
    case '-':
      return "\\-";
    case '\'':
      return "\\(aq";
    case '`':
      return "\\(ga";
    case '^':
      return "\\(ha";
    case '~':
      return "\\(ti";
    default:
      return {};
  }
}

/// The text in the form that man(7) reads: no line starts with a request, and special characters are escaped
/// so that they can be copied. In UTF-8.
std::string roff(std::string_view text) {
  std::string escaped;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && c == '.') escaped += "\\&";
    if (const std::string_view escape = escape_of(c); !escape.empty()) {
      escaped += escape;
    } else {
      escaped += c;
    }
    at_start = c == '\n';
  }
  return escaped;
}

std::string option_entry(const command_line::OptionSpec& option) {
  const std::size_t comma = option.name.find(',');
  const std::string value = option.value.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(option.value));
  const std::string name = roff("--" + option.name.substr(0, comma));
  const std::string form =
      comma == std::string::npos
          ? fmt::format("\\fB{}\\fR{}", name, value)
          : fmt::format("\\fB{}\\fR, \\fB{}\\fR{}", roff("-" + option.name.substr(comma + 1)), name, value);
  return fmt::format(".TP\n{}\n{}\n", form, roff(option.help));
}

std::string command_entry(const commands::Command& command) {
  std::string text = fmt::format(
      ".SS {}\n\\fBzerocount {}\\fR {} [\\fIoptions\\fR]\n.PP\n{}.\n.PP\n.nf\n{}.fi\n", command.spec.name,
      command.spec.name, roff(command.spec.operands), roff(command.summary), roff(command.help));
  for (const command_line::OptionSpec& option : command.spec.options) text += option_entry(option);
  return text;
}

}  // namespace

std::string manual_page(std::span<const commands::Command> commands, const std::string& version) {
  std::string text = fmt::format(
      "'\\\" -*- coding: utf-8 -*-\n"
      ".TH ZEROCOUNT 1 \"\" \"zerocount {}\" \"User Commands\"\n"
      ".SH NAME\n"
      "zerocount \\- statistics of the zero\\-count positioning of axes with friction\n"
      ".SH SYNOPSIS\n"
      "\\fBzerocount\\fR \\fIcommand\\fR [\\fIoperands\\fR] [\\fIoptions\\fR]\n"
      ".SH DESCRIPTION\n"
      "How often does a positioning axis hold exactly zero encoder counts of error when its friction is not\n"
      "known exactly? A manifest (YAML) describes the axis, its control and what varies; zerocount runs the\n"
      "trials, and writes rates, settling times and jerks to a results file (HDF5).\n"
      ".SH COMMANDS\n",
      version);
  for (const commands::Command& command : commands) text += command_entry(command);
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : exit_code_meanings)
    text += fmt::format(".TP\n{}\n{}\n", static_cast<int>(code), roff(meaning));
  return text;
}

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
