#pragma once

#include <string>
#include <string_view>

#include "core/loop/parameters.hpp"

namespace zerocount::controller_code {

/// A control chain to be written as a program.
struct ControllerToWrite {
  loop::ControllerParameters controller;  ///< with gains per count
  double resolution{1.0};                 ///< Δx, rad per count
  loop::DacParameters dac{};              ///< whose range clamps the integral
  double initial_integral{0.0};           ///< I before the first sample, N m
  std::string name{};                     ///< of the study, for comments
};

/// Why the chain cannot be written; empty if it can: a plugin or two phases of control.
std::string_view why_not_writable(const loop::ControllerParameters& controller);

/// The chain as one C99 file without dependencies: its state in a struct, its constants as hexadecimal
/// doubles, the operations in the order of loop::ControlChain, so that it computes the same bits. With
/// ZEROCOUNT_PLUGIN defined it is a plugin for zerocount.
std::string c_code(const ControllerToWrite& chain);

/// The chain as a component of LinuxCNC's HAL, for halcompile. @param component its name, which is that of
/// the file without `.comp`.
std::string linuxcnc_component(const ControllerToWrite& chain, const std::string& component);

}  // namespace zerocount::controller_code
