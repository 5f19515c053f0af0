#pragma once

#include "analysis/basis/document/answer.hpp"
#include "analysis/trials/summary/chosen_point.hpp"
#include "runners/commands/command.hpp"

namespace zerocount::result_commands {

/// Answer of the command `learn` for a design point of a study: which unknown to measure next.
/// @param name name of the file, for messages
/// @throws Failure (bad_input) if nothing differs between worlds (draws of the values that nobody knows), or
/// no move is judged
document::Answer learned_of(const std::string& name, const summary::StudySummary& summary,
                            const summary::ChosenPoint& chosen);

commands::Command history_command();
commands::Command report_command();
commands::Command plot_command();
commands::Command sensitivity_command();
commands::Command jerks_command();
commands::Command compare_command();
commands::Command learn_command();
commands::Command monitor_command();
commands::Command accept_command();
commands::Command baseline_command();
commands::Command summary_command();
commands::Command judge_command();

}  // namespace zerocount::result_commands
