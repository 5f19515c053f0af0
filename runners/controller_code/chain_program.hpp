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

}  // namespace zerocount::controller_code
