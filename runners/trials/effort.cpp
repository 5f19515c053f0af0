#include "runners/trials/effort.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

namespace zerocount::trials {
namespace {

using Clock = std::chrono::steady_clock;

/// Largest time limit of an effort, s: about a century. The clock could not represent much longer times.
constexpr double longest = 3e9;

}  // namespace

struct Effort::Account {
  /// Account of the effort of which this one is a part. Its trials are counted too; null: there is none.
  std::shared_ptr<Account> whole;
  std::int64_t limit{std::numeric_limits<std::int64_t>::max()};
  std::int64_t spent{0};
  std::optional<Clock::time_point> end;
  std::stop_token stopped;  ///< Stop request from outside, or from the account of which this one is a part.
  std::stop_source over;    ///< Requests a stop when the time limit is over or `stopped` requests one.
  std::optional<std::stop_callback<std::function<void()>>> passes_on;
  /// Thread that requests a stop when the time is over. Last member, so that it ends before the others are
  /// destroyed.
  std::jthread timer;

  void start_timer() {
    passes_on.emplace(stopped, [this] { over.request_stop(); });
    timer = std::jthread([this](const std::stop_token& done) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any nothing;
      nothing.wait_until(lock, done, *end, [] { return false; });
      if (!done.stop_requested()) over.request_stop();
    });
  }
};

Effort::Effort(std::stop_token stop) : account_(std::make_shared<Account>()) {
  account_->stopped = std::move(stop);
}

Effort::Effort(std::shared_ptr<Account> account) : account_(std::move(account)) {}

Effort Effort::limited_to(std::optional<std::int64_t> trials, std::optional<double> seconds) const {
  auto account = std::make_shared<Account>();
  account->whole = account_;
  account->stopped = stop();
  if (trials) account->limit = *trials;
  if (seconds) {
    account->end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(std::clamp(*seconds, 0.0, longest)));
    account->start_timer();
  }
  return Effort(std::move(account));
}

Effort Effort::part(std::int64_t parts) const {
  const std::int64_t trials = trials_left();
  const double seconds = seconds_left();
  return limited_to(
      trials == std::numeric_limits<std::int64_t>::max() ? std::nullopt : std::optional(trials / parts),
      std::isinf(seconds) ? std::nullopt : std::optional(seconds / static_cast<double>(parts)));
}

std::int64_t Effort::trials_left() const {
  std::int64_t remaining = std::numeric_limits<std::int64_t>::max();
  for (const Account* one = account_.get(); one != nullptr; one = one->whole.get())
    remaining = std::min(remaining, one->limit - one->spent);
  return remaining;
}

double Effort::seconds_left() const {
  double remaining = std::numeric_limits<double>::infinity();
  for (const Account* one = account_.get(); one != nullptr; one = one->whole.get()) {
    if (one->end)
      remaining = std::min(remaining, std::chrono::duration<double>(*one->end - Clock::now()).count());
  }
  return remaining;
}

bool Effort::is_spent() const {
  return trials_left() <= 0 || seconds_left() <= 0.0 || stop().stop_requested();
}

bool Effort::is_interrupted() const {
  const Account* outermost = account_.get();
  while (outermost->whole) outermost = outermost->whole.get();
  return outermost->stopped.stop_requested();
}

std::int64_t Effort::spent_trials() const {
  return account_->spent;
}

void Effort::spend(std::int64_t trials) const {
  if (trials > trials_left()) throw Spent{};
  for (Account* one = account_.get(); one != nullptr; one = one->whole.get()) one->spent += trials;
}

std::stop_token Effort::stop() const {
  return account_->end ? account_->over.get_token() : account_->stopped;
}

}  // namespace zerocount::trials
