#include <string>

#include "results/layout/header.hpp"
#include "runners/commands/commands.hpp"
#include "runners/commands/manual_page.hpp"
#include "runners/commands/shell_completion.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::commands {
namespace {

ExitCode print_completion(const command_line::Arguments& arguments) {
  const std::string& shell = arguments.operands()[0];
  standard_output::write(shell == "bash" ? bash_completion(commands()) : zsh_completion(commands()));
  return ExitCode::success;
}

ExitCode print_manual(const command_line::Arguments&) {
  standard_output::write(manual_page(commands(), layout::current_provenance().zerocount_version));
  return ExitCode::success;
}

}  // namespace

Command completion_command() {
  return {{"completion", "bash|zsh", {}, 1, 1, {"bash", "zsh"}},
          "print the completion of commands and options for a shell",
          "Prints a script that completes commands, options and files.\n"
          "\n"
          "Examples:\n"
          "  source <(zerocount completion bash)\n"
          "  zerocount completion zsh > ~/.zfunc/_zerocount     where ~/.zfunc is in $fpath\n",
          print_completion};
}

Command manual_command() {
  return {{"manual", "", {}, 0, 0},
          "print the manual page",
          "Prints the manual page zerocount(1).\n"
          "\n"
          "Example: zerocount manual | man -l -\n",
          print_manual};
}

}  // namespace zerocount::commands
