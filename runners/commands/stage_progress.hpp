#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "runners/status/status.hpp"

namespace zerocount::commands {

/// Prints the current stage of a long computation to stderr, with the time since its start. A computation
/// that ends soon prints nothing.
class StageProgress {
 public:
  /// @param command text that begins each message: "zerocount identify"
  /// @param quiet whether to print nothing
  StageProgress(std::string command, bool quiet);
  /// Ends the messages, and removes the last line from a terminal.
  ~StageProgress();
  StageProgress(const StageProgress&) = delete;
  StageProgress& operator=(const StageProgress&) = delete;
  StageProgress(StageProgress&&) = delete;
  StageProgress& operator=(StageProgress&&) = delete;

  void enter(std::string_view stage);

 private:
  void print_until_end();

  std::string command_;
  status::StatusLine line_;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;  // of the members below
  std::condition_variable change_;
  std::string stage_;
  bool ended_{false};
  std::thread printer_;
};

/// Runs `work` while the name of its stage and the time are printed to stderr (StageProgress). Returns the
/// result of `work`.
template <class Work>
auto with_progress(std::string command, std::string_view stage, const Work& work) {
  StageProgress progress(std::move(command), /*quiet=*/false);
  progress.enter(stage);
  return work();
}

}  // namespace zerocount::commands
