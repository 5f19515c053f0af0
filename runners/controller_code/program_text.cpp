#include <array>
#include <string>

#include <fmt/format.h>

#include "core/loop/dac.hpp"
#include "runners/controller_code/program.hpp"

namespace zerocount::controller_code {
namespace {

/// How strongly operators bind, from the weakest (either: or) to the strongest (whole: a name, number or
/// parentheses). C and Structured Text agree on the order.
enum class Binding { either, both, comparison, sum, product, sign, whole };

/// How an operation is written, and how strongly it and its operands must bind. Operators of equal strength
/// act from the left. In a disjunction (or) a conjunction (and) gets parentheses too.
struct Shape {
  std::string_view form;  ///< Text with `{0}`, `{1}` for the operands; empty: the form is in Notation::forms.
  Binding binding, left, right;
};

Shape shape_of(Operation operation) {
  using enum Binding;
  static const std::map<Operation, Shape> shapes{
      {Operation::negative, {"-{0}", sign, whole, whole}},
      {Operation::negation, {"", sign, whole, whole}},
      {Operation::sum, {"{0} + {1}", sum, sum, product}},
      {Operation::difference, {"{0} - {1}", sum, sum, product}},
      {Operation::product, {"{0} * {1}", product, product, sign}},
      {Operation::quotient, {"{0} / {1}", product, product, sign}},
      {Operation::at_most, {"{0} <= {1}", comparison, comparison, sum}},
      {Operation::at_least, {"{0} >= {1}", comparison, comparison, sum}},
      {Operation::below, {"{0} < {1}", comparison, comparison, sum}},
      {Operation::above, {"{0} > {1}", comparison, comparison, sum}},
      {Operation::both, {"", both, both, comparison}},
      {Operation::either, {"", either, comparison, comparison}}};
  const auto found = shapes.find(operation);
  return found == shapes.end() ? Shape{"", whole, either, either} : found->second;
}

/// Text of an expression in the notation of a language. It gets parentheses if it binds less strongly than
/// `least`.
std::string term_text(const Program& program, const Notation& notation, const Term& term,
                      Binding least = Binding::either) {
  const auto text = [&](const std::string& written, Binding binding) {
    return binding < least ? "(" + written + ")" : written;
  };
  if (term.operation() == Operation::literal)
    return text(decimal(term.value(), notation), term.value() < 0.0 ? Binding::sign : Binding::whole);
  if (term.operation() == Operation::constant) return program.constants[term.index()].name;
  if (term.operation() == Operation::variable)
    return variable_text(program.variables[term.index()], notation);
  const Shape shape = shape_of(term.operation());
  std::array<std::string, 3> operands;
  for (std::size_t i = 0; i < term.operands().size(); ++i)
    operands[i] = term_text(program, notation, term.operands()[i], i == 0 ? shape.left : shape.right);
  const std::string_view form = shape.form.empty() ? notation.forms.at(term.operation()) : shape.form;
  return text(fmt::format(fmt::runtime(form), operands[0], operands[1], operands[2]), shape.binding);
}

}  // namespace

std::string decimal(double value, const Notation& notation) {
  std::string text = notation.precision == Precision::single_precision
                         ? fmt::format("{}", static_cast<float>(value))
                         : fmt::format("{}", value);
  if (text.find('.') == std::string::npos) {
    const std::size_t exponent = text.find('e');
    text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
  }
  return text.append(notation.number_suffix);
}

std::string variable_text(const Variable& variable, const Notation& notation) {
  const std::string_view before = variable.role == Role::input   ? notation.input
                                  : variable.role == Role::state ? notation.state
                                                                 : "";
  return fmt::format("{}{}", before, variable.name);
}

std::string initial_text(const Variable& variable, const Notation& notation) {
  switch (variable.type) {
    case Type::flag:
      return std::string(variable.initial == 0.0 ? notation.no : notation.yes);
    case Type::count:
      if (notation.precision == Precision::single_precision) return fmt::format("{:.0f}", variable.initial);
      break;
    case Type::number:
      break;
  }
  return decimal(variable.initial, notation);
}

std::string statements_text(const Program& program, const Notation& notation, const Statements& statements,
                            std::size_t indent) {
  std::string text;
  const auto add = [&](std::string_view form, const auto&... parts) {
    text += std::string(indent, ' ') + fmt::format(fmt::runtime(form), parts...) + "\n";
  };
  for (const Statement& statement : statements) {
    switch (statement.kind) {
      case Statement::Kind::remark:
        add(notation.lines.remark, statement.text);
        break;
      case Statement::Kind::assignment: {
        const Variable& variable = program.variables[statement.variable];
        const bool is_flag = variable.type == Type::flag && statement.term.operation() == Operation::literal;
        add(notation.lines.assignment, variable_text(variable, notation),
            is_flag ? std::string(statement.term.value() == 0.0 ? notation.no : notation.yes)
                    : term_text(program, notation, statement.term));
        break;
      }
      case Statement::Kind::branch:
        add(notation.lines.if_begins, term_text(program, notation, statement.term));
        text += statements_text(program, notation, statement.holds, indent + 2);
        if (!statement.otherwise.empty()) {
          add(notation.lines.otherwise);
          text += statements_text(program, notation, statement.otherwise, indent + 2);
        }
        add(notation.lines.if_ends);
        break;
    }
  }
  return text;
}

std::vector<std::string> heading_lines(const ControllerToWrite& chain, Precision precision) {
  const std::string torque = parameters::unit_on(chain.axis, "N m");
  const std::string force = parameters::text_on(chain.axis, "$torque");
  std::vector<std::string> lines{
      fmt::format("The controller of the study {}, as zerocount simulates it.", chain.name), "",
      fmt::format("One step at each sample, {} Hz. Counts are those of an encoder of {} {} a count.",
                  chain.controller.sample_rate, chain.resolution, parameters::unit_on(chain.axis, "rad")),
      fmt::format(
          "The wanted {} is in {}. The converter behind it rounds it to steps of {} {} and limits it to",
          force, torque, chain.dac.resolution, torque),
      fmt::format(
          "{:.6g} ... {:.6g} {}; what it gave at the sample before is the input `torque` of the next.",
          loop::lowest_torque(chain.dac), loop::highest_torque(chain.dac), torque)};
  lines.insert(lines.end(), chain.remarks.begin(), chain.remarks.end());
  lines.emplace_back("");
  if (precision == Precision::double_precision) {
    lines.emplace_back("The constants are exact, and the operations in the order of the simulation: without");
    lines.emplace_back(
        "contracted or reordered operations (-ffp-contract=off, no -ffast-math) it computes the same");
    lines.emplace_back("bits.");
  } else {
    lines.emplace_back("In single precision: the constants are rounded to it, and counts are whole numbers.");
  }
  return lines;
}

}  // namespace zerocount::controller_code
