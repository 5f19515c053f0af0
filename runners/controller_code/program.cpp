#include "runners/controller_code/program.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace zerocount::controller_code {
namespace {

template <class Named>
void require_new(const std::vector<Named>& all, const std::string& name) {
  if (std::ranges::find(all, name, &Named::name) != all.end())
    throw std::logic_error("the program has two of the name " + name);
}

/// Runs a controller program in this process: holds the values of its variables during a trial, in the
/// precision `Number`. Flags are 0 or 1. Counts are kept in double precision, which represents all counts.
template <class Number>
class RunningProgram {
 public:
  explicit RunningProgram(std::shared_ptr<const Program> program)
      : program_(std::move(program)),
        numbers_(program_->variables.size()),
        counts_(program_->variables.size()) {
    for (std::size_t i = 0; i < numbers_.size(); ++i) set(i, program_->variables[i].initial);
    for (const Constant& constant : program_->constants)
      constants_.push_back(static_cast<Number>(constant.value));
  }

  double operator()(const zerocount_sample& now) {
    const auto give = [this](Input input, double value) { set(static_cast<std::size_t>(input), value); };
    give(Input::error, now.error);
    give(Input::count, now.count);
    give(Input::velocity, now.velocity);
    give(Input::acceleration, now.acceleration);
    give(Input::torque, now.torque);
    give(Input::new_target, now.new_target);
    if (program_->inputs() > static_cast<std::size_t>(Input::velocity_count))
      give(Input::velocity_count, now.other_count);
    run(program_->step);
    return static_cast<double>(numbers_[program_->wanted]);
  }

 private:
  void set(std::size_t variable, double value) {
    numbers_[variable] = static_cast<Number>(value);
    counts_[variable] = value;
  }

  void run(const Statements& statements) {
    for (const Statement& statement : statements) {
      switch (statement.kind) {
        case Statement::Kind::remark:
          break;
        case Statement::Kind::assignment:
          assign(statement);
          break;
        case Statement::Kind::branch:
          run(holds(statement.term) ? statement.holds : statement.otherwise);
          break;
      }
    }
  }

  void assign(const Statement& statement) {
    const std::size_t to = statement.variable;
    if (program_->variables[to].type == Type::count) counts_[to] = counts_[statement.term.index()];
    numbers_[to] = value_of(statement.term);
  }

  bool holds(const Term& term) const { return value_of(term) != Number(0); }

  Number value_of(const Term& term) const {
    const auto value = [&](std::size_t i) { return value_of(term.operands()[i]); };
    const auto is_true = [&](std::size_t i) { return holds(term.operands()[i]); };
    const auto truth = [](bool holds) { return holds ? Number(1) : Number(0); };
    switch (term.operation()) {
      case Operation::literal:
        return static_cast<Number>(term.value());
      case Operation::constant:
        return constants_[term.index()];
      case Operation::variable:
        return numbers_[term.index()];
      case Operation::negative:
        return -value(0);
      case Operation::sum:
        return value(0) + value(1);
      case Operation::difference:
        return value(0) - value(1);
      case Operation::product:
        return value(0) * value(1);
      case Operation::quotient:
        return value(0) / value(1);
      case Operation::count_difference:
        return static_cast<Number>(counts_[term.operands()[0].index()] - counts_[term.operands()[1].index()]);
      case Operation::magnitude:
        return std::abs(value(0));
      case Operation::limited:
        return std::min(std::max(value(0), value(1)), value(2));
      case Operation::nearest:
        return std::nearbyint(value(0));
      case Operation::is_even:
        return truth(static_cast<std::int64_t>(value(0)) % 2 == 0);
      case Operation::choice:
        return is_true(0) ? value(1) : value(2);
      case Operation::at_most:
        return truth(value(0) <= value(1));
      case Operation::at_least:
        return truth(value(0) >= value(1));
      case Operation::below:
        return truth(value(0) < value(1));
      case Operation::above:
        return truth(value(0) > value(1));
      case Operation::negation:
        return truth(!is_true(0));
      case Operation::both:
        return truth(is_true(0) && is_true(1));
      case Operation::either:
        return truth(is_true(0) || is_true(1));
    }
    return Number(0);
  }

  std::shared_ptr<const Program> program_;
  /// [constant] values of the constants; [variable] values of the variables that are numbers or flags.
  std::vector<Number> constants_, numbers_;
  std::vector<double> counts_;  ///< [variable] Values of the variables that are counts.
};

}  // namespace

std::size_t Program::inputs() const {
  return static_cast<std::size_t>(std::ranges::count(variables, Role::input, &Variable::role));
}

ProgramWriter::ProgramWriter(Precision precision, const std::string& angle, const std::string& torque,
                             bool with_velocity_count)
    : program_{.precision = precision}, at_(&program_.step) {
  program_.variables = {
      {"error", Role::input, Type::number, "the reference, rounded to counts, less the count"},
      {"count", Role::input, Type::count, "of the encoder, counts"},
      {"velocity", Role::input, Type::number, "of the reference, " + angle + "/s"},
      {"acceleration", Role::input, Type::number, "of the reference, " + angle + "/s^2"},
      {"torque", Role::input, Type::number,
       "that the converter gave at the sample before, " + torque + "; 0 at the first"},
      {"new_target", Role::input, Type::flag, "the target is not that of the sample before"}};
  if (with_velocity_count)
    variable(
        {"velocity_count", Role::input, Type::count, "of the encoder of the velocity loop, counts of it"});
}

Term ProgramWriter::input(Input input) const {
  return {Operation::variable, {}, static_cast<std::size_t>(input)};
}

Term ProgramWriter::constant(const std::string& name, double value, const std::string& meaning) {
  require_new(program_.constants, name);
  require_new(program_.variables, name);
  program_.constants.push_back({name, value, meaning});
  return {Operation::constant, {}, program_.constants.size() - 1};
}

Term ProgramWriter::variable(const Variable& variable) {
  require_new(program_.constants, variable.name);
  require_new(program_.variables, variable.name);
  program_.variables.push_back(variable);
  return {Operation::variable, {}, program_.variables.size() - 1};
}

void ProgramWriter::remark(const std::string& text) {
  at_->push_back({.kind = Statement::Kind::remark, .text = text});
}

void ProgramWriter::assign(const Term& variable, const Term& value) {
  at_->push_back(
      {.kind = Statement::Kind::assignment, .term = shortened(value), .variable = variable.index()});
  std::erase_if(assigned_, [&](const Assigned& one) { return one.variable.index() == variable.index(); });
  if (!value.operands().empty()) assigned_.push_back({value, variable});
}

Term ProgramWriter::shortened(const Term& term) const {
  const auto found =
      std::ranges::find_if(assigned_, [&](const Assigned& one) { return is_same(one.value, term); });
  if (found != assigned_.end()) return found->variable;
  if (term.operands().empty()) return term;
  std::vector<Term> operands;
  for (const Term& operand : term.operands()) operands.push_back(shortened(operand));
  return {term.operation(), operands};
}

void ProgramWriter::branch(const Term& condition, const std::function<void()>& holds,
                           const std::function<void()>& otherwise) {
  Statement statement{.kind = Statement::Kind::branch, .term = shortened(condition)};
  statement.holds = statements_of(holds);
  if (otherwise) statement.otherwise = statements_of(otherwise);
  at_->push_back(std::move(statement));
}

Statements ProgramWriter::statements_of(const std::function<void()>& write) {
  Statements statements;
  Statements* const outside = std::exchange(at_, &statements);
  assigned_.clear();
  write();
  assigned_.clear();
  at_ = outside;
  return statements;
}

Program ProgramWriter::finished(const Term& wanted) {
  program_.wanted = wanted.index();
  return std::move(program_);
}

std::shared_ptr<const plugin::ControllerPlugin> law_of(const Program& program) {
  plugin::ControllerPlugin law{.description = {"a written controller", "1", "", {}}};
  law.start = [shared =
                   std::make_shared<const Program>(program)](const zerocount_setup&) -> plugin::StepFunction {
    if (shared->precision == Precision::single_precision) return RunningProgram<float>(shared);
    return RunningProgram<double>(shared);
  };
  return std::make_shared<const plugin::ControllerPlugin>(std::move(law));
}

}  // namespace zerocount::controller_code
