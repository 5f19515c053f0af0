#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <stop_token>

#include "core/trial/trial.hpp"

namespace zerocount::trials {

/// The effort is not enough for what is to be run.
struct Spent : std::exception {
  const char* what() const noexcept override { return "the effort is spent"; }
};

/// What a task may spend on all that it runs: trials and time. Spending is counted here and nowhere else.
///
/// A handle: copies spend of the same effort. One thread at a time spends.
class Effort {
 public:
  /// Without limits. @param stop a request to stop
  Effort(
      std::stop_token stop = {});  // NOLINT(google-explicit-constructor): a task that is only to be stopped

  /// A part of this effort. What it spends is spent of the whole, and what it leaves stays with the whole.
  /// @param trials limit; of the whole's without a value @param seconds from now on; likewise
  Effort share(std::optional<std::int64_t> trials, std::optional<double> seconds) const;

  /// One of so many equal parts of what is left.
  Effort part(std::int64_t parts) const;

  std::int64_t trials_left() const;  ///< the largest number without a limit
  double seconds_left() const;       ///< infinite without a limit; may be negative
  bool is_spent() const;             ///< no trial or no time is left, or a stop was requested
  bool is_interrupted() const;       ///< a stop was requested, from outside
  std::int64_t spent_trials() const;

  /// Counts trials before they are run.
  /// @throws Spent if fewer are left; then it counts nothing
  void spend(std::int64_t trials) const;

  /// Stops what runs when the time is over, or a stop is requested.
  std::stop_token stop() const;

 private:
  struct Account;
  explicit Effort(std::shared_ptr<Account> account);

  std::shared_ptr<Account> account_;
};

/// Whether `work` ended within the effort.
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
