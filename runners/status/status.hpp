#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

/// Messages on standard error while the program works. A message that cannot be written stops nothing.
namespace zerocount::status {

/// Writes `text` as it is.
void write(std::string_view text);

/// Writes sentences for people, as terminal::fitted_to.
void write_fitted(std::string_view text);

/// Writes a formatted text likewise.
template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_fitted(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Gets the text of a StatusLine each time that it changes, beside the terminal, or without one.
using Listener = std::function<void(std::string text)>;

/// How far a long command is: on a terminal one line that is updated in place and fits it; otherwise a new
/// line after 5 s, and then after twice as long each time, up to an hour, so that logs stay short. Commands
/// that end sooner show nothing. A quiet one shows nothing either; both tell the listener.
class StatusLine {
 public:
  explicit StatusLine(bool quiet = false, Listener listener = {});
  /// Removes the line from a terminal.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// Shows the text, without a line break, if the last one has stood long enough.
  void show(const std::function<std::string()>& text);
  /// Shows the final text, whenever the last one was shown.
  void finish(std::string_view text);
  /// Removes the line from a terminal, for what is printed next.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  Listener listener_;
  bool terminal_;             ///< the line is updated in place
  Clock::duration interval_;  ///< between two texts
  bool shown_{false};         ///< the cursor is behind a text on the terminal
  Clock::time_point last_;
};

}  // namespace zerocount::status
