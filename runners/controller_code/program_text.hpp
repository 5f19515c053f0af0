#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runners/controller_code/chain_program.hpp"

namespace zerocount::controller_code {

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
