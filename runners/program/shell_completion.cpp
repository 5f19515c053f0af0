#include "runners/program/shell_completion.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/parameter_table.hpp"

namespace zerocount::program {
namespace {

using command_line::OptionSpec;

std::string long_form(const OptionSpec& option) {
  return "--" + command_line::long_name(option);
}

std::string short_form(const OptionSpec& option) {
  const std::size_t comma = option.name.find(',');
  return comma == std::string::npos ? "" : "-" + option.name.substr(comma + 1);
}

/// The forms of an option, with the text between them.
std::string forms(const OptionSpec& option, std::string_view between) {
  const std::string form = short_form(option);
  return long_form(option) + (form.empty() ? "" : fmt::format("{}{}", between, form));
}

/// All forms of the options, with blanks between.
std::string option_words(const commands::Command& command) {
  std::string words;
  for (const OptionSpec& option : command.spec.options)
    words += (words.empty() ? "" : " ") + forms(option, " ");
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

/// Options whose values are names in a file, and the command that lists them, a line each.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> listings{
    {{"point", "completion points"},
     {"points", "completion points"},
     {"condition", "completion conditions"},
     {"age", "completion ages"},
     {"goal", "completion goals"},
     {"figure", "plot"}}};

/// What shells offer for the value of an option.
enum class Offered {
  nothing,
  files,
  keys,   ///< of --set
  words,  ///< of which the value is one
  list,   ///< words of which the value is a list, with commas between
  lines   ///< of a command
};

struct Offer {
  Offered kind;
  std::string text;  ///< words with blanks between, or the command
};

Offer offer_for(const OptionSpec& option) {
  const auto listing = std::ranges::find(listings, command_line::long_name(option),
                                         &std::pair<std::string_view, std::string_view>::first);
  if (listing != listings.end()) return {Offered::lines, std::string(listing->second)};
  if (option.name == "set") return {Offered::keys, ""};
  if (option.file != command_line::FileUse::none) return {Offered::files, ""};
  if (!option.list.empty()) return {Offered::list, fmt::format("{}", fmt::join(option.list, " "))};
  if (!option.words.empty()) return {Offered::words, fmt::format("{}", fmt::join(option.words, " "))};
  return {Offered::nothing, ""};
}

/// The action of bash for the value of this option.
std::string bash_action(const OptionSpec& option) {
  const Offer offer = offer_for(option);
  switch (offer.kind) {
    case Offered::nothing:
      break;
    case Offered::files:
      return "_zerocount_files";
    case Offered::keys:
      return "_zerocount_offer $keys; compopt -o nospace 2>/dev/null || true";
    case Offered::words:
      return "_zerocount_offer " + offer.text;
    case Offered::list:
      return "_zerocount_list " + offer.text;
    case Offered::lines:
      return "_zerocount_lines " + offer.text;
  }
  return ":";
}

/// The action of zsh for the value of this option; a blank offers nothing, and before words it keeps zsh from
/// adding its own to them.
std::string zsh_action(const OptionSpec& option) {
  const Offer offer = offer_for(option);
  switch (offer.kind) {
    case Offered::nothing:
      break;
    case Offered::files:
      return "_files";
    case Offered::keys:
      return "_zerocount_keys";
    case Offered::words:
      return fmt::format("({})", offer.text);
    case Offered::list:
      return " _sequence compadd - " + offer.text;
    case Offered::lines:
      return " _zerocount_lines " + offer.text;
  }
  return " ";
}

/// The candidates of fish for the value of this option; empty: none.
std::string fish_candidates(const OptionSpec& option) {
  const Offer offer = offer_for(option);
  switch (offer.kind) {
    case Offered::nothing:
    case Offered::files:
      break;
    case Offered::keys:
      return "(__zerocount_keys)";
    case Offered::words:
      return offer.text;
    case Offered::list:
      return fmt::format("(__zerocount_list {})", offer.text);
    case Offered::lines:
      return fmt::format("(__zerocount_lines {})", offer.text);
  }
  return "";
}

/// The lines of bash with the options of a command, and the words that its operand is one of.
std::string bash_words(const commands::Command& command) {
  return fmt::format("    {}) options='{}' operands='{}' ;;\n", command.spec.name, option_words(command),
                     fmt::join(command.spec.operand_words, " "));
}

/// The lines of bash that offer the value of each option of a command.
std::string bash_values(const commands::Command& command) {
  std::string cases;
  for (const OptionSpec& option : command.spec.options) {
    if (!option.value.empty())
      cases += fmt::format("        {}) {} ;;\n", forms(option, " | "), bash_action(option));
  }
  if (cases.empty()) return "";
  return fmt::format("    {})\n      case $previous in\n{}        *) return 1 ;;\n      esac ;;\n",
                     command.spec.name, cases);
}

/// Options with two values, of all commands: the second follows a word that is no option.
std::string options_of_two_values(std::span<const commands::Command> commands) {
  std::string options;
  for (const commands::Command& command : commands) {
    for (const OptionSpec& option : command.spec.options) {
      if (option.count == 2) options += (options.empty() ? "" : " | ") + long_form(option);
    }
  }
  return options;
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
  std::string value;
  for (std::size_t i = 0; !option.value.empty() && i < option.count; ++i)
    value += fmt::format(":{}:{}", zsh_text(option.value, special), zsh_action(option));
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

/// A line of fish: an option of a command. `-r`: it has a value; `-F`: a file, `-f`: none.
std::string fish_option(const commands::Command& command, const OptionSpec& option) {
  std::string line = fmt::format("complete -c zerocount -n '__fish_seen_subcommand_from {}' -l {}",
                                 command.spec.name, long_form(option).substr(2));
  if (const std::string form = short_form(option); !form.empty()) line += " -s " + form.substr(1);
  if (!option.value.empty()) line += option.file == command_line::FileUse::none ? " -r -f" : " -r -F";
  if (const std::string candidates = fish_candidates(option); !candidates.empty())
    line += " -a " + fish_text(candidates);
  return line + " -d " + fish_text(option.help) + "\n";
}

// The functions of bash. `line`: the words of the line up to the cursor, without quotes; `word`: the last of
// them; `lead`: what stands in it before the value. bash replaces the last word from `start` on, which stands
// within `quote`.
constexpr const char* bash_functions =
    R"bash(# Completion of zerocount for bash: put it where bash-completion finds it, or source it.
# bash parts words at = and the like (COMP_WORDBREAKS); this parts the line as the shell does when it runs it.
_zerocount_split() {
  local text=${COMP_LINE:0:COMP_POINT} letter part= i
  line=() word= start=0 quote=
  for ((i = 0; i < ${#text}; i++)); do
    letter=${text:i:1}
    case $quote$letter in
      "''" | '""') quote= start=${#word} ;;
      "'" | '"') quote=$letter part=1 start=${#word} ;;
      "'"*) word+=$letter ;;
      '"\')
        case ${text:i+1:1} in
          [\"\\\$\`]) ((++i)); word+=${text:i:1} ;;
          *) word+=$letter ;;
        esac ;;
      '"'*) word+=$letter ;;
      '\') ((++i)); word+=${text:i:1} ;;
      [[:blank:]])
        if [ "$part$word" ]; then line+=("$word"); fi
        word= part= start=0 ;;
      *)
        word+=$letter
        case $COMP_WORDBREAKS in *"$letter"*) start=${#word} ;; esac
        if [ "$letter" = @ ] && [ $start -gt 0 ]; then ((--start)); fi ;;  # bash keeps it in the word
    esac
  done
  line+=("$word")
}
_zerocount_offer() {
  local candidate rest
  for candidate; do
    case $lead$candidate in "$word"*) ;; *) continue ;; esac
    rest=$lead$candidate
    rest=${rest:start}
    case $quote in
      '"')
        rest=${rest//\\/\\\\} rest=${rest//\"/\\\"} rest=${rest//\$/\\\$} rest=${rest//\`/\\\`} ;;
      "'") rest=${rest//\'/"'\''"} ;;
      *) if [ "$rest" ]; then printf -v rest %q "$rest"; fi ;;
    esac
    COMPREPLY+=("$rest")
  done
}
_zerocount_list() {
  case ${word#"$lead"} in *,*) lead=${word%,*}, ;; esac
  _zerocount_offer "$@"
  compopt -o nospace 2>/dev/null || true  # bash 3 has none
}
_zerocount_files() {
  local path
  while IFS= read -r path; do
    path=$lead$path
    COMPREPLY+=("${path:start}")
  done < <(compgen -f -- "${word#"$lead"}")
  compopt -o filenames 2>/dev/null || true
}
# The lines that a command prints for the first file of the command line.
_zerocount_lines() {
  local file= candidate
  for candidate in "${line[@]:2}"; do
    candidate=${candidate/#\~\//$HOME/}
    if [ -f "$candidate" ]; then file=$candidate; break; fi
  done
  if [ -z "$file" ]; then return; fi
  while IFS= read -r candidate; do
    _zerocount_offer "$candidate"
  done < <("${line[0]/#\~\//$HOME/}" "$@" "$file" 2>/dev/null)
}
)bash";

constexpr const char* bash_main = R"bash(_zerocount() {
  COMPREPLY=()
  local -a line
  local word start quote lead= previous options= operands=
  _zerocount_split
  if [ ${#line[@]} -eq 2 ]; then
    _zerocount_offer $commands help --help --version
    return
  fi
  previous=${line[${#line[@]}-2]}
  case ${line[${#line[@]}-3]} in
    $of_two_values) previous=${line[${#line[@]}-3]} ;;
  esac
  case $word in
    --*=*) previous=${word%%=*} lead=${word%%=*}= ;;
  esac
  _zerocount_value && return
  lead=
  _zerocount_words
  case $word in
    -*) _zerocount_offer $options; return ;;
  esac
  if [ "$operands" ] && [ ${#line[@]} -eq 3 ]; then
    _zerocount_offer $operands
  else
    _zerocount_files
  fi
}
complete -F _zerocount zerocount
)bash";

constexpr const char* zsh_functions =
    R"zsh(# The lines that a command prints for the first file of the command line.
_zerocount_lines() {
  local file word
  local -a found
  for word in ${words[2,-1]}; do
    word=${(Q)word}
    [[ $word == '~/'* ]] && word=$HOME/${word#'~/'}
    if [[ -f $word ]]; then file=$word; break; fi
  done
  [[ -n $file ]] || return
  found=(${(f)"$($zerocount_program "$@" $file 2>/dev/null)"})
  compadd -a -- found
}
)zsh";

constexpr const char* fish_functions =
    R"fish(# The lines that a command prints for the first file of the command line.
function __zerocount_lines
  set -l words (commandline -opc)
  for word in $words[3..-1]
    set -l file (string replace -r '^~/' "$HOME/" -- $word)
    if test -f $file
      eval (string escape -- (string replace -r '^~/' "$HOME/" -- $words[1])) (string escape -- $argv $file) 2>/dev/null
      return
    end
  end
end
# A list whose last name is to be completed.
function __zerocount_list
  set -l before (commandline -ct | string replace -r '^--[^=]*=' '' | string replace -r '[^,]*$' '')
  for name in $argv
    echo $before$name
  end
end
)fish";

}  // namespace

std::string bash_completion(std::span<const commands::Command> commands) {
  std::string names;
  std::string words;
  std::string values;
  for (const commands::Command& command : commands) {
    names += (names.empty() ? "" : " ") + command.spec.name;
    words += bash_words(command);
    values += bash_values(command);
  }
  words += fmt::format("    help) operands='{}' ;;\n", names);
  std::string main = bash_main;
  const auto insert = [&main](std::string_view name, const std::string& text) {
    main.replace(main.find(name), name.size(), text);
  };
  insert("$commands", names);
  insert("$of_two_values", options_of_two_values(commands));
  return bash_functions +
         fmt::format(
             "_zerocount_words() {{\n  case ${{line[1]}} in\n{}  esac\n}}\n"
             "_zerocount_value() {{\n  local keys='{}'\n  case ${{line[1]}} in\n{}    *) return 1 ;;\n  "
             "esac\n}}\n",
             words, keys_to_set(), values) +
         main;
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
      "{}"
      "_zerocount() {{\n"
      "  local -a commands\n"
      "  commands=(\n"
      "{}"
      "  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  local zerocount_program=${{(Q)words[1]}} command=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n"
      "{}"
      "    help) _arguments '1:command:({})' ;;\n"
      "  esac\n"
      "}}\n"
      "_zerocount \"$@\"\n",
      keys_to_set(), zsh_functions, names, cases, words);
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
      "{}"
      "complete -c zerocount -n __fish_use_subcommand -f -a help -d 'the help of a command'\n"
      "complete -c zerocount -n '__fish_seen_subcommand_from help' -f -a '{}'\n"
      "{}",
      keys_to_set(), fish_functions, names, lines);
}

}  // namespace zerocount::program
