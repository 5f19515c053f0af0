#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "runners/program/commands.hpp"
#include "runners/standard_output/standard_output.hpp"

namespace zerocount::program {
namespace {

using command_line::OptionSpec;
using Words = std::span<const std::string>;

/// Options whose values are names in a file, each with the command (two words) that prints these names for a
/// file.
constexpr std::array<std::pair<std::string_view, std::array<std::string_view, 2>>, 6> listings{
    {{"point", {"completion", "points"}},
     {"points", {"completion", "points"}},
     {"condition", {"completion", "conditions"}},
     {"age", {"completion", "ages"}},
     {"goal", {"completion", "goals"}},
     {"figure", {"plot", ""}}}};

void print_line(std::string_view candidate, std::string_view help = "") {
  standard_output::write(fmt::format("{}{}{}\n", candidate, help.empty() ? "" : "\t", help));
}

const commands::Command* find_command(std::span<const commands::Command> commands, std::string_view name) {
  const auto found = std::ranges::find_if(
      commands, [name](const commands::Command& command) { return command.spec.name == name; });
  return found == commands.end() ? nullptr : &*found;
}

/// Forms in which the user can write an option: "--output" and "-o".
std::vector<std::string> forms_of(const OptionSpec& option) {
  std::vector<std::string> forms{"--" + command_line::long_name(option)};
  if (const std::size_t comma = option.name.find(','); comma != std::string::npos)
    forms.push_back("-" + option.name.substr(comma + 1));
  return forms;
}

/// The option whose value is being completed in the last word: behind "=", or after the option, which may
/// have two values. Null if the last word is not a value.
const OptionSpec* option_of_value(const commands::Command& command, Words words) {
  const std::string& last = words.back();
  const std::size_t equals = last.starts_with("--") ? last.find('=') : std::string::npos;
  for (const OptionSpec& option : command.spec.options) {
    if (option.value.empty()) continue;
    for (const std::string& form : forms_of(option)) {
      if (equals != std::string::npos && form == last.substr(0, equals)) return &option;
      for (std::size_t back = 1; back <= option.count && back < words.size(); ++back)
        if (equals == std::string::npos && form == words[words.size() - 1 - back]) return &option;
    }
  }
  return nullptr;
}

/// The first word that is the path of an existing file; nothing if there is none. The shell has not replaced
/// a ~ in it.
std::optional<std::string> first_file(Words words) {
  const char* const home = std::getenv("HOME");
  for (std::string word : words) {
    if (word.starts_with("~/") && home != nullptr) word.replace(0, 1, home);
    std::error_code ignored;
    if (std::filesystem::is_regular_file(word, ignored)) return word;
  }
  return std::nullopt;
}

/// Prints the keys that --set can give a value: the parameters of the table, and the keys of the study.
void print_keys() {
  print_line(":keys");
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (!parameter.element) print_line(fmt::format("{}=", parameter.name));
  }
  for (const shapes::Shape& key : keys::general_keys()) {
    if (key.name != "zerocount") print_line(fmt::format("{}=", key.name));
  }
}

void print_values(std::span<const commands::Command> commands, const OptionSpec& option, Words words) {
  const std::string name = command_line::long_name(option);
  const auto listing = std::ranges::find_if(listings, [&](const auto& one) { return one.first == name; });
  if (listing != listings.end()) {
    const std::optional<std::string> file = first_file(words);
    if (!file) return;
    const commands::Command& command = *find_command(commands, listing->second[0]);
    std::vector<std::string> operands{std::string(listing->second[1]), *file};
    std::erase(operands, "");
    command.run(command_line::Arguments(command.spec, operands));
  } else if (name == "set") {
    print_keys();
  } else if (option.file != command_line::FileUse::none) {
    print_line(":files");
  } else {
    if (!option.list.empty()) print_line(":list");
    for (const std::string& word : option.list.empty() ? option.words : option.list) print_line(word);
  }
}

// `line`: the words of the line up to the cursor, without quotes; `word`: the last of them; `lead`: what
// stands in it before the value. bash replaces the last word from `start` on, which stands within `quote`.
constexpr std::string_view bash_script =
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
  local rest
  case $lead$1 in "$word"*) ;; *) return ;; esac
  rest=$lead$1
  rest=${rest:start}
  case $quote in
    '"')
      rest=${rest//\\/\\\\} rest=${rest//\"/\\\"} rest=${rest//\$/\\\$} rest=${rest//\`/\\\`} ;;
    "'") rest=${rest//\'/"'\''"} ;;
    *) if [ "$rest" ]; then printf -v rest %q "$rest"; fi ;;
  esac
  COMPREPLY+=("$rest")
}
_zerocount_files() {
  local path
  while IFS= read -r path; do
    path=$lead$path
    COMPREPLY+=("${path:start}")
  done < <(compgen -f -- "${word#"$lead"}")
  compopt -o filenames 2>/dev/null || true  # bash 3 has none
}
_zerocount() {
  COMPREPLY=()
  local -a line
  local word start quote lead= candidate
  _zerocount_split
  case $word in --*=*) lead=${word%%=*}= ;; esac
  while IFS= read -r candidate; do
    case $candidate in
      :files) _zerocount_files ;;
      :keys) compopt -o nospace 2>/dev/null || true ;;
      :list)
        case ${word#"$lead"} in *,*) lead=${word%,*}, ;; esac
        compopt -o nospace 2>/dev/null || true ;;
      *) _zerocount_offer "${candidate%%$'\t'*}" ;;
    esac
  done < <("${line[0]/#\~\//$HOME/}" completion candidates -- "${line[@]:1}" 2>/dev/null)
}
complete -F _zerocount zerocount
)bash";

constexpr std::string_view zsh_script = R"zsh(#compdef zerocount
# Completion of zerocount for zsh: put it into a folder of $fpath as _zerocount, or read it with source.
_zerocount() {
  local candidate
  local -a line found shown blank
  line=("${(@Q)words[1,CURRENT]}")
  [[ $words[CURRENT] == --*=* ]] && compset -P 1 '*='
  for candidate in "${(@f)$(${line[1]/#\~\//$HOME/} completion candidates -- "${(@)line[2,-1]}" 2>/dev/null)}"; do
    case $candidate in
      :files) _files; return ;;
      :keys) blank=(-S '') ;;
      :list) blank=(-S ''); compset -P '*,' ;;
      ?*)
        found+=("${candidate%%$'\t'*}")
        shown+=("${candidate/$'\t'/  -- }") ;;
    esac
  done
  compadd "${blank[@]}" -l -d shown -a -- found
}
if [[ ${funcstack[1]} == _zerocount ]]; then  # read by the completion system from a folder of $fpath
  _zerocount "$@"
else  # read by source
  (( ${+functions[compdef]} )) || { autoload -Uz compinit && compinit }
  compdef _zerocount zerocount
fi
)zsh";

constexpr std::string_view fish_script =
    R"fish(# Completion of zerocount for fish: put it into ~/.config/fish/completions as zerocount.fish.
function __zerocount_candidates
  set -l words (commandline -opc)
  set -l word (commandline -ct)
  set -l program (string replace -r '^~/' "$HOME/" -- $words[1])
  set -l before (string match -r -- '^--[^=]*=' $word; or echo)
  for candidate in (eval (string escape -- $program completion candidates -- $words[2..-1] $word) 2>/dev/null)
    switch $candidate
      case :files
        for path in (__fish_complete_path (string replace -r -- '^--[^=]*=' '' $word))
          echo $before$path
        end
      case :keys
      case :list
        set before (string replace -r -- '[^,=]*$' '' $word)
      case '*'
        echo $before$candidate
    end
  end
end
complete -c zerocount -f -a '(__zerocount_candidates)'
)fish";

}  // namespace

void print_candidates(std::span<const commands::Command> commands, Words words) {
  const bool of_commands = words.size() == 1 || (words.size() == 2 && words[0] == "help");
  if (of_commands) {
    for (const commands::Command& command : commands) print_line(command.spec.name, command.summary);
    if (words.size() > 1) return;
    print_line("help", "the help of a command");
    for (const char* option : {"--help", "--version"}) print_line(option);
    return;
  }
  const commands::Command* const command = find_command(commands, words.front());
  if (command == nullptr) return;
  if (const OptionSpec* const option = option_of_value(*command, words)) {
    try {
      print_values(commands, *option, words.subspan(1));
    } catch (const Failure&) {  // the file is not of a study: nothing is offered
    }
  } else if (words.back().starts_with('-')) {
    for (const OptionSpec& known : command->spec.options)
      for (const std::string& form : forms_of(known)) print_line(form, known.help);
  } else if (words.size() == 2 && !command->spec.operand_words.empty()) {
    for (const std::string& word : command->spec.operand_words) print_line(word);
  } else {
    print_line(":files");
  }
}

std::string_view completion_script(std::string_view shell) {
  return shell == "bash" ? bash_script : shell == "zsh" ? zsh_script : fish_script;
}

}  // namespace zerocount::program
