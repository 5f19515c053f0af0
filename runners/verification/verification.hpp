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

/// Checks whether results files are undamaged, and contain what their manifests describe.
namespace zerocount::verification {

/// One check of a file.
struct Check {
  std::string name;
  std::string detail{};                 ///< Extent of the check: "400 trials".
  std::vector<std::string> problems{};  ///< Problems, one line each; empty: the check holds.
  bool skipped{false};                  ///< Whether the check was skipped; `detail` says why.
};

/// Checks of a file, or of a folder of shards as a whole.
struct CheckReport {
  std::filesystem::path path;
  std::vector<Check> checks{};
  bool unreadable{false};  ///< The computer failed to read the file, or to write what a check needs.
  std::stop_token stop{};  ///< Interrupts the checks.
  std::shared_ptr<storage::ScratchFolder> scratch{};  ///< VerifySettings::scratch; null: nothing is written.
};

/// Whether all checks hold.
bool holds(const CheckReport& report);

/// Maximum number of problems that a check lists. Further problems are only counted.
inline constexpr std::size_t max_problems = 20;

/// Adds problems to a check. Problems beyond max_problems are only counted.
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

/// Message of a failure without the path of the file at its beginning.
std::string problem_of(const Failure& failure, const std::filesystem::path& path);

/// Checks for a stop request.
/// @throws Failure (interrupted) if a stop was requested
void require_no_stop(const std::stop_token& stop);

/// Makes a check and adds it to the report. A Failure that `work(check, problems)` throws is a problem too.
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

/// Settings of verify().
struct VerifySettings {
  std::int64_t trials{20};  ///< Number of trials to rerun, per file or per folder of shards.
  std::uint64_t seed{1};    ///< Seed for the choice of these trials.
  std::shared_ptr<const plugin::ControllerPlugin> plugin{};  ///< User's controller; null: none is given.
  std::stop_token stop{};
  /// Folder for the files that the checks write.
  std::shared_ptr<storage::ScratchFolder> scratch = std::make_shared<storage::ScratchFolder>();
};

/// Verifies results files, parts, shards, and folders of these. It goes on after a failed check. But a read
/// that fails although the checksum was right ends the process (hdf5/file_driver.hpp).
/// @returns one report per file, in the order of the operands, and one per folder of shards after its files
/// @throws Failure: interrupted if a stop was requested; bad_input if an operand does not exist, a folder has
/// no results files, or the controller of a study is a plugin that is not given
std::vector<CheckReport> verify(std::span<const std::filesystem::path> operands,
                                const VerifySettings& settings);

}  // namespace zerocount::verification
