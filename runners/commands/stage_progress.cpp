#include "runners/commands/stage_progress.hpp"

#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "runners/study_run/progress.hpp"

namespace zerocount::commands {
namespace {

constexpr std::chrono::milliseconds stage_interval_on_terminal{500};
constexpr std::chrono::milliseconds stage_interval_in_log{5000};

}  // namespace

StageProgress::StageProgress(std::string verb, bool quiet)
    : verb_(std::move(verb)),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {
  if (!quiet) printer_ = std::thread([this] { print_until_end(); });
}

StageProgress::~StageProgress() {
  if (!printer_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
  }
  change_.notify_one();
  printer_.join();
}

void StageProgress::enter(std::string_view stage) {
  const std::scoped_lock lock(mutex_);
  stage_ = stage;
}

void StageProgress::print_until_end() {
  const auto interval = terminal_ ? stage_interval_on_terminal : stage_interval_in_log;
  bool printed = false;
  std::unique_lock lock(mutex_);
  while (!change_.wait_for(lock, interval, [this] { return ended_; })) {
    if (stage_.empty()) continue;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const std::string text =
        fmt::format("{}: {}, {}", verb_, stage_, study_run::duration_text(elapsed.count()));
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r\x1b[K" : "", text, terminal_ ? "" : "\n");
    std::fflush(stderr);
    printed = true;
  }
  if (printed && terminal_) fmt::print(stderr, "\r\x1b[K");
}

}  // namespace zerocount::commands
