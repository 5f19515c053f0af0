#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <stop_token>

#include "core/trial/trial.hpp"

namespace zerocount::trials {

/// Exception: fewer trials are left in an Effort than are to be run.
struct Spent : std::exception {
  const char* what() const noexcept override { return "the effort is spent"; }
};

/// Budget of trials and time that a task may spend on all its runs. Spending is counted here and nowhere
/// else.
///
/// An effort is a handle: copies spend from the same account. Only one thread at a time may spend.
class Effort {
 public:
  /// Makes an effort without limits of trials or time.
  /// @param stop request from outside to stop
  Effort(
      std::stop_token stop = {});  // NOLINT(google-explicit-constructor): a task that is only to be stopped

  /// A part of this effort with limits of its own. Trials that the part spends are also spent from this
  /// effort. Trials that the part does not spend remain in this effort.
  /// @param trials maximum number of trials; nothing: only the limit of this effort holds
  /// @param seconds time limit from now on, s; nothing: only the limit of this effort holds
  Effort limited_to(std::optional<std::int64_t> trials, std::optional<double> seconds) const;

  /// A part of this effort that may spend at most the remaining trials and time divided by `parts`.
  Effort part(std::int64_t parts) const;

  /// Number of trials that may still be spent; without a limit the largest std::int64_t.
  std::int64_t trials_left() const;
  /// Time that may still be spent, s; infinite without a limit; negative if it is over.
  double seconds_left() const;
  bool is_spent() const;  ///< Whether no trial or no time is left, or a stop was requested.
  /// Whether a stop was requested from outside. False if only the time is over.
  bool is_interrupted() const;
  std::int64_t spent_trials() const;  ///< Number of trials spent by this effort and by its parts.

  /// Counts trials as spent. Called before they are run.
  /// @throws Spent if fewer are left; then nothing is counted
  void spend(std::int64_t trials) const;

  /// Token that requests a stop when the time is over or a stop is requested from outside.
  std::stop_token stop() const;

 private:
  struct Account;
  explicit Effort(std::shared_ptr<Account> account);

  std::shared_ptr<Account> account_;
};

/// Runs `work`, which spends the effort. Returns true if `work` ended, and false if the effort was not
/// enough: `work` threw Spent, or was interrupted because the time was over.
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
