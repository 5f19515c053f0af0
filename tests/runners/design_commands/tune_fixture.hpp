#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/runners/program.hpp"

namespace zerocount::testing {

inline constexpr std::string_view axis = R"(zerocount: 1
name: axis
seed: 7
trials: 200
machines: 100   # machines
command: {targets: [29], hold: 0.3}
friction:
  k1: {lognormal: {median: 130, cv: 0.2}, per: machine}
initial: {encoder_phase: {uniform: [0, 1]}}
controller: {ki: 3.85e-5, delay: 1}
)";

inline constexpr std::string_view two_gains = R"(tune:
  free: {controller.ki: {log: [5.0e-6, 1.0e-3]}, controller.kp: [0, 5.0e-3]}
  margins: {spread: off}
)";

class Tune : public ProgramTest {
 protected:
  void write_axis(const std::string& more) { folder_.write("axis.yaml", std::string(axis) + more); }
  ProgramResult tune(std::vector<std::string> more = {}, const std::string& budget = "20000") {
    std::vector<std::string> words{"tune", "axis.yaml", "-o",       "tuned.h5", "--format",
                                   "json", "--force",   "--budget", budget};
    words.insert(words.end(), more.begin(), more.end());
    return program(words);
  }
};

}  // namespace zerocount::testing
