#pragma once

#include <string>
#include <string_view>

#include "core/loop/parameters.hpp"
#include "experiments/parameters/study_units.hpp"
#include "runners/controller_code/program.hpp"

namespace zerocount::controller_code {

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
/// which differences are taken exactly, and a dither goes by a phase in place of the number of the sample.
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

}  // namespace zerocount::controller_code
