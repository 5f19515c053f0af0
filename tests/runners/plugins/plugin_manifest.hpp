#pragma once

#include <string>

namespace zerocount::testing {

/// The path of the plugin built from faulty_controller.c with this fault; fault 0: none.
inline std::string faulty_controller(int fault) {
  return ZEROCOUNT_FAULTY_CONTROLLERS "/faulty_controller_" + std::to_string(fault) + ".so";
}

/// The path of an example plugin, such as "pi_c" or "pi_cpp".
inline std::string example_controller(const std::string& name) {
  return ZEROCOUNT_EXAMPLE_CONTROLLERS "/" + name + ".so";
}

/// The manifest of a small study whose controller is this plugin, named on the fifth line.
/// @param more further keys
inline std::string plugin_manifest(const std::string& plugin, const std::string& more = "") {
  return "zerocount: 1\nname: small\nseed: 5\ntrials: 8\ncontroller: {plugin: " + plugin +
         "}\ncommand: {targets: [{integers: [1, 30]}], hold: 0.15}\n"
         "initial: {encoder_phase: {uniform: [0, 1]}}\n" +
         more;
}

}  // namespace zerocount::testing
