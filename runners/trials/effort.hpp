#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <stop_token>

#include "core/trial/trial.hpp"

namespace zerocount::trials {

/// Exception: the effort is not enough for the trials that are to run.
struct Spent : std::exception {
  const char* what() const noexcept override { return "the effort is spent"; }
};

/// Trials and time that a task may spend on all its runs. Spending is counted here and nowhere else.
///
/// An effort is a handle: copies spend from the same account. Only one thread at a time may spend.
class Effort {
 public:
  /// Effort without limits.
  /// @param stop request to stop
  Effort(
      std::stop_token stop = {});  // NOLINT(google-explicit-constructor): a task that is only to be stopped

  /// A part of this effort. Trials spent by the part are also spent by the whole, and what the part leaves
  /// remains with the whole.
  /// @param trials maximum number of trials; without a value, only the limit of the whole holds
  /// @param seconds time limit from now on, s; without a value, only the limit of the whole holds
  Effort limited_to(std::optional<std::int64_t> trials, std::optional<double> seconds) const;

  /// One of `parts` equal parts of the remaining effort.
  Effort part(std::int64_t parts) const;

  /// Number of remaining trials; without a limit the largest std::int64_t.
  std::int64_t trials_left() const;
  double seconds_left() const;        ///< Remaining time, s; infinite without a limit; may be negative.
  bool is_spent() const;              ///< Whether no trial or no time is left, or a stop was requested.
  bool is_interrupted() const;        ///< Whether a stop was requested from outside.
  std::int64_t spent_trials() const;  ///< Number of trials spent by this effort and by its parts.

  /// Counts trials before they are run.
  /// @throws Spent if fewer are left; then nothing is counted
  void spend(std::int64_t trials) const;

  /// Token that requests a stop when the time is over or a stop is requested from outside.
  std::stop_token stop() const;

 private:
  struct Account;
  explicit Effort(std::shared_ptr<Account> account);

  std::shared_ptr<Account> account_;
};

/// Runs `work`, which spends the effort. Returns false if `work` threw Spent, or was interrupted because the
/// time was over; otherwise true.
/// @throws trial::Interrupted if a stop was requested from outside
template <class Work>
bool within(const Effort& effort, const Work& work) {
  try {
    work();
    return true;
  } catch (const Spent&) {
    return false;
  } catch (const trial::Interrupted&) {
    if (effort.is_interrupted()) throw;
    return false;
  }
}

}  // namespace zerocount::trials
