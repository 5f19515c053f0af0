#pragma once

#include <string>

#include "runners/controller_code/chain_program.hpp"

namespace zerocount::controller_code {

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

}  // namespace zerocount::controller_code
