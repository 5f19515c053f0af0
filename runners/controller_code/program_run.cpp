#include "runners/controller_code/program_run.hpp"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace zerocount::controller_code {
namespace {

/// A program in one trial. Flags are 0 or 1; counts are kept in double precision, which has all of them.
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

  // One `switch` with a case of each operation.
  Number value_of(const Term& term) const {
    const auto value = [&](std::size_t i) { return value_of(term.operands()[i]); };
    const auto truth = [](bool is_true) { return is_true ? Number(1) : Number(0); };
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
      case Operation::limited: {
        const Number lowest = value(1);
        const Number highest = value(2);
        const Number x = value(0);
        const Number above = x < lowest ? lowest : x;
        return highest < above ? highest : above;
      }
      case Operation::is_even:
        return truth(static_cast<std::int64_t>(value(0)) % 2 == 0);
      case Operation::choice:
        return value(0) != Number(0) ? value(1) : value(2);
      case Operation::at_most:
        return truth(value(0) <= value(1));
      case Operation::at_least:
        return truth(value(0) >= value(1));
      case Operation::below:
        return truth(value(0) < value(1));
      case Operation::above:
        return truth(value(0) > value(1));
      case Operation::negation:
        return truth(value(0) == Number(0));
      case Operation::both:
        return truth(value(0) != Number(0) && value(1) != Number(0));
      case Operation::either:
        return truth(value(0) != Number(0) || value(1) != Number(0));
    }
    return Number(0);
  }

  std::shared_ptr<const Program> program_;
  std::vector<Number> constants_, numbers_;  ///< [constant], [variable]
  std::vector<double> counts_;               ///< [variable]
};

}  // namespace

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
