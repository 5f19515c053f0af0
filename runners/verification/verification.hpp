#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/failure/failure.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "results/storage/durable_file.hpp"

/// Checks whether results files are undamaged and contain what their manifests describe.
namespace zerocount::verification {

/// Result of one check of a results file.
struct Check {
  std::string name;
  std::string detail{};  ///< Extent of the check, such as "400 trials".
  /// Problems that the check found, one line each; empty: the check holds.
  std::vector<std::string> problems{};
  bool skipped{false};  ///< Whether the check was skipped; `detail` says why.
};

/// Results of the checks of a file, or of a folder of shards (files with some trials of a study) as a whole.
struct CheckReport {
  std::filesystem::path path;
  std::vector<Check> checks{};
  /// Whether the computer failed to read the file, or to write what a check needs, so that the file may be
  /// good.
  bool unreadable{false};
  std::stop_token stop{};  ///< Token that interrupts the checks when a stop is requested.
  /// Folder for temporary files (VerifySettings::scratch); null: nothing is written.
  std::shared_ptr<storage::ScratchFolder> scratch{};
};

/// Whether all checks of the report hold.
bool holds(const CheckReport& report);

/// Maximum number of problems that a check lists. Further problems are only counted.
inline constexpr std::size_t max_problems = 20;

/// Adds problems to the list of a check. Problems beyond max_problems are only counted; the destructor adds
/// their number.
class ProblemList {
 public:
  explicit ProblemList(Check& check) : check_(check) {}
  ProblemList(const ProblemList&) = delete;
  ProblemList& operator=(const ProblemList&) = delete;
  ~ProblemList();

  void add(std::string problem);

 private:
  Check& check_;
  std::size_t others_{0};
};

/// Message of a failure, without the path of the file with which it begins.
std::string problem_of(const Failure& failure, const std::filesystem::path& path);

/// Throws if a stop of the checks was requested.
/// @throws Failure (interrupted) in this case
void require_no_stop(const std::stop_token& stop);

/// Makes a check with this name and adds it to the report. `work(check, problems)` adds the problems that it
/// finds. A Failure that it throws is a problem too.
/// @return whether the check holds
/// @throws Failure (interrupted) if a stop was requested.
template <class Work>
bool add_check(CheckReport& report, std::string_view name, const Work& work) {
  require_no_stop(report.stop);
  Check check{std::string(name)};
  {
    ProblemList problems(check);
    try {
      work(check, problems);
    } catch (const Failure& failure) {
      if (failure.code() == ExitCode::interrupted) throw;
      report.unreadable = report.unreadable || failure.code() == ExitCode::machine_failed;
      problems.add(problem_of(failure, report.path));
    }
  }
  report.checks.push_back(std::move(check));
  return report.checks.back().problems.empty();
}

/// Settings of verify(), which checks results files.
struct VerifySettings {
  std::int64_t trials{20};  ///< Number of trials to simulate again, per file or per folder of shards.
  std::uint64_t seed{1};    ///< Seed for the random choice of the trials to simulate again.
  /// User's controller for a study with a plugin; null: none is given.
  std::shared_ptr<const plugin::ControllerPlugin> plugin{};
  std::stop_token stop{};
  /// Folder for the temporary files that the checks write.
  std::shared_ptr<storage::ScratchFolder> scratch = std::make_shared<storage::ScratchFolder>();
};

/// Checks results files, parts, shards (files with some trials), and folders of these. It goes on after a
/// failed check. But a read that fails although the checksum was right ends the process
/// (hdf5/file_driver.hpp).
/// @returns one report per file, in the order of the operands, and one per folder of shards after its files
/// @throws Failure: interrupted if a stop was requested; bad_input if an operand does not exist, a folder has
/// no results files, or the controller of a study is a plugin that is not given
std::vector<CheckReport> verify(std::span<const std::filesystem::path> operands,
                                const VerifySettings& settings);

}  // namespace zerocount::verification
