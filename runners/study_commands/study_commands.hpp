#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "runners/commands/command.hpp"
#include "runners/controller_code/program.hpp"

namespace zerocount::study_commands {

/// Lines of text about the effect of single precision in the controller on the trials of a design point: "of
/// 500 trials 499 meet the goal (in double precision 500), …". Simulates trials with the controller in both
/// precisions, on the same machines and random numbers:
///
///     for evenly spaced trials of the point, as many as some seconds of computing time allow:
///       run the trial with the program in double precision, then with the program in single precision
///
/// @param point index of the design point
/// @param chain controller that is written as a program
/// @throws trial::Interrupted if `stop` is requested
std::vector<std::string> effect_of_single_precision(const study::Study& study, std::int64_t point,
                                                    const controller_code::ControllerToWrite& chain,
                                                    const std::stop_token& stop);

commands::Command new_command();
commands::Command status_command();
commands::Command run_command();
commands::Command verify_command();
commands::Command merge_command();
commands::Command parameters_command();
commands::Command trace_command();
commands::Command export_command();
commands::Command controller_command();
commands::Command check_command();

}  // namespace zerocount::study_commands
