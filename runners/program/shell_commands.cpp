#include "runners/program/shell_commands.hpp"

#include <string>

#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/program/manual_page.hpp"
#include "runners/program/shell_completion.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::program {
namespace {

/// The labels of the design points of a manifest or a results file.
std::vector<std::string> point_labels(const command_line::Arguments& arguments, const std::string& file) {
  if (!commands::is_results_file(file)) return commands::load_study(file, arguments).points.labels;
  if (arguments.has("set")) arguments.refuse("option '--set' needs a manifest instead of a results file");
  const reading::ResultsFile results(file, reading::Require::any_part);
  return layout::recorded_study(results.header(), file, nullptr).points.labels;
}

ExitCode print_completion(const command_line::Arguments& arguments) {
  const std::string& shell = arguments.operands()[0];
  const bool points = shell == "points";
  if (points != (arguments.operands().size() == 2))
    arguments.refuse(points ? "points need a manifest or a results file" : "unexpected second operand");
  if (points) {
    for (const std::string& label : point_labels(arguments, arguments.operands()[1]))
      standard_output::write(label + "\n");
    return ExitCode::success;
  }
  standard_output::write(shell == "bash"  ? bash_completion(commands())
                         : shell == "zsh" ? zsh_completion(commands())
                                          : fish_completion(commands()));
  return ExitCode::success;
}

ExitCode print_manual(const command_line::Arguments&) {
  standard_output::write(manual_page(commands(), layout::current_provenance().zerocount_version));
  return ExitCode::success;
}

}  // namespace

commands::Command completion_command() {
  return {{"completion",
           "bash|zsh|fish|points [FILE]",
           {command_line::of_operands(
               {"points"}, {"set", "KEY=VALUE", "override a key of that manifest; may be repeated", true})},
           1,
           2,
           {"bash", "zsh", "fish", "points"}},
          "print the completion of commands and options for a shell",
          "Prints a script that completes commands, options, keys of --set, design points, figures\n"
          "and files. 'points FILE' prints the labels of the design points of a manifest or results\n"
          "file, which the script asks for.\n"
          "\n"
          "Examples:\n"
          "  source <(zerocount completion bash)\n"
          "  zerocount completion zsh > ~/.zfunc/_zerocount     where ~/.zfunc is in $fpath\n"
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
