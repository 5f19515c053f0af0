#include "runners/program/commands.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "analysis/basis/parallel/processors.hpp"
#include "analysis/basis/text/text.hpp"
#include "analysis/trials/theory/plausibility.hpp"
#include "experiments/yaml/problems.hpp"
#include "results/layout/header.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/identification_commands/identification_commands.hpp"
#include "runners/library/description.hpp"
#include "runners/result_commands/result_commands.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/terminal/terminal.hpp"

namespace zerocount::program {
namespace {

std::string exit_codes_help() {
  std::string text = "Exit codes:\n";
  for (const auto& [code, meaning] : exit_code_meanings) {
    text += fmt::format("  {:>3}  {}\n", static_cast<int>(code), meaning);
  }
  return text;
}

std::string overview() {
  std::string text =
      "zerocount: how often does a positioning axis with friction hold exactly zero encoder counts of error?\n\n"
      "usage: zerocount COMMAND ...\n\n";
  for (const commands::Command& command : commands())
    text += fmt::format("  {:<12} {}\n", command.spec.name, command.summary);
  text +=
      "\n'zerocount COMMAND --help' explains a command; 'zerocount --version' (-V) prints the version.\n"
      "As the name of a manifest, a table or a page, - is standard input or output.\n";
  text += fmt::format("{}\n", command_line::overwriting_rule);
  return text + exit_codes_help();
}

std::string help_of(const commands::Command& command) {
  const auto& options = command.spec.options;
  const bool writes = std::any_of(options.begin(), options.end(), [](const command_line::OptionSpec& option) {
    return option.name == command_line::force_option().name;
  });
  return fmt::format("usage: zerocount {} {} [options]\n\n{}\n\n{}{}\nOptions:\n{}\n{}", command.spec.name,
                     command.spec.operands, command.summary, command.help,
                     writes ? fmt::format("\n{}", command_line::overwriting_rule) : "",
                     command_line::options_help(command.spec), exit_codes_help());
}

/// Prints a help text, whose lines were broken by hand. On a terminal that is narrower, its paragraphs are
/// wrapped again.
ExitCode print(const std::string& text) {
  constexpr std::size_t hand_width = 86;
  constexpr std::size_t widest_line = 96;
  const std::optional<std::size_t> width = terminal::width_of(STDOUT_FILENO);
  standard_output::write_fitted(width && *width < widest_line ? text::unwrapped(text, hand_width) : text);
  return ExitCode::success;
}

commands::Command find_command(const std::string& name) {
  const std::vector<commands::Command> all = commands();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const commands::Command& c) { return c.spec.name == name; });
  if (found != all.end()) return *found;
  std::vector<std::string> names{"help"};
  for (const commands::Command& command : all) names.push_back(command.spec.name);
  const std::string_view nearest = yaml::nearest_name(name, names);
  const std::string meant =
      yaml::is_near(name, nearest) ? fmt::format("did you mean {}? See", nearest) : std::string("see");
  throw Failure(ExitCode::bad_input,
                fmt::format("zerocount: unknown command '{}'; {} 'zerocount --help'", name, meant));
}

bool asks_for_threads(const commands::Command& command, const command_line::Arguments& arguments) {
  const auto is_threads = [](const command_line::OptionSpec& option) { return option.name == "threads"; };
  return std::ranges::any_of(command.spec.options, is_threads) && arguments.has("threads");
}

}  // namespace

std::vector<commands::Command> commands() {
  std::vector<commands::Command> all{study_commands::check_command(),
                                     study_commands::run_command(),
                                     result_commands::summary_command(),
                                     study_commands::trace_command(),
                                     study_commands::merge_command(),
                                     study_commands::verify_command(),
                                     study_commands::export_command(),
                                     identification_commands::experiment_command(),
                                     identification_commands::identify_command(),
                                     result_commands::judge_command(),
                                     result_commands::learn_command(),
                                     design_commands::tune_command(),
                                     design_commands::limits_command(),
                                     design_commands::worst_command(),
                                     design_commands::rare_command(),
                                     study_commands::controller_command(),
                                     study_commands::parameters_command(),
                                     schema_command(),
                                     result_commands::jerks_command(),
                                     result_commands::compare_command(),
                                     result_commands::baseline_command(),
                                     result_commands::history_command(),
                                     result_commands::monitor_command(),
                                     result_commands::accept_command(),
                                     design_commands::plan_command(),
                                     result_commands::sensitivity_command(),
                                     result_commands::report_command(),
                                     result_commands::plot_command(),
                                     study_commands::status_command(),
                                     completion_command(),
                                     manual_command(),
                                     study_commands::new_command()};
  for (commands::Command& command : all) command.spec.options.push_back({"help,h", "", "show this text"});
  return all;
}

ExitCode run_command_line(std::span<const std::string> words) {
  if (words.empty()) throw Failure(ExitCode::bad_input, overview());
  const std::string& name = words.front();
  if (name == "--help" || name == "-h" || name == "help") {
    return print(words.size() > 1 ? help_of(find_command(words[1])) : overview());
  }
  if (name == "--version" || name == "-V") {
    const layout::Provenance provenance = layout::current_provenance();
    return print(fmt::format("zerocount {} ({}, {})\n", provenance.zerocount_version, provenance.git_commit,
                             provenance.compiler));
  }
  if (name == "--describe") {  // for the packages of other languages
    standard_output::write(library::described(words.subspan(1)));
    return ExitCode::success;
  }
  const commands::Command command = find_command(name);
  const command_line::Arguments arguments(command.spec, {words.begin() + 1, words.end()});
  if (arguments.has("help")) return print(help_of(command));
  command_line::require_separate_files(arguments);
  std::optional<parallel::ThreadLimit> limit;
  if (!asks_for_threads(command, arguments)) limit.emplace(parallel::processors());
  const command_line::EarlierAnswers earlier(arguments);
  try {
    return command.run(arguments);
  } catch (const command_line::RefusedOutput&) {
    throw;
  } catch (...) {
    earlier.remove_remaining();
    throw;
  }
}

}  // namespace zerocount::program
