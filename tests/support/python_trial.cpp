#include "tests/support/python_trial.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include "tests/support/trial_json.hpp"

namespace zerocount::testing {

namespace {

/// A folder of its own that goes when it is left.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "zerocount-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw std::runtime_error("cannot make a temporary folder: " + pattern);
    path_ = pattern;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

std::vector<SampleRecord> python_trial(const TrialParameters& parameters) {
  const ScratchFolder folder;
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
