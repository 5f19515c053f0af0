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

/// A controller as statements, of which every language is written, and which can be run.
///
///     at each sample: the statements of `step`, which read inputs and states; then `wanted` has the torque

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
  count_difference,  ///< of two counts, as a number
  magnitude,
  limited,   ///< of x, lowest and highest
  nearest,   ///< whole number, a tie to the even one
  is_even,   ///< whether ⌊x⌋ is even, x ≥ 0
  choice,    ///< of a condition, the value where it holds, and the other
  at_most,   ///< ≤
  at_least,  ///< ≥
  below,     ///< <
  above,     ///< >
  negation,
  both,
  either
};

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// An expression.
class Term {
 public:
  Term(double literal)  // NOLINT(google-explicit-constructor): 2.0 * x
      : Term(Operation::literal, {}, 0, literal) {}
  Term(Operation operation, std::vector<Term> operands, std::size_t index = 0, double value = 0.0)
      : node_(std::make_shared<const Node>(Node{operation, std::move(operands), index, value})) {}

  Operation operation() const { return node_->operation; }
  const std::vector<Term>& operands() const { return node_->operands; }
  std::size_t index() const { return node_->index; }  ///< of a constant or variable in the program
  double value() const { return node_->value; }       ///< of a literal

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

/// A number with a name.
struct Constant {
  std::string name;
  double value{0.0};
  std::string meaning;  ///< with its unit
};

enum class Role {
  input,
  state,  ///< keeps its value to the next sample
  local
};
enum class Type {
  number,
  count,  ///< a number in double precision; in single precision, which cannot tell all counts, a whole number
  flag
};

struct Variable {
  std::string name;
  Role role{Role::local};
  Type type{Type::number};
  std::string meaning{};  ///< with its unit
  double initial{0.0};    ///< of a state
};

/// An assignment, a branch with a condition, or a remark.
struct Statement {
  enum class Kind { assignment, branch, remark };
  Kind kind;
  Term term{0.0};                               ///< the assigned value, or the condition
  std::size_t variable{0};                      ///< that is assigned
  std::vector<Statement> holds{}, otherwise{};  ///< the branches
  std::string text{};                           ///< of a remark
};
using Statements = std::vector<Statement>;

/// The inputs of every program, in the order of its variables; the last one only where a velocity loop reads
/// an encoder of its own.
enum class Input { error, count, velocity, acceleration, torque, new_target, velocity_count };

struct Program {
  Precision precision{Precision::double_precision};
  std::vector<Constant> constants{};
  std::vector<Variable> variables{};  ///< the inputs first
  Statements step{};
  std::size_t wanted{0};  ///< the variable with the result

  std::size_t inputs() const;  ///< their number
};

/// Makes a program, statement by statement.
class ProgramWriter {
 public:
  /// @param angle, torque units: "rad" and "N m"
  ProgramWriter(Precision precision, const std::string& angle, const std::string& torque,
                bool with_velocity_count);

  Term input(Input input) const;
  /// @throws std::logic_error if the program has another with this name
  Term constant(const std::string& name, double value, const std::string& meaning);
  Term variable(const Variable& variable);

  void remark(const std::string& text);
  /// Reads a part of the value from the variable that already has it.
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
  /// The term with variables in place of what they have.
  Term shortened(const Term& term) const;

  Program program_;
  Statements* at_;
  std::vector<Assigned> assigned_;  ///< since the last branch began or ended
};

/// The program as a control law of this process, statement by statement in its precision.
std::shared_ptr<const plugin::ControllerPlugin> law_of(const Program& program);

/// A control chain to be written as a program.
struct ControllerToWrite {
  loop::ControllerParameters controller;  ///< with gains per count
  double resolution{1.0};                 ///< Δx, rad per count
  double velocity_resolution{1.0};        ///< Δx of the encoder that a velocity loop reads, rad per count
  loop::DacParameters dac{};              ///< whose range clamps the integral
  double initial_integral{0.0};           ///< I before the first sample, N m
  std::string name{};                     ///< of the study, for comments
  parameters::AxisKind axis{parameters::AxisKind::rotary};
  std::vector<std::string> remarks{};  ///< lines of the heading
};

/// Why the chain cannot be written; empty if it can: a plugin or two phases of control, and in single
/// precision feedback from the coarse encoder.
std::string_view why_not_writable(const loop::ControllerParameters& controller, Precision precision);

/// The chain, with the operations in the order of loop::ControlChain, so that it computes the same bits in
/// double precision. Terms with a gain of 0 are left out. In single precision counts are whole numbers, of
/// which differences are taken exactly, and a dither goes by a phase in place of the number of the sample. A
/// drive is switched on at rest: whatever the study starts with, the counts before the first are the first,
/// and past values of filters and observer are 0.
Program chain_program(const ControllerToWrite& chain, Precision precision);

/// The program as one C99 file without dependencies: its states in a struct, its constants by name. With
/// ZEROCOUNT_PLUGIN defined it is a plugin for zerocount.
/// @param chain that the program is of, for the heading
std::string c_code(const ControllerToWrite& chain, const Program& program);

/// The program as a component of LinuxCNC's HAL, for halcompile. @param component its name, which is that of
/// the file without `.comp`.
std::string linuxcnc_component(const ControllerToWrite& chain, const Program& program,
                               const std::string& component);

/// The program as a function block in Structured Text (IEC 61131-3).
std::string structured_text(const ControllerToWrite& chain, const Program& program,
                            const std::string& function_block);

/// How a language writes programs. `{0}`, `{1}` … stand for the operands.
struct Notation {
  struct Lines {
    std::string_view assignment{}, if_begins{}, otherwise{}, if_ends{}, remark{};
  };
  Precision precision{Precision::double_precision};
  std::string_view number_suffix{};   ///< of a decimal constant
  std::string_view input{}, state{};  ///< what stands before the names of these variables
  std::string_view no{}, yes{};       ///< a flag that is 0, and 1
  /// The operations that languages write in different ways.
  std::map<Operation, std::string_view> forms{};
  Lines lines{};
};

/// The shortest decimal number, with a point, that reads back to the same value in this precision.
std::string decimal(double value, const Notation& notation);

std::string variable_text(const Variable& variable, const Notation& notation);
/// The value of a variable: a flag as such, otherwise a decimal number.
std::string initial_text(const Variable& variable, const Notation& notation);

/// A line for each statement. @param indent of the lines
std::string statements_text(const Program& program, const Notation& notation, const Statements& statements,
                            std::size_t indent);

/// What stands above the code. Without comment signs.
std::vector<std::string> heading_lines(const ControllerToWrite& chain, Precision precision);

}  // namespace zerocount::controller_code
