#include "tests/support/python_trial.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tests/support/trial_json.hpp"

namespace zerocount::testing {

std::vector<trial::SampleRecord> python_trial(const trial::TrialParameters& parameters) {
  const TemporaryFolder folder;
  const std::filesystem::path input = folder.path() / "parameters.json";
  const std::filesystem::path output = folder.path() / "trace.csv";
  std::ofstream(input) << to_json(parameters);
  const std::string command = std::string(ZEROCOUNT_JUDGE_PYTHON) + " -B '" + ZEROCOUNT_JUDGE_SCRIPT + "' '" +
                              input.string() + "' -o '" + output.string() + "'";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed (numpy is needed): " + command);
  std::ifstream trace(output);
  return read_trace_csv(trace);
}

}  // namespace zerocount::testing
