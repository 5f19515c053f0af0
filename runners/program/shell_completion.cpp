#include "runners/program/shell_completion.hpp"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::program {
namespace {

using command_line::OptionSpec;

std::string long_form(const OptionSpec& option) {
  return "--" + option.name.substr(0, option.name.find(','));
}

std::string short_form(const OptionSpec& option) {
  const std::size_t comma = option.name.find(',');
  return comma == std::string::npos ? "" : "-" + option.name.substr(comma + 1);
}

/// All forms of the options, with blanks between.
std::string option_words(const commands::Command& command) {
  std::string words;
  for (const OptionSpec& option : command.spec.options) {
    for (const std::string& form : {long_form(option), short_form(option)})
      if (!form.empty()) words += (words.empty() ? "" : " ") + form;
  }
  return words;
}

/// Keys that --set can give a value: those of the table of parameters, and of the study.
std::string keys_to_set() {
  std::string keys;
  const auto add = [&keys](std::string_view key) {
    keys += fmt::format("{}{}=", keys.empty() ? "" : " ", key);
  };
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (!parameter.element) add(parameter.name);
  }
  for (const keys::GeneralKey& key : keys::general_keys()) {
    if (key.name != "zerocount") add(key.name);
  }
  return keys;
}

/// Values that the shell completes for an option, other than a fixed list of words or files.
enum class Offered { other, key, point, figure };

Offered offered_for(const OptionSpec& option) {
  if (option.name == "set") return Offered::key;
  if (option.name == "point") return Offered::point;
  return option.name == "figure" ? Offered::figure : Offered::other;
}

/// The action of bash after this option; empty: files.
std::string bash_action(const OptionSpec& option) {
  switch (offered_for(option)) {
    case Offered::key:
      return "words=$keys; compopt -o nospace 2>/dev/null";
    case Offered::point:
      return "_zerocount_lines completion points; return";
    case Offered::figure:
      return "_zerocount_lines plot; return";
    case Offered::other:
      break;
  }
  return option.words.empty() ? "" : fmt::format("words='{}'", fmt::join(option.words, " "));
}

/// The action of zsh for the value of this option.
std::string zsh_action(const OptionSpec& option) {
  switch (offered_for(option)) {
    case Offered::key:
      return "_zerocount_keys";
    case Offered::point:
      return "_zerocount_lines completion points";
    case Offered::figure:
      return "_zerocount_lines plot";
    case Offered::other:
      break;
  }
  return option.words.empty() ? "_files" : fmt::format("({})", fmt::join(option.words, " "));
}

/// The candidates of fish for the value of this option; empty: files.
std::string fish_candidates(const OptionSpec& option) {
  switch (offered_for(option)) {
    case Offered::key:
      return "(__zerocount_keys)";
    case Offered::point:
      return "(__zerocount_lines completion points)";
    case Offered::figure:
      return "(__zerocount_lines plot)";
    case Offered::other:
      break;
  }
  return fmt::format("{}", fmt::join(option.words, " "));
}

/// The lines of bash that find what a command takes: its options, the words that the value of an option is
/// one of, and those of its operand.
std::string bash_case(const commands::Command& command) {
  std::string lines = fmt::format("    {})\n      options='{}'\n", command.spec.name, option_words(command));
  if (!command.spec.operand_words.empty())
    lines += fmt::format("      if [ \"$COMP_CWORD\" -eq 2 ]; then words='{}'; fi\n",
                         fmt::join(command.spec.operand_words, " "));
  std::string cases;
  for (const OptionSpec& option : command.spec.options) {
    const std::string action = bash_action(option);
    if (!action.empty()) cases += fmt::format("        {}) {} ;;\n", long_form(option), action);
  }
  if (!cases.empty()) lines += fmt::format("      case $previous in\n{}      esac\n", cases);
  return lines + "      ;;\n";
}

/// `text` within single quotes of zsh, with a backslash before the `special` characters.
std::string zsh_text(std::string_view text, std::string_view special) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'') {
      escaped += "'\\''";
    } else {
      if (special.find(c) != std::string_view::npos) escaped += '\\';
      escaped += c;
    }
  }
  return escaped;
}

std::string zsh_option(const OptionSpec& option) {
  constexpr std::string_view special = "[]:\\";
  const std::string help = zsh_text(option.help, special);
  const std::string value =
      option.value.empty() ? "" : fmt::format(":{}:{}", zsh_text(option.value, special), zsh_action(option));
  const std::string many = option.repeatable ? "*" : "";
  std::string lines = fmt::format(" \\\n        '{}{}{}[{}]{}'", many, long_form(option),
                                  value.empty() ? "" : "=", help, value);
  if (const std::string form = short_form(option); !form.empty())
    lines += fmt::format(" \\\n        '{}{}{}[{}]{}'", many, form, value.empty() ? "" : "+", help, value);
  return lines;
}

/// `text` within single quotes of fish.
std::string fish_text(std::string_view text) {
  std::string escaped = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped + "'";
}

/// A line of fish: an option of a command. `-r`: it has a value, `-f`: which is not a file.
std::string fish_option(const commands::Command& command, const OptionSpec& option) {
  std::string line = fmt::format("complete -c zerocount -n '__fish_seen_subcommand_from {}' -l {}",
                                 command.spec.name, long_form(option).substr(2));
  if (const std::string form = short_form(option); !form.empty()) line += " -s " + form.substr(1);
  if (!option.value.empty()) line += " -r";
  if (const std::string candidates = fish_candidates(option); !candidates.empty())
    line += " -f -a " + fish_text(candidates);
  return line + " -d " + fish_text(option.help) + "\n";
}

}  // namespace

std::string bash_completion(std::span<const commands::Command> commands) {
  std::string names;
  std::string cases;
  for (const commands::Command& command : commands) {
    names += (names.empty() ? "" : " ") + command.spec.name;
    cases += bash_case(command);
  }
  return fmt::format(
      "# Completion of zerocount for bash: put it where bash-completion finds it, or source it.\n"
      "# The lines that a command prints for the first file of the command line.\n"
      "_zerocount_lines() {{\n"
      "  local file= line\n"
      "  for line in \"${{COMP_WORDS[@]:2}}\"; do\n"
      "    if [ -f \"$line\" ]; then file=$line; break; fi\n"
      "  done\n"
      "  if [ -z \"$file\" ]; then return; fi\n"
      "  while IFS= read -r line; do\n"
      "    case $line in \"$word\"*) COMPREPLY+=(\"$(printf %q \"$line\")\") ;; esac\n"
      "  done < <(\"${{COMP_WORDS[0]}}\" \"$@\" \"$file\" 2>/dev/null)\n"
      "}}\n"
      "_zerocount() {{\n"
      "  COMPREPLY=()\n"
      "  local keys='{}'\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} options= words=\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W '{} help --help --version' -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  # bash takes --option=value apart\n"
      "  if [ \"$word\" = = ]; then word=\n"
      "  elif [ \"$previous\" = = ]; then previous=${{COMP_WORDS[COMP_CWORD-2]}}\n"
      "  fi\n"
      "  case ${{COMP_WORDS[1]}} in\n"
      "{}"
      "    help) if [ \"$COMP_CWORD\" -eq 2 ]; then words='{}'; fi ;;\n"
      "  esac\n"
      "  case $word in\n"
      "    -*) words=$options ;;\n"
      "  esac\n"
      "  if [ \"$words\" ]; then\n"
      "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
      "  else\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); compopt -o filenames 2>/dev/null\n"
      "  fi\n"
      "}}\n"
      "complete -F _zerocount zerocount\n",
      keys_to_set(), names, cases, names);
}

std::string zsh_completion(std::span<const commands::Command> commands) {
  std::string names = "    'help:the help of a command'\n";
  std::string words;
  std::string cases;
  for (const commands::Command& command : commands) {
    words += (words.empty() ? "" : " ") + command.spec.name;
    names += fmt::format("    '{}:{}'\n", command.spec.name, zsh_text(command.summary, ":\\"));
    cases += fmt::format("    {})\n      _arguments", command.spec.name);
    for (const OptionSpec& option : command.spec.options) cases += zsh_option(option);
    if (!command.spec.operand_words.empty())
      cases += fmt::format(" \\\n        '1:word:({})'", fmt::join(command.spec.operand_words, " "));
    cases += " \\\n        '*:file:_files'\n      ;;\n";
  }
  return fmt::format(
      "#compdef zerocount\n"
      "# Completion of zerocount for zsh: put it into a folder of $fpath as _zerocount.\n"
      "_zerocount_keys() {{ compadd -S '' -- {} }}\n"
      "# The lines that a command prints for the first file of the command line.\n"
      "_zerocount_lines() {{\n"
      "  local file word\n"
      "  for word in ${{words[2,-1]}}; do\n"
      "    if [[ -f $word ]]; then file=$word; break; fi\n"
      "  done\n"
      "  [[ -n $file ]] && compadd -- \"${{(@f)$(zerocount $@ $file 2>/dev/null)}}\"\n"
      "}}\n"
      "_zerocount() {{\n"
      "  local -a commands\n"
      "  commands=(\n"
      "{}"
      "  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n"
      "{}"
      "    help) _arguments '1:command:({})' ;;\n"
      "  esac\n"
      "}}\n"
      "_zerocount \"$@\"\n",
      keys_to_set(), names, cases, words);
}

std::string fish_completion(std::span<const commands::Command> commands) {
  std::string lines;
  std::string names = "help";
  for (const commands::Command& command : commands) {
    names += " " + command.spec.name;
    lines += fmt::format("complete -c zerocount -n __fish_use_subcommand -f -a {} -d {}\n", command.spec.name,
                         fish_text(command.summary));
    for (const OptionSpec& option : command.spec.options) lines += fish_option(command, option);
    if (!command.spec.operand_words.empty())
      lines += fmt::format("complete -c zerocount -n '__fish_seen_subcommand_from {}' -f -a '{}'\n",
                           command.spec.name, fmt::join(command.spec.operand_words, " "));
  }
  return fmt::format(
      "# Completion of zerocount for fish: put it into ~/.config/fish/completions as zerocount.fish.\n"
      "function __zerocount_keys\n"
      "  string split ' ' -- '{}'\n"
      "end\n"
      "# The lines that a command prints for the first file of the command line.\n"
      "function __zerocount_lines\n"
      "  for word in (commandline -opc)[3..-1]\n"
      "    if test -f $word\n"
      "      zerocount $argv $word 2>/dev/null\n"
      "      return\n"
      "    end\n"
      "  end\n"
      "end\n"
      "complete -c zerocount -n __fish_use_subcommand -f -a help -d 'the help of a command'\n"
      "complete -c zerocount -n '__fish_seen_subcommand_from help' -f -a '{}'\n"
      "{}",
      keys_to_set(), names, lines);
}

}  // namespace zerocount::program
