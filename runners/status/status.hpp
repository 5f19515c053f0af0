#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

/// Messages on standard error while the program works. If a message cannot be written, the program goes on.
namespace zerocount::status {

/// Writes `text` unchanged to standard error.
void write(std::string_view text);

/// Writes sentences for people to standard error, fitted to the width of a terminal (terminal::fitted_to()).
void write_fitted(std::string_view text);

/// Formats a text and writes it to standard error with write_fitted().
template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_fitted(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Callback that receives the text of a status line (progress of a command) whenever it changes, whether or
/// not there is a terminal.
using Listener = std::function<void(std::string text)>;

/// Progress of a long command. On a terminal it is one line, fitted to the width and updated in place.
/// Otherwise it is a new line after 5 s, and then after twice as long each time, up to an hour, so that logs
/// stay short. Commands that end sooner show nothing, and neither does a quiet line. The listener is called
/// in all cases.
class StatusLine {
 public:
  explicit StatusLine(bool quiet = false, Listener listener = {});
  /// Removes the status line from a terminal.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Shows a new text on the status line, if the last text has been shown long enough. The listener gets
  /// every text.
  /// @param text returns the text, without a line break; called only if the text is needed
  void show(const std::function<std::string()>& text);
  /// Shows the final text on the status line, no matter when the last text was shown.
  void finish(std::string_view text);
  /// Removes the status line from a terminal, so that other output can follow.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  Listener listener_;
  bool terminal_;             ///< Whether the line is updated in place, because standard error is a terminal.
  Clock::duration interval_;  ///< Minimum time between two texts of the status line.
  bool shown_{false};  ///< Whether a text stands on the terminal at the moment, with the cursor after it.
  Clock::time_point last_;
};

}  // namespace zerocount::status
