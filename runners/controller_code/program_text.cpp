#include "runners/controller_code/program_text.hpp"

#include <string>

#include <fmt/format.h>

namespace zerocount::controller_code {
namespace {

/// The weakest binding first; both languages agree on the order.
enum class Binding { either, both, comparison, sum, product, sign, whole };

struct Text {
  std::string text;
  Binding binding;
};

class TermWriter {
 public:
  TermWriter(const Program& program, const Notation& notation) : program_(program), notation_(notation) {}

  Text write(const Term& term) const {
    switch (term.operation()) {
      case Operation::literal:
        return {decimal(term.value(), notation_), term.value() < 0.0 ? Binding::sign : Binding::whole};
      case Operation::constant:
        return {program_.constants[term.index()].name, Binding::whole};
      case Operation::variable:
        return {variable_text(program_.variables[term.index()], notation_), Binding::whole};
      case Operation::negative:
        return {"-" + within(term.operands()[0], Binding::whole), Binding::sign};
      case Operation::negation:
        return {fmt::format("{}{}", notation_.operators.negation, within(term.operands()[0], Binding::whole)),
                Binding::sign};
      case Operation::sum:
        return infix(term, " + ", Binding::sum);
      case Operation::difference:
        return infix(term, " - ", Binding::sum);
      case Operation::product:
        return infix(term, " * ", Binding::product);
      case Operation::quotient:
        return infix(term, " / ", Binding::product);
      case Operation::at_most:
        return infix(term, " <= ", Binding::comparison);
      case Operation::at_least:
        return infix(term, " >= ", Binding::comparison);
      case Operation::below:
        return infix(term, " < ", Binding::comparison);
      case Operation::above:
        return infix(term, " > ", Binding::comparison);
      case Operation::both:
        return infix(term, notation_.operators.both, Binding::both);
      case Operation::either:
        return infix(term, notation_.operators.either, Binding::either);
      case Operation::count_difference:
        return call(term, notation_.calls.count_difference);
      case Operation::magnitude:
        return call(term, notation_.calls.magnitude);
      case Operation::limited:
        return call(term, notation_.calls.limited);
      case Operation::is_even:
        return call(term, notation_.calls.is_even);
      case Operation::choice:
        return call(term, notation_.calls.choice);
    }
    return {};
  }

 private:
  /// The text, in parentheses where it does not bind as strongly.
  std::string within(const Term& term, Binding least) const {
    const Text text = write(term);
    return text.binding < least ? "(" + text.text + ")" : text.text;
  }

  /// Operators of equal strength act from the left. In a disjunction a conjunction gets parentheses too.
  Text infix(const Term& term, std::string_view sign, Binding binding) const {
    const auto next = static_cast<Binding>(static_cast<int>(binding) + 1);
    const Binding left = binding == Binding::either ? Binding::comparison : binding;
    const Binding right = binding == Binding::either ? Binding::comparison : next;
    return {fmt::format("{}{}{}", within(term.operands()[0], left), sign, within(term.operands()[1], right)),
            binding};
  }

  Text call(const Term& term, std::string_view form) const {
    std::vector<std::string> texts;
    for (const Term& operand : term.operands()) texts.push_back(write(operand).text);
    texts.resize(3);
    return {fmt::format(fmt::runtime(form), texts[0], texts[1], texts[2]), Binding::whole};
  }

  const Program& program_;
  const Notation& notation_;
};

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

std::string term_text(const Program& program, const Notation& notation, const Term& term) {
  return TermWriter(program, notation).write(term).text;
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

std::string lines_after(std::string_view before, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += fmt::format("{}{}\n", before, line);
  return text;
}

}  // namespace zerocount::controller_code
