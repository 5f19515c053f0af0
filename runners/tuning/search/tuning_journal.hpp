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

/// Path of the journal, the file in which a tuning keeps the results of simulated candidates until it ends:
/// FILE.tuning.
std::filesystem::path journal_path(const std::filesystem::path& output);

/// Message of an interrupted tuning. It says whether a journal with its results exists, and how to continue.
std::string interruption_text(const std::filesystem::path& output);

/// File with the results of the candidates that an unfinished tuning has simulated, so that it can resume
/// after an interruption. The file has a line of JSON that identifies the tuning, then a line for each
/// evaluation. A resumed search is run anew, and takes the results of known evaluations from here.
class TuningJournal {
 public:
  /// Reads the evaluations of an earlier run, if there is one. Otherwise the first evaluation creates the
  /// file.
  /// @param path path of the journal; empty: nothing is kept
  /// @param tuning hash of everything that determines the results
  /// @param replace whether to replace a journal of another tuning instead of refusing it
  /// @throws Failure: bad_input for a journal of another tuning, machine_failed
  TuningJournal(std::filesystem::path path, const std::string& tuning, bool replace);

  /// Whether the file had results of an earlier run of this tuning, from which this run resumes.
  bool resumed() const { return resumed_; }
  /// Time that the earlier, interrupted runs of the tuning took, s.
  double seconds() const { return seconds_; }
  /// Time that the tuning took so far, including earlier runs, s.
  double elapsed() const {
    return seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Speed of simulation that an earlier run measured, trials/s; nothing if none did. With it, the resumed
  /// search has the same size.
  std::optional<double> speed() const { return speed_; }
  /// Writes the measured speed of simulation to the file, unless an earlier run did.
  /// @param speed trials/s
  /// @throws Failure (machine_failed) if the file cannot be written
  void keep_speed(double speed);

  /// Appends to `machines` the known results of a candidate on the machines [from, to). They are moved out of
  /// the journal, so each is given only once.
  /// @param search hash of the searched study
  /// @param values values of the candidate
  void take(const std::string& search, const Values& values, std::int64_t from, std::int64_t to,
            std::vector<MachineResult>& machines);

  /// Writes the results of simulated candidates to the file.
  /// @param evaluations lines of evaluation_line()
  /// @throws Failure (machine_failed) if the file cannot be written
  void add(std::span<const std::string> evaluations);

  /// Removes the file of the journal.
  void remove();

 private:
  void read_line(const std::string& line);
  void append(std::span<const std::string> lines);

  std::filesystem::path path_;
  std::string header_;
  bool resumed_{false};
  bool begun_{false};  ///< Whether this run has written the first line, which identifies the tuning.
  bool torn_{false};   ///< Whether the file may end within a line, because an earlier run was killed.
  double seconds_{0.0};
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
  std::optional<double> speed_;
  std::map<std::pair<std::string, Values>, std::vector<MachineResult>> known_;
};

/// Line of a tuning's journal with the results of a candidate's machines [from, from + machines.size()).
/// @param search hash of the searched study
/// @param values values of the candidate
/// @param seconds time that the tuning took so far, s
std::string evaluation_line(const std::string& search, const Values& values, std::int64_t from,
                            std::span<const MachineResult> machines, double seconds);

}  // namespace zerocount::tuning
