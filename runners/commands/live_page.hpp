#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "analysis/report/page.hpp"
#include "core/failure/failure.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/status/status.hpp"

namespace zerocount::commands {

/// Checks that an HTML page may be written to this path, as command_line::require_replaceable() does. An
/// unfinished page (report::is_unfinished_page) is replaced without --force, because the same command is
/// resumed.
void require_page_place(const command_line::Arguments& arguments, const std::filesystem::path& page);

/// Path of the page of `option`, such as --report, after a check that it can be written; nothing without the
/// option.
/// @throws Failure as command_line::text_place and require_page_place; bad_input if it does not end in .html;
/// machine_failed if the program cannot draw
std::optional<std::filesystem::path> page_option(const command_line::Arguments& arguments,
                                                 const std::string& option);

/// Option `--watch`, the path of an HTML page that shows the progress of the command (LivePage).
command_line::OptionSpec watch_option();

/// Path of the page that the option --watch names, checked as page_option() does; nothing without the option.
/// Standard output is refused.
std::optional<std::filesystem::path> watched_page(const command_line::Arguments& arguments);

/// An HTML page that shows the progress of long work and the answer so far.
///
///     when the work tells its progress, in the thread of the work, because the file library has one thread
///     at a time:
///       show(so_far()), unless this took more than 2 % of a processor's time
///     at once, then every 2 s, in a thread of its own: write the page to PAGE.part, rename it to PAGE
///     finish(page): that is the page
///     fail(why): the page says why there is no answer, and shows the answer so far below
///
/// The browser reloads the page by itself, without a network and without a script, until it is finished or
/// failed. If the page cannot be written in between, the work goes on.
class LivePage {
 public:
  using Sections = std::function<std::vector<report::PageSection>()>;

  /// @param place path of the page; nothing: there is no page, and this object does nothing
  /// @param frame title, subtitle and kind of the page
  /// @param so_far called in the thread that calls listener(); a Failure of it is shown. Empty: only show()
  /// sets the answer
  /// @throws Failure (machine_failed) if the page cannot be written
  LivePage(std::optional<std::filesystem::path> place, report::ReportPage frame, Sections so_far);
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;

  /// Callback that the work must call with its progress, which the page then shows.
  status::Listener listener();

  /// Sets the sections that the page shows as the answer so far.
  void show(std::vector<report::PageSection> sections);

  /// Writes the final page, which is not reloaded any more.
  /// @param html HTML text of the page with the answer
  void finish(std::string_view html);

  /// Runs `work` and returns its result. If it throws, the page shows the failure, and the exception goes on.
  template <class Work>
  auto during(const Work& work) {
    try {
      return work();
    } catch (const Failure& failure) {
      fail(failure.what());
      throw;
    } catch (...) {
      fail("the program failed; the terminal says how");
      throw;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  void fail(std::string_view why);
  void show_until(const std::stop_token& stop);
  void call_so_far();
  void write(report::PageState state, std::string_view ended = {});

  std::optional<std::filesystem::path> place_;
  report::ReportPage frame_;
  Sections so_far_;
  Clock::time_point start_{Clock::now()};
  Clock::time_point next_call_{start_};
  /// Protects text_ and sections_, which the thread of the work and the writer's thread use.
  std::mutex mutex_;
  std::string text_;  ///< Progress of the work as text.
  /// Sections that the page shows as the answer so far, without figures.
  std::vector<report::PageSection> sections_;
  std::jthread writer_;  ///< Thread that writes the page. Last member, because it uses the others.
};

}  // namespace zerocount::commands
