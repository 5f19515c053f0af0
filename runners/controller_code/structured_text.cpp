#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>

#include "runners/controller_code/program.hpp"

namespace zerocount::controller_code {
namespace {

Notation st_notation(Precision precision) {
  return {
      .precision = precision,
      .no = "FALSE",
      .yes = "TRUE",
      .forms = {{Operation::both, "{0} AND {1}"},
                {Operation::either, "{0} OR {1}"},
                {Operation::negation, "NOT {0}"},
                {Operation::count_difference, "LINT_TO_REAL({0} - {1})"},
                {Operation::magnitude, "ABS({0})"},
                {Operation::limited, "LIMIT({1}, {0}, {2})"},
                // The conversion to a whole number rounds to the nearest.
                {Operation::nearest, precision == Precision::single_precision
                                         ? "LINT_TO_REAL(REAL_TO_LINT({0}))"
                                         : "LINT_TO_LREAL(LREAL_TO_LINT({0}))"},
                {Operation::is_even,
                 "((LREAL_TO_LINT({0}) - BOOL_TO_LINT(LINT_TO_LREAL(LREAL_TO_LINT({0})) > {0})) MOD 2 = 0)"},
                {Operation::choice, "SEL({0}, {2}, {1})"}},
      .lines = {.assignment = "{} := {};",
                .if_begins = "IF {} THEN",
                .otherwise = "ELSE",
                .if_ends = "END_IF;",
                .remark = "(* {} *)"}};
}

/// The text, changed so that it can stand inside a comment of Structured Text: the marks `(*` and `*)` are
/// broken by a space, and each byte that is not ASCII becomes `?`, because some compilers read ASCII only.
std::string in_st_comment(std::string text) {
  boost::algorithm::replace_all(text, "*)", "* )");
  boost::algorithm::replace_all(text, "(*", "( *");
  for (char& c : text) {
    if (static_cast<unsigned char>(c) >= 0x80U) c = '?';
  }
  return text;
}

std::string_view st_type(Type type, Precision precision) {
  const bool single = precision == Precision::single_precision;
  switch (type) {
    case Type::flag:
      return "BOOL";
    case Type::count:
      return single ? "LINT" : "LREAL";
    case Type::number:
      break;
  }
  return single ? "REAL" : "LREAL";
}

/// Declarations in Structured Text of all variables that have this role.
std::string declarations(const Program& program, const Notation& notation, Role role) {
  std::string text;
  for (const Variable& variable : program.variables) {
    if (variable.role != role || &variable == &program.variables[program.wanted]) continue;
    const std::string initial =
        role == Role::state ? fmt::format(" := {}", initial_text(variable, notation)) : "";
    const std::string meaning = variable.meaning.empty() ? "" : fmt::format(" (* {} *)", variable.meaning);
    text += fmt::format("  {} : {}{};{}\n", variable.name, st_type(variable.type, program.precision), initial,
                        meaning);
  }
  return text;
}

std::string section(std::string_view head, const std::string& declarations) {
  return declarations.empty() ? "" : fmt::format("{}\n{}END_VAR\n", head, declarations);
}

}  // namespace

std::string structured_text(const ControllerToWrite& chain, const Program& program,
                            const std::string& function_block) {
  const Notation notation = st_notation(program.precision);
  const std::string_view type = st_type(Type::number, program.precision);
  std::string text = "(*\n";
  for (const std::string& line : heading_lines(chain, program.precision))
    text += (line.empty() ? "" : "  " + in_st_comment(line)) + "\n";
  text += fmt::format("*)\nFUNCTION_BLOCK {}\n", function_block);
  text += section("VAR_INPUT", "  restart : BOOL; (* this sample is the first: the states start anew *)\n" +
                                   declarations(program, notation, Role::input));
  text +=
      section("VAR_OUTPUT", fmt::format("  {} : {}; (* {}, {} *)\n", program.variables[program.wanted].name,
                                        type, parameters::text_on(chain.axis, "$torque"),
                                        parameters::unit_on(chain.axis, "N m")));
  std::string constants;
  for (const Constant& constant : program.constants)
    constants += fmt::format("  {} : {} := {}; (* {} *)\n", constant.name, type,
                             decimal(constant.value, notation), constant.meaning);
  text += section("VAR CONSTANT", constants);
  text += section("VAR", declarations(program, notation, Role::state));
  text += section("VAR_TEMP", declarations(program, notation, Role::local));
  text += "IF restart THEN\n";
  for (const Variable& variable : program.variables) {
    if (variable.role == Role::state)
      text += fmt::format("  {} := {};\n", variable.name, initial_text(variable, notation));
  }
  text += "END_IF;\n" + statements_text(program, notation, program.step, 0);
  return text + "END_FUNCTION_BLOCK\n";
}

}  // namespace zerocount::controller_code
