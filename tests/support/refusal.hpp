#pragma once

#include "core/failure/failure.hpp"
#include "tests/support/test.hpp"

namespace zerocount {

/// The message with which an action is refused (by a Failure with this exit code); empty if it is not
/// refused.
template <class Action>
std::string refusal_by(const Action& action, ExitCode code = ExitCode::bad_input) {
  try {
    action();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), code) << failure.what();
    return failure.what();
  }
  return "";
}

}  // namespace zerocount
