#include "runners/controller_code/program.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace zerocount::controller_code {
namespace {

template <class Named>
void require_new(const std::vector<Named>& all, const std::string& name) {
  if (std::ranges::find(all, name, &Named::name) != all.end())
    throw std::logic_error("the program has two of the name " + name);
}

}  // namespace

ProgramWriter::ProgramWriter(Precision precision, const std::string& angle, const std::string& torque)
    : program_{.precision = precision}, at_(&program_.step) {
  program_.variables = {
      {"error", Role::input, Type::number, "the reference, rounded to counts, less the count"},
      {"count", Role::input, Type::count, "of the encoder, counts"},
      {"velocity", Role::input, Type::number, "of the reference, " + angle + "/s"},
      {"acceleration", Role::input, Type::number, "of the reference, " + angle + "/s^2"},
      {"torque", Role::input, Type::number,
       "that the converter gave at the sample before, " + torque + "; 0 at the first"},
      {"new_target", Role::input, Type::flag, "the target is not that of the sample before"}};
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
  at_->push_back({.kind = Statement::Kind::assignment, .term = value, .variable = variable.index()});
}

void ProgramWriter::branch(const Term& condition, const std::function<void()>& holds,
                           const std::function<void()>& otherwise) {
  Statement statement{.kind = Statement::Kind::branch, .term = condition};
  statement.holds = statements_of(holds);
  if (otherwise) statement.otherwise = statements_of(otherwise);
  at_->push_back(std::move(statement));
}

Statements ProgramWriter::statements_of(const std::function<void()>& write) {
  Statements statements;
  Statements* const outside = std::exchange(at_, &statements);
  write();
  at_ = outside;
  return statements;
}

Program ProgramWriter::finished(const Term& wanted) {
  program_.wanted = wanted.index();
  return std::move(program_);
}

}  // namespace zerocount::controller_code
