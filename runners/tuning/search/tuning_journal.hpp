#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runners/tuning/race/candidate.hpp"

namespace zerocount::tuning {

/// The file in which a tuning keeps its evaluations until it ends: FILE.tuning.
std::filesystem::path journal_path(const std::filesystem::path& output);

/// What an interrupted tuning has kept: the journal, if there is one yet.
std::string interruption_text(const std::filesystem::path& output);

/// The evaluations of an unfinished tuning, so that it goes on where it was interrupted: a line of JSON that
/// names the tuning, then one for each evaluation. The search is run anew, and finds its results here.
class TuningJournal {
 public:
  /// Reads the evaluations of an earlier run, if there is one. The first evaluation begins a new file.
  /// @param path empty: nothing is kept
  /// @param tuning hash of all that decides the results
  /// @param replace a journal of another tuning instead of refusing it
  /// @throws Failure: bad_input for a journal of another tuning, machine_failed
  TuningJournal(std::filesystem::path path, const std::string& tuning, bool replace);

  bool resumed() const { return resumed_; }
  double seconds() const { return seconds_; }  ///< that the earlier runs took
  /// Seconds that the tuning took so far, those of the earlier runs included.
  double elapsed() const {
    return seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Trials per second that an earlier run measured, so that the search has the same size again.
  std::optional<double> speed() const { return speed_; }
  /// @throws Failure (machine_failed)
  void keep_speed(double speed);

  /// Moves units [from, to) behind `units`, as far as they are known.
  void take(const std::string& search, const Values& values, std::int64_t from, std::int64_t to,
            std::vector<UnitResult>& units);

  /// Writes evaluations, each a line of evaluation_line().
  /// @throws Failure (machine_failed)
  void add(std::span<const std::string> evaluations);

  /// Removes the file.
  void remove();

 private:
  void read_line(const std::string& line);
  void append(std::span<const std::string> lines);

  std::filesystem::path path_;
  std::string header_;
  bool resumed_{false};
  bool begun_{false};  ///< this run has written the header
  bool torn_{false};   ///< the file may end within a line
  double seconds_{0.0};
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
  std::optional<double> speed_;
  std::map<std::pair<std::string, Values>, std::vector<UnitResult>> known_;
};

/// Units [from, …) of a candidate, as a journal keeps them.
/// @param search hash of the searched study @param seconds that the tuning took so far
std::string evaluation_line(const std::string& search, const Values& values, std::int64_t from,
                            std::span<const UnitResult> units, double seconds);

}  // namespace zerocount::tuning
