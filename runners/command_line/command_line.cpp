#include "runners/command_line/command_line.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <boost/program_options.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "experiments/yaml/problems.hpp"

namespace zerocount::command_line {
namespace {

namespace po = boost::program_options;

constexpr const char* operand_key = "operand";

/// Message for an option that the command does not have.
/// @param given the option as the user wrote it, such as "--outptu"
std::string unknown_option(const CommandSpec& spec, const std::string& given) {
  std::vector<std::string> known;
  for (const OptionSpec& option : spec.options) known.push_back("--" + long_name(option));
  const std::string_view nearest = yaml::nearest_name(given, known);
  return fmt::format("unknown option '{}'{}", given,
                     yaml::is_near(given, nearest) ? fmt::format("; did you mean {}?", nearest) : "");
}

/// Text that says which value an option needs, for a message about a missing or wrong one: "takes no value",
/// "needs a value, one of …".
/// @param given the option as the user wrote it, such as "--quiet"
std::string value_problem(const CommandSpec& spec, const std::string& given) {
  for (const OptionSpec& option : spec.options) {
    if (given != "--" + long_name(option)) continue;
    if (option.value.empty()) return "takes no value";
    if (!option.words.empty()) return fmt::format("needs a value, one of {}", fmt::join(option.words, ", "));
  }
  return "needs a value";
}

/// The option of the command with this long name, such as "output"; the end of spec.options if there is none.
std::vector<OptionSpec>::const_iterator find_spec(const CommandSpec& spec, std::string_view name) {
  return std::find_if(spec.options.begin(), spec.options.end(),
                      [&](const OptionSpec& option) { return long_name(option) == name; });
}

po::options_description describe(const CommandSpec& spec) {
  po::options_description description;
  for (const OptionSpec& option : spec.options) {
    if (option.value.empty()) {
      description.add_options()(option.name.c_str(), option.help.c_str());
    } else {
      auto* value = po::value<std::vector<std::string>>()->value_name(option.value)->composing();
      if (option.count > 1) value->multitoken();
      description.add_options()(option.name.c_str(), value, option.help.c_str());
    }
  }
  return description;
}

po::parsed_options parse(const CommandSpec& spec, const std::vector<std::string>& words) {
  po::options_description all = describe(spec);
  all.add_options()(operand_key, po::value<std::vector<std::string>>());
  po::positional_options_description operands;
  operands.add(operand_key, -1);
  namespace style = po::command_line_style;
  const int unguessed = style::unix_style & ~style::allow_guessing;
  return po::command_line_parser(words).options(all).positional(operands).style(unguessed).run();
}

/// Text of a condition as the user would write it: "--format json".
std::string shown(std::string condition) {
  std::ranges::replace(condition, '=', ' ');
  return "--" + condition;
}

/// List of words for the help, such as "table (default), json or csv".
std::string words_text(const std::vector<std::string>& words) {
  std::string text = words.front() + " (default)";
  for (std::size_t i = 1; i < words.size(); ++i) text += (i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

}  // namespace

std::string long_name(const OptionSpec& option) {
  return option.name.substr(0, option.name.find(','));
}

OptionSpec choice_option(std::string name, std::string value, std::vector<std::string> words,
                         const std::string& help) {
  OptionSpec option{std::move(name), std::move(value), words_text(words) + (help.empty() ? "" : ": " + help)};
  option.words = std::move(words);
  return option;
}

OptionSpec needing(std::vector<std::string> conditions, OptionSpec option) {
  option.needs = std::move(conditions);
  return option;
}

OptionSpec excluding(std::vector<std::string> conditions, OptionSpec option) {
  option.excludes = std::move(conditions);
  return option;
}

OptionSpec of_operands(std::vector<std::string> operands, OptionSpec option) {
  option.operands = std::move(operands);
  return option;
}

OptionSpec read_file(OptionSpec option) {
  option.file = FileUse::read;
  return option;
}

OptionSpec written_file(OptionSpec option) {
  option.file = FileUse::written;
  return option;
}

OptionSpec kept_file(OptionSpec option) {
  option.file = FileUse::kept;
  return option;
}

OptionSpec page_file(OptionSpec option) {
  option.file = FileUse::page;
  return option;
}

OptionSpec renewed_file(OptionSpec option) {
  option.file = FileUse::renewed;
  return option;
}

OptionSpec list_of(std::vector<std::string> words, OptionSpec option) {
  option.list = std::move(words);
  return option;
}

OptionSpec format_option(std::vector<std::string> formats, const std::string& help) {
  return choice_option("format", "FORMAT", std::move(formats), help);
}

Arguments::Arguments(const CommandSpec& spec, const std::vector<std::string>& words) : spec_(spec) {
  for (const OptionSpec& option : spec.options) values_.push_back({long_name(option), {}});
  try {
    for (const po::option& given : parse(spec, words).options) {
      if (given.string_key == operand_key) {
        if (given.position_key < 0) refuse(fmt::format("unknown option '--{}'", operand_key));
        operands_.push_back(given.value.at(0));
        continue;
      }
      take_values(*find_spec(spec, given.string_key), given.value);
    }
  } catch (const po::unknown_option& error) {
    refuse(unknown_option(spec, error.get_option_name()));
  } catch (const po::error_with_option_name& error) {
    refuse(
        fmt::format("option '{}' {}", error.get_option_name(), value_problem(spec, error.get_option_name())));
  } catch (const po::error&) {
    refuse("invalid arguments");
  }
  for (const OptionSpec& option : spec.options) {
    if (!option.repeatable && values(long_name(option)).size() > option.count) {
      refuse(fmt::format("option '--{}' is given more than once", long_name(option)));
    }
  }
  if (has("help")) return;
  if (operands_.size() < spec.min_operands) refuse(fmt::format("{} expected", spec.operands));
  if (operands_.size() > spec.max_operands) {
    refuse(fmt::format("unexpected argument '{}'", operands_[spec.max_operands]));
  }
  const std::vector<std::string>& words_of_operand = spec.operand_words;
  if (!words_of_operand.empty() && !operands_.empty() &&
      std::ranges::find(words_of_operand, operands_.front()) == words_of_operand.end())
    refuse(fmt::format("'{}' is not one of {}", operands_.front(), fmt::join(words_of_operand, ", ")));
  for (const OptionSpec& option : spec.options) {
    if (has(long_name(option))) refuse_without_effect(option);
  }
}

bool Arguments::holds(const std::string& condition) const {
  const std::size_t equals = condition.find('=');
  if (equals == std::string::npos) return has(condition);
  return choice(condition.substr(0, equals)) == condition.substr(equals + 1);
}

void Arguments::refuse_without_effect(const OptionSpec& option) const {
  const std::string name = long_name(option);
  const auto held = [&](const std::string& condition) { return holds(condition); };
  if (!option.operands.empty() &&
      std::ranges::find(option.operands, operands_.front()) == option.operands.end())
    refuse(fmt::format("option '--{}' does not apply to '{} {}'", name, spec_.name, operands_.front()));
  if (!option.needs.empty() && std::ranges::none_of(option.needs, held)) {
    std::string alternatives;
    for (const std::string& condition : option.needs)
      alternatives += (alternatives.empty() ? "'" : " or '") + shown(condition) + "'";
    refuse(fmt::format("option '--{}' needs {}", name, alternatives));
  }
  const auto found = std::ranges::find_if(option.excludes, held);
  if (found != option.excludes.end())
    refuse(fmt::format("options '--{}' and '{}' exclude each other", name, shown(*found)));
}

void Arguments::take_values(const OptionSpec& option, const std::vector<std::string>& words) {
  const std::string name = long_name(option);
  auto& values = std::find_if(values_.begin(), values_.end(), [&](const auto& entry) {
                   return entry.first == name;
                 })->second;
  if (option.value.empty()) {
    values.emplace_back();
    return;
  }
  if (words.size() < option.count) refuse(fmt::format("option '--{}' needs {} values", name, option.count));
  const auto end = words.begin() + static_cast<std::ptrdiff_t>(option.count);
  values.insert(values.end(), words.begin(), end);
  operands_.insert(operands_.end(), end,
                   words.end());  // an option of several values takes all words that follow
}

const std::vector<std::string>& Arguments::values(std::string_view option) const {
  const auto found =
      std::find_if(values_.begin(), values_.end(), [&](const auto& entry) { return entry.first == option; });
  if (found == values_.end()) throw std::logic_error("option not declared");
  return found->second;
}

std::optional<std::string> Arguments::value(std::string_view option) const {
  const std::vector<std::string>& given = values(option);
  return given.empty() ? std::nullopt : std::optional(given.front());
}

std::string Arguments::required(std::string_view option) const {
  if (!has(option)) refuse(fmt::format("option '--{}' is missing", option));
  if (values(option).front().empty()) refuse(fmt::format("option '--{}' is empty", option));
  return values(option).front();
}

std::string Arguments::choice(std::string_view option) const {
  const OptionSpec& spec = *find_spec(spec_, option);
  const auto other = spec.other_names.find(value(option).value_or(""));
  return other != spec.other_names.end() ? other->second : one_of(option, spec.words);
}

FileUse Arguments::file_use(std::string_view option) const {
  return find_spec(spec_, option)->file;
}

std::string Arguments::one_of(std::string_view option, const std::vector<std::string>& words) const {
  std::string given = value(option).value_or(words.front());
  if (std::find(words.begin(), words.end(), given) == words.end()) {
    refuse(fmt::format("option '--{}': '{}' is not one of {}", option, given, fmt::join(words, ", ")));
  }
  return given;
}

std::optional<std::int64_t> Arguments::whole_number(std::string_view option, std::int64_t low,
                                                    std::int64_t high) const {
  const std::optional<std::string> text = value(option);
  if (!text) return std::nullopt;
  const std::optional<std::int64_t> number = text::parse_number<std::int64_t>(*text);
  if (!number || *number < low || *number > high) {
    refuse(fmt::format("option '--{}': '{}' is not a whole number from {} to {}", option, *text, low, high));
  }
  return number;
}

void Arguments::refuse(const std::string& problem) const {
  throw Failure(ExitCode::bad_input,
                fmt::format("zerocount {}: {}; see 'zerocount {} --help'", spec_.name, problem, spec_.name));
}

std::string options_help(const CommandSpec& spec) {
  std::string text;
  for (const OptionSpec& option : spec.options) {
    const std::size_t comma = option.name.find(',');
    std::string form = comma == std::string::npos ? "" : fmt::format("-{}, ", option.name.substr(comma + 1));
    form += "--" + long_name(option);
    if (!option.value.empty()) form += " " + option.value;
    text += fmt::format("  {:<22} {}\n", form, option.help);
  }
  return text;
}

}  // namespace zerocount::command_line
