#include "runners/commands/stage_progress.hpp"

#include <utility>

#include <fmt/format.h>

#include "runners/status/progress.hpp"

namespace zerocount::commands {
namespace {

constexpr std::chrono::milliseconds stage_interval{100};  // the line decides when it changes

}  // namespace

StageProgress::StageProgress(std::string command, bool quiet)
    : command_(std::move(command)), line_(quiet), start_(std::chrono::steady_clock::now()) {
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
  std::unique_lock lock(mutex_);
  while (!change_.wait_for(lock, stage_interval, [this] { return ended_; })) {
    if (stage_.empty()) continue;
    line_.show([this] {
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
      return fmt::format("{}: {}, {}", command_, stage_, status::duration_text(elapsed.count()));
    });
  }
}

}  // namespace zerocount::commands
