#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

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

}  // namespace zerocount::program
