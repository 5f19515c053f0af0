#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

/// Messages on standard error while the program works. If a message cannot be written, the program goes on.
namespace zerocount::status {

/// Writes `text` unchanged.
void write(std::string_view text);

/// Writes sentences for people, fitted by terminal::fitted_to().
void write_fitted(std::string_view text);

/// Formats a text and writes it with write_fitted().
template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_fitted(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Callback that receives the text of a StatusLine whenever it changes, whether or not there is a terminal.
using Listener = std::function<void(std::string text)>;

/// Progress of a long command. On a terminal it is one line, fitted to the width and updated in place.
/// Otherwise it is a new line after 5 s, and then after twice as long each time, up to an hour, so that logs
/// stay short. Commands that end sooner show nothing, and neither does a quiet line. The listener is called
/// in all cases.
class StatusLine {
 public:
  explicit StatusLine(bool quiet = false, Listener listener = {});
  /// Removes the line from a terminal.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Shows the text, without a line break, if the last text has been shown long enough.
  void show(const std::function<std::string()>& text);
  /// Shows the final text, no matter when the last text was shown.
  void finish(std::string_view text);
  /// Removes the line from a terminal, so that other output can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  Listener listener_;
  bool terminal_;             ///< Whether the line is updated in place on a terminal.
  Clock::duration interval_;  ///< Time between two texts.
  bool shown_{false};         ///< Whether a text is shown on the terminal, with the cursor after it.
  Clock::time_point last_;
};

}  // namespace zerocount::status
