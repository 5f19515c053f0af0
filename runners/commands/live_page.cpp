#include "runners/commands/live_page.hpp"

#include <ctime>
#include <exception>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "analysis/basis/document/answer.hpp"
#include "analysis/basis/document/blocks.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/status/progress.hpp"

namespace zerocount::commands {
namespace {

namespace fs = std::filesystem;

constexpr double part_of_so_far = 0.02;  // of the time of a processor

/// Processor time that the calling thread has used, s.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Moment {
  std::string text;   ///< Progress of the work as text.
  std::string ended;  ///< Reason why there is no answer, if the work failed; empty while the work runs.
  double seconds;     ///< Time since the start of the work that the page shows, s.
};
using At = const Moment&;

document::AnswerDescription<Moment> moment_answer() {
  document::AnswerDescription<Moment> answer{{.name = "progress", .meaning = "how far long work is"}, {}};
  answer.items
      .headline([](At at) {
        if (!at.ended.empty()) return at.ended;
        return at.text.empty() ? std::string("begun") : at.text;
      })
      .sentence([](At at) { return at.ended.empty() ? "" : at.text; })
      .value({.heading = "written"},
             [](At at) {
               return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC, {} after the start",
                                  fmt::gmtime(std::time(nullptr)), status::duration_text(at.seconds));
             })
      .sentence([](At at) {
        return at.ended.empty()
                   ? fmt::format(
                         "This page loads itself again every {} s. Where that time stands still, the "
                         "program was killed.",
                         report::live_interval)
                   : std::string("This page is not loaded again.");
      });
  return answer;
}

}  // namespace

void require_page_place(const command_line::Arguments& arguments, const fs::path& page) {
  if (yaml::is_standard_stream(page)) return;
  if (report::is_unfinished_page(page)) return storage::require_replaceable(page);
  command_line::require_replaceable(arguments, page);
}

std::optional<fs::path> page_option(const command_line::Arguments& arguments, const std::string& option) {
  std::optional<fs::path> page = command_line::text_place(arguments, option);
  if (!page) return page;
  if (drawing_kind(arguments, option, *page) != DrawingKind::page)
    arguments.refuse(fmt::format("option '--{}': '{}' does not end in .html", option, page->string()));
  require_page_place(arguments, *page);
  report::require_drawing_libraries();
  return page;
}

command_line::OptionSpec watch_option() {
  return command_line::page_file(
      {"watch", "PAGE",
       "a page (*.html) for a browser that shows the work while it is done, and at the end its answer"});
}

std::optional<fs::path> watched_page(const command_line::Arguments& arguments) {
  if (const auto page = arguments.value("watch"); page && yaml::is_standard_stream(*page))
    arguments.refuse(
        "option '--watch': a page that is written again cannot go to standard output; name a file");
  return page_option(arguments, "watch");
}

LivePage::LivePage(std::optional<fs::path> place, report::ReportPage frame, Sections so_far)
    : place_(std::move(place)), frame_(std::move(frame)), so_far_(std::move(so_far)) {
  if (!place_) return;
  write(report::PageState::live);
  writer_ = std::jthread([this](const std::stop_token& stop) { show_until(stop); });
}

status::Listener LivePage::listener() {
  if (!place_) return {};
  return [this](std::string text) {
    {
      const std::scoped_lock lock(mutex_);
      text_ = std::move(text);
    }
    call_so_far();
  };
}

void LivePage::show(std::vector<report::PageSection> sections) {
  // Figures would be drawn anew each time.
  for (report::PageSection& section : sections) section.figures.clear();
  const std::scoped_lock lock(mutex_);
  sections_ = std::move(sections);
}

void LivePage::finish(std::string_view html) {
  writer_ = {};
  if (place_) storage::replace_file(*place_, html);
}

void LivePage::fail(std::string_view why) {
  writer_ = {};
  if (!place_) return;
  try {
    write(report::PageState::unfinished, why);
  } catch (const Failure& failure) {
    status::tell("zerocount: warning: {}\n", failure.what());
  }
}

void LivePage::show_until(const std::stop_token& stop) {
  std::mutex waiting;
  std::condition_variable_any never;
  std::unique_lock lock(waiting);
  bool told = false;
  while (true) {
    never.wait_for(lock, stop, std::chrono::seconds(report::live_interval), [] { return false; });
    if (stop.stop_requested()) return;
    try {
      write(report::PageState::live);
    } catch (const std::exception& error) {
      const auto* const failure = dynamic_cast<const Failure*>(&error);
      if (!std::exchange(told, true))
        status::tell("zerocount: warning: {}; the work goes on\n",
                     failure != nullptr ? failure->what() : "the page of --watch cannot be written");
    }
  }
}

void LivePage::call_so_far() {
  if (!so_far_ || Clock::now() < next_call_) return;
  const double before = processor_seconds();
  try {
    show(so_far_());
  } catch (const Failure& failure) {
    show({{"so-far", "The answer so far", fmt::format("<p>{}</p>\n", document::markup(failure.what())), {}}});
  }
  const std::chrono::duration<double> pause((processor_seconds() - before) / part_of_so_far);
  next_call_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(pause);
}

void LivePage::write(report::PageState state, std::string_view ended) {
  report::ReportPage page = frame_;
  page.state = state;
  Moment moment{{}, std::string(ended), std::chrono::duration<double>(Clock::now() - start_).count()};
  {
    const std::scoped_lock lock(mutex_);
    moment.text = text_;
    page.sections = sections_;
  }
  page.sections.insert(page.sections.begin(),
                       report::answer_section("progress", "Progress", moment_answer().of(moment)));
  storage::replace_file(*place_, report::html_page(page));
}

}  // namespace zerocount::commands
