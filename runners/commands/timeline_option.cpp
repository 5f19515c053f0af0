#include "runners/commands/timeline_option.hpp"

#include "analysis/basis/parallel/parallel.hpp"
#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"
#include "results/timeline/timeline.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/status/status.hpp"

namespace zerocount::commands {

namespace fs = std::filesystem;

command_line::OptionSpec timeline_option() {
  return command_line::renewed_file(
      {"timeline", "FILE",
       "write which thread did what, and when, for Perfetto or chrome://tracing (Trace Event Format)"});
}

std::optional<fs::path> timeline_place(const command_line::Arguments& arguments) {
  std::optional<fs::path> place = command_line::text_place(arguments, "timeline");
  if (!place || yaml::is_standard_stream(*place)) return place;
  if (timeline::is_timeline(storage::bytes_at(*place, 0, 64))) {
    storage::require_replaceable(*place);
  } else {
    command_line::require_replaceable(arguments, *place);
  }
  return place;
}

void with_timeline(const std::optional<fs::path>& place,
                   const std::function<void(timeline::Timeline* timeline)>& work) {
  if (!place) return work(nullptr);
  timeline::Timeline timeline;
  try {
    work(&timeline);
  } catch (...) {
    try {
      command_line::write_text(*place, timeline.trace_events());
    } catch (const Failure& failure) {  // what the work failed of is to be told, too
      status::tell("{}\n", failure.what());
    }
    throw;
  }
  command_line::write_text(*place, timeline.trace_events());
}

ExitCode recorded(const std::optional<fs::path>& place, std::string_view name,
                  const std::function<ExitCode()>& work) {
  ExitCode code = ExitCode::success;
  with_timeline(place, [&](timeline::Timeline* timeline) {
    const parallel::Recording recording(timeline, name);
    code = work();
  });
  return code;
}

}  // namespace zerocount::commands
