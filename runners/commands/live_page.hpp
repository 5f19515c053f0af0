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

/// Checks the place of a page, as command_line::require_replaceable. A page that is unfinished
/// (report::is_unfinished_page) is replaced without --force, because the same command goes on.
void require_page_place(const command_line::Arguments& arguments, const std::filesystem::path& page);

/// The page of `option`, such as --report, once it can be written; nothing without the option.
/// @throws Failure as command_line::text_place and require_page_place; bad_input if it does not end in .html;
/// machine_failed if the program cannot draw
std::optional<std::filesystem::path> page_option(const command_line::Arguments& arguments,
                                                 const std::string& option);

/// `--watch`, the place of a LivePage.
command_line::OptionSpec watch_option();

/// Likewise of watch_option(), which is not standard output.
std::optional<std::filesystem::path> watched_page(const command_line::Arguments& arguments);

/// A page that shows long work while it is done: how far it is, and the answer so far.
///
///     when the work tells how far it is, in its thread, because the library of its files has one at a time:
///       show(so_far()), unless that took more than 2 % of a processor's time
///     at once, then every 2 s, in a thread of its own: write the page to PAGE.part, rename it to PAGE
///     finish(page): that is the page
///     fail(why): the page says why there is no answer, below it the answer so far
///
/// The browser loads the page again by itself, without a network and without a script, until it is finished
/// or failed. Where it cannot be written in between, the work goes on.
class LivePage {
 public:
  using Sections = std::function<std::vector<report::PageSection>()>;

  /// @param place nothing: there is no page, and nothing is done
  /// @param frame title, subtitle and kind of the page
  /// @param so_far called in the thread that calls listener(); its Failure is shown; empty: only show() tells
  /// the answer
  /// @throws Failure (machine_failed) if the page cannot be written
  LivePage(std::optional<std::filesystem::path> place, report::ReportPage frame, Sections so_far);
  LivePage(const LivePage&) = delete;
  LivePage& operator=(const LivePage&) = delete;

  /// Takes how far the work is.
  status::Listener listener();

  /// The answer so far.
  void show(std::vector<report::PageSection> sections);

  /// @param html the page of the answer
  void finish(std::string_view html);

  /// Does the work. Where it throws, the page says what.
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
  std::mutex mutex_;                           ///< of the two members below
  std::string text_;                           ///< how far the work is
  std::vector<report::PageSection> sections_;  ///< the answer so far, without figures
  std::jthread writer_;                        ///< the last member: it uses the others
};

}  // namespace zerocount::commands
