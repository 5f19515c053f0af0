#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/loop/parameters.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "experiments/parameters/study_units.hpp"

namespace zerocount::controller_code {

/// A controller as a list of statements. The code in C, Structured Text or for LinuxCNC is written from these
/// statements, and they can be run in this process.
///
///     at each sample: run `step`, whose statements read inputs and states; then `wanted` holds the torque

enum class Precision { double_precision, single_precision };

enum class Operation {
  literal,
  constant,
  variable,
  negative,
  sum,
  difference,
  product,
  quotient,
  count_difference,  ///< Difference of two encoder counts (first minus second operand), as a number.
  magnitude,
  limited,   ///< A value x limited to a range; operands: x, lower end, upper end.
  nearest,   ///< Nearest whole number to the operand; ties go to the even one.
  is_even,   ///< Whether ⌊x⌋ of the operand x is even, for x ≥ 0.
  choice,    ///< Choice by a condition; operands: condition, value if it holds, value otherwise.
  at_most,   ///< Whether the first operand is ≤ the second.
  at_least,  ///< Whether the first operand is ≥ the second.
  below,     ///< Whether the first operand is < the second.
  above,     ///< Whether the first operand is > the second.
  negation,
  both,
  either
};

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// An expression tree: an operation with its operands, a literal, a constant or a variable. Copies share
/// their nodes.
class Term {
 public:
  Term(double literal)  // NOLINT(google-explicit-constructor): 2.0 * x
      : Term(Operation::literal, {}, 0, literal) {}
  Term(Operation operation, std::vector<Term> operands, std::size_t index = 0, double value = 0.0)
      : node_(std::make_shared<const Node>(Node{operation, std::move(operands), index, value})) {}

  Operation operation() const { return node_->operation; }
  const std::vector<Term>& operands() const { return node_->operands; }
  /// Index of a constant in Program::constants, or of a variable in Program::variables.
  std::size_t index() const { return node_->index; }
  double value() const { return node_->value; }  ///< Value of a literal; only for Operation::literal.

  friend bool is_same(const Term& a, const Term& b) { return a.node_ == b.node_; }
  friend bool is_literal(const Term& a) { return a.operation() == Operation::literal; }
  friend bool is_literal(const Term& a, double value) { return is_literal(a) && a.value() == value; }
  friend bool is_zero(const Term& a) { return is_literal(a, 0.0); }

  // The functions of core/numerics/number.hpp, by which the formulas of core/loop give terms. What does not
  // act, such as a gain of 0 or an endless range, is a literal and leaves no term behind.

  friend Term operator-(const Term& a) { return {Operation::negative, {a}}; }
  friend Term operator+(const Term& a, const Term& b) {
    return is_zero(a) ? b : is_zero(b) ? a : Term(Operation::sum, {a, b});
  }
  friend Term operator-(const Term& a, const Term& b) {
    if (is_zero(b)) return a;
    if (!is_zero(a)) return {Operation::difference, {a, b}};
    return b.operation() == Operation::product ? -b.operands()[0] * b.operands()[1] : -b;
  }
  friend Term operator*(const Term& a, const Term& b) {
    if (is_zero(a) || is_zero(b)) return 0.0;
    if (is_literal(a, 1.0)) return b;
    if (is_literal(b, 1.0)) return a;
    if (is_literal(b, -1.0)) return -a;
    // Some compilers of Structured Text take a literal in double precision.
    if (is_literal(a, -2.0)) return -(b + b);
    if (b.operation() == Operation::choice && is_literal(b.operands()[1]))
      return select(b.operands()[0], a * b.operands()[1], a * b.operands()[2]);
    return {Operation::product, {a, b}};
  }
  friend Term operator/(const Term& a, const Term& b) { return {Operation::quotient, {a, b}}; }
  friend Term operator<=(const Term& a, const Term& b) {
    const bool never = a.operation() == Operation::magnitude && is_literal(b) && b.value() < 0.0;
    return never ? Term(0.0) : Term(Operation::at_most, {a, b});
  }
  friend Term operator>=(const Term& a, const Term& b) { return {Operation::at_least, {a, b}}; }
  friend Term operator<(const Term& a, const Term& b) { return {Operation::below, {a, b}}; }
  friend Term operator>(const Term& a, const Term& b) {
    return is_literal(b, unbounded) ? Term(0.0) : Term(Operation::above, {a, b});
  }
  friend Term operator!=(const Term& flag, const Term& /*zero*/) { return flag; }
  friend Term operator==(const Term& flag, const Term& /*zero*/) { return !flag; }
  friend Term operator!(const Term& a) { return {Operation::negation, {a}}; }
  friend Term operator&(const Term& a, const Term& b) { return {Operation::both, {a, b}}; }
  friend Term operator|(const Term& a, const Term& b) {
    return is_zero(a) ? b : is_zero(b) ? a : Term(Operation::either, {a, b});
  }
  friend Term select(const Term& condition, const Term& where_it_holds, const Term& otherwise) {
    if (is_zero(condition) || is_same(where_it_holds, otherwise)) return otherwise;
    if (is_literal(where_it_holds, 1.0) && is_zero(otherwise)) return condition;
    return {Operation::choice, {condition, where_it_holds, otherwise}};
  }
  friend Term rint(const Term& x) { return {Operation::nearest, {x}}; }
  friend Term abs(const Term& x) { return {Operation::magnitude, {x}}; }
  friend Term sign(const Term& x) { return select(x > 0.0, 1.0, select(x < 0.0, -1.0, 0.0)); }
  // Only one of the other: a range.
  friend Term max(const Term& x, const Term& lowest) {
    return is_literal(lowest, -unbounded) ? x : Term(Operation::limited, {x, lowest, unbounded});
  }
  friend Term min(const Term& x, const Term& highest) {
    if (is_literal(highest, unbounded)) return x;
    return {Operation::limited, {x.operands()[0], x.operands()[1], highest}};
  }

 private:
  struct Node {
    Operation operation;
    std::vector<Term> operands;
    std::size_t index;
    double value;
  };
  std::shared_ptr<const Node> node_;
};

/// A named constant of a controller program, such as a gain.
struct Constant {
  std::string name;
  double value{0.0};
  std::string meaning;  ///< Meaning with the unit, which the written code has as a comment.
};

enum class Role {
  input,
  state,  ///< A variable that keeps its value until the next sample.
  local
};
enum class Type {
  number,
  /// An encoder count: a number in double precision; in single precision, which cannot represent all counts,
  /// a whole number.
  count,
  flag
};

struct Variable {
  std::string name;
  Role role{Role::local};
  Type type{Type::number};
  std::string meaning{};  ///< Meaning with the unit, which the written code has as a comment.
  double initial{0.0};    ///< Value of a state before the first sample.
};

/// A statement of a controller program: an assignment, a branch with a condition, or a remark (comment).
struct Statement {
  enum class Kind { assignment, branch, remark };
  Kind kind;
  Term term{0.0};           ///< Value that is assigned, or condition of a branch.
  std::size_t variable{0};  ///< Index in Program::variables of the variable that an assignment sets.
  /// Statements that a branch runs if its condition holds, and otherwise.
  std::vector<Statement> holds{}, otherwise{};
  std::string text{};  ///< Text of a remark (comment).
};
using Statements = std::vector<Statement>;

/// Inputs of a controller program, in the order of its first variables. The last input exists only if a
/// velocity loop reads an encoder of its own.
enum class Input { error, count, velocity, acceleration, torque, new_target, velocity_count };

/// A controller as a program that runs once per sample: constants, variables, and the statements `step`.
struct Program {
  Precision precision{Precision::double_precision};
  std::vector<Constant> constants{};
  /// Variables of the program. The inputs come first, in the order of Input.
  std::vector<Variable> variables{};
  Statements step{};
  std::size_t wanted{0};  ///< Index in `variables` of the variable that holds the wanted torque after `step`.

  std::size_t inputs() const;  ///< Number of inputs, which are the first variables.
};

/// Makes a Program, statement by statement. Its functions append to the program in the order of their calls.
class ProgramWriter {
 public:
  /// @param angle unit of angles, such as "rad"
  /// @param torque unit of torques, such as "N m"
  /// @param with_velocity_count whether the velocity loop reads an encoder of its own, which is then the last
  /// input
  ProgramWriter(Precision precision, const std::string& angle, const std::string& torque,
                bool with_velocity_count);

  Term input(Input input) const;
  /// Adds a named constant to the program. Returns the term that refers to it.
  /// @throws std::logic_error if the program has another constant with this name
  Term constant(const std::string& name, double value, const std::string& meaning);
  Term variable(const Variable& variable);

  void remark(const std::string& text);
  /// Appends the statement `variable` = `value`. Subexpressions that a variable already holds are read from
  /// this variable.
  void assign(const Term& variable, const Term& value);
  void branch(const Term& condition, const std::function<void()>& holds,
              const std::function<void()>& otherwise = {});

  Program finished(const Term& wanted);

 private:
  struct Assigned {
    Term value;
    Term variable;
  };

  Statements statements_of(const std::function<void()>& write);
  /// The term with those subexpressions replaced whose value a variable already holds, because it was
  /// assigned before.
  Term shortened(const Term& term) const;

  Program program_;
  Statements* at_;
  /// Values assigned to variables since the last branch began or ended; they are still valid.
  std::vector<Assigned> assigned_;
};

/// Control law for the simulation that runs the program in this process, statement by statement in its
/// precision.
std::shared_ptr<const plugin::ControllerPlugin> law_of(const Program& program);

/// A controller of a study that is to be written as a program in another language.
struct ControllerToWrite {
  loop::ControllerParameters controller;  ///< Parameters of the controller, with gains per count.
  double resolution{1.0};                 ///< Length Δx of a count of the position encoder, rad per count.
  /// Length of a count of the encoder that the velocity loop reads, rad per count.
  double velocity_resolution{1.0};
  loop::DacParameters dac{};     ///< Digital-to-analogue converter; its range limits the integral.
  double initial_integral{0.0};  ///< Value of the integral I before the first sample, N m.
  std::string name{};            ///< Name of the study, for comments in the code.
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  std::vector<std::string> remarks{};  ///< Further lines of text for the heading of the code.
};

/// Reason why the controller cannot be written as a program; empty if it can. Not writable are a plugin, two
/// phases of control and, in single precision, feedback from the coarse encoder.
std::string_view why_not_writable(const loop::ControllerParameters& controller, Precision precision);

/// Writes the controller of a study as a program. Its operations have the order of loop::ControlChain, so in
/// double precision it computes the same bits. Terms with a gain of 0 are left out. In single precision,
/// counts are whole numbers whose differences are exact, and a dither follows a phase instead of the sample
/// number. A real drive is switched on at rest. So, whatever the study starts with, the program takes the
/// first count for all counts before the first sample, and 0 for past values of filters and observer.
Program chain_program(const ControllerToWrite& chain, Precision precision);

/// Text of a C99 source file with the controller program, without dependencies. The states are members of a
/// struct, and the constants have names. With ZEROCOUNT_PLUGIN defined, the file is a plugin for zerocount.
/// @param chain controller of the program, for the heading
std::string c_code(const ControllerToWrite& chain, const Program& program);

/// Text of a source file for halcompile: a LinuxCNC HAL component that runs the controller program.
/// @param chain controller of the program, for the heading
/// @param component name of the component, equal to the file name without `.comp`
std::string linuxcnc_component(const ControllerToWrite& chain, const Program& program,
                               const std::string& component);

/// Text of a function block that runs the controller program, in Structured Text (IEC 61131-3).
/// @param chain controller of the program, for the heading
std::string structured_text(const ControllerToWrite& chain, const Program& program,
                            const std::string& function_block);

/// How a programming language writes the parts of a program. In forms of operations, `{0}`, `{1}` … stand for
/// the operands.
struct Notation {
  struct Lines {
    std::string_view assignment{}, if_begins{}, otherwise{}, if_ends{}, remark{};
  };
  Precision precision{Precision::double_precision};
  std::string_view number_suffix{};  ///< Suffix of a decimal constant, such as "f" for single precision in C.
  /// Prefixes of the names of the program's inputs, and of its state variables.
  std::string_view input{}, state{};
  std::string_view no{}, yes{};  ///< Text of a flag that is 0, and text of one that is 1.
  /// Forms of the operations that languages write in different ways, such as a choice by a condition.
  std::map<Operation, std::string_view> forms{};
  Lines lines{};
};

/// Text of a number: the shortest decimal number, with a decimal point, that reads back to the same value in
/// the precision of the notation.
std::string decimal(double value, const Notation& notation);

/// Text that refers to a variable of the program: its name with the prefix of its role.
std::string variable_text(const Variable& variable, const Notation& notation);
/// Text of the initial value of a variable: a flag as `no` or `yes`, others as a decimal number.
std::string initial_text(const Variable& variable, const Notation& notation);

/// Text of the statements in the notation of a language, with a line for each assignment.
/// @param indent number of blanks before each line
std::string statements_text(const Program& program, const Notation& notation, const Statements& statements,
                            std::size_t indent);

/// Lines of the heading above the written code, without comment signs.
std::vector<std::string> heading_lines(const ControllerToWrite& chain, Precision precision);

}  // namespace zerocount::controller_code
