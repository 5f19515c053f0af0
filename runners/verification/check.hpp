#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/failure/failure.hpp"

namespace zerocount::verification {

/// One check of a file.
struct Check {
  std::string name;
  std::string detail{};                 ///< extent of the check: "400 trials"
  std::vector<std::string> problems{};  ///< one line each; none: the check holds
  bool skipped{false};                  ///< `detail` says why
};

/// The checks of a file, or of a folder of shards as a whole.
struct CheckReport {
  std::filesystem::path path;
  std::vector<Check> checks{};
  bool unreadable{false};  ///< the machine failed to read it, or to write what a check needs
  std::stop_token stop{};  ///< interrupts the checks
};

bool holds(const CheckReport& report);

/// Maximum number of problems that a check lists; it counts the others.
inline constexpr std::size_t max_problems = 20;

/// Adds a problem, or counts it if there are too many.
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

/// The message of a failure without the path of the file that it begins with.
std::string problem_of(const Failure& failure, const std::filesystem::path& path);

/// @throws Failure (interrupted) if a stop was requested.
void require_no_stop(const std::stop_token& stop);

/// Makes a check and adds it to the report. A Failure that `work(check, problems)` throws is a problem too.
/// @return the check holds
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

}  // namespace zerocount::verification
