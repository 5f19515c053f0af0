#include "runners/run_status/run_status.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/study_run/file_run.hpp"

namespace zerocount::run_status {
namespace {

namespace fs = std::filesystem;
using Time = fs::file_time_type;

/// Age below which a shard (file with finished trials) counts as new. A run writes a shard every 20 s or more
/// often.
constexpr std::chrono::seconds recently{60};

std::optional<Time> time_of(const fs::path& path) {
  std::error_code error;
  const Time time = fs::last_write_time(path, error);
  return error ? std::nullopt : std::optional(time);
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// A file with finished trials of a run: a shard, or a complete part of an array job.
struct Piece {
  fs::path path;
  layout::RowRange rows;
  Time written;
};

/// The files with finished trials of a run, as far as they could be read.
struct Pieces {
  std::vector<Piece> pieces;
  std::vector<std::string> problems;
  std::string name;
  std::int64_t trials{0};
  /// Whether a file vanished while the files were read, because it was joined to others.
  bool changed{false};
};

void read_piece(const fs::path& path, Pieces& found) {
  try {
    const layout::FileHeader header = shards::unchecked_header(path);
    const std::optional<Time> written = time_of(path);
    found.changed = found.changed || !written;
    if (!written) return;
    found.name = header.name;
    found.trials = header.trials * header.points;
    found.pieces.push_back({path, header.rows, *written});
  } catch (const Failure& failure) {
    if (time_of(path)) {
      found.problems.emplace_back(failure.what());
    } else {
      found.changed = true;
    }
  }
}

Pieces read_pieces(const fs::path& output) {
  constexpr int tries = 5;
  for (int i = 1;; ++i) {
    Pieces found;
    for (const fs::path& path : shards::finished_pieces(output)) read_piece(path, found);
    if (!found.changed || i == tries) return found;
  }
}

/// Number of trials that are in at least one of the files.
std::int64_t finished_trials(std::vector<Piece> pieces) {
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& one, const Piece& other) { return one.rows.first < other.rows.first; });
  std::int64_t trials = 0;
  std::int64_t end = 0;
  for (const Piece& piece : pieces) {
    trials += std::max<std::int64_t>(0, piece.rows.end() - std::max(piece.rows.first, end));
    end = std::max(end, piece.rows.end());
  }
  return trials;
}

fs::path lock_file(const fs::path& output) {
  fs::path path = output;
  return path += ".lock";
}

/// Speed of the process that writes `output`, trials/s: the trials of the shards written since it locked the
/// output, over the time up to the newest of these shards. NaN: unknown, because no shard was written.
double rate_of(const fs::path& output, const std::vector<Piece>& pieces) {
  const std::optional<Time> begin = time_of(lock_file(output));
  if (!begin) return std::nan("");
  std::int64_t trials = 0;
  Time end = *begin;
  for (const Piece& piece : pieces) {
    if (piece.written <= *begin || piece.path.parent_path() != layout::shards_directory(output)) continue;
    trials += piece.rows.count;
    end = std::max(end, piece.written);
  }
  const std::chrono::duration<double> time = end - *begin;
  return time.count() > 0.0 ? static_cast<double>(trials) / time.count() : std::nan("");
}

/// Adds the damaged files that a run has set aside in `directory` to RunStatus::problems.
void add_damaged(const fs::path& directory, RunStatus& status) {
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == study_run::damaged_extension)
      status.problems.push_back(fmt::format("{}: damaged; its trials are run again", entry->path().string()));
  }
}

/// Paths of the output files whose run wrote a shard within the last minute.
std::set<fs::path> written_lately(const std::vector<Piece>& pieces) {
  std::set<fs::path> outputs;
  for (const Piece& piece : pieces) {
    const fs::path folder = piece.path.parent_path();
    if (folder.extension() == ".shards" && Time::clock::now() - piece.written < recently)
      outputs.insert(fs::path(folder).replace_extension());
  }
  return outputs;
}

bool is_running(const fs::path& output, const std::set<fs::path>& lately) {
  const storage::LockState lock = storage::lock_state(output);
  return lock == storage::LockState::held || (lock == storage::LockState::unknown && lately.contains(output));
}

/// Adds the speed of one process to the speed of the whole job, trials/s. NaN (no shard written yet) is left
/// out.
/// @param rate speed of the process, trials/s; NaN: unknown
void add_rate(double rate, RunStatus& status) {
  if (!std::isnan(rate)) status.rate = std::isnan(status.rate) ? rate : status.rate + rate;
}

PartCounts count_parts(const fs::path& output, const Pieces& found, RunStatus& status) {
  std::map<std::int64_t, fs::path> complete, begun;
  PartCounts counts;
  for (const shards::Part& part : shards::begun_parts(output)) {
    counts.all = part.count;
    begun.emplace(part.number, part.path);
    add_damaged(layout::shards_directory(part.path), status);
  }
  for (const Piece& piece : found.pieces) {
    const std::optional<shards::Part> part = shards::part_named(piece.path);
    if (part) complete.emplace(part->number, part->path);
  }
  const std::set<fs::path> lately = written_lately(found.pieces);
  for (const auto& [number, path] : begun) {
    if (complete.contains(number)) continue;
    const bool running = is_running(path, lately);
    (running ? counts.running : counts.interrupted) += 1;
    if (running) add_rate(rate_of(path, found.pieces), status);
  }
  counts.complete = std::ssize(complete);
  return counts;
}

/// Whether the results file was made from the parts of the array job: all parts are complete, and none is
/// newer than the file.
bool is_merged(const fs::path& output, const RunStatus& status, const std::vector<Piece>& pieces) {
  const std::optional<Time> merged = time_of(output);
  if (!merged || !status.parts || status.parts->complete != status.parts->all || status.shards > 0)
    return false;
  return std::all_of(pieces.begin(), pieces.end(),
                     [&](const Piece& piece) { return piece.written <= *merged; });
}

RunStatus status_of_file(const fs::path& output) {
  if (!time_of(output)) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: neither this file nor a run of it exists: neither {} nor {}", output.string(),
                    layout::shards_directory(output).string(), shards::parts_directory(output).string()));
  }
  const layout::FileHeader header = layout::read_header(layout::open_results(output));
  if (!header.complete || !header.finished) {
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: a part with {} of {} trials; merge it with the other parts",
                              output.string(), header.rows.count, header.trials * header.points));
  }
  RunStatus status;
  status.complete = true;
  status.name = header.name;
  status.trials = status.finished = header.rows.count;
  return status;
}

/// State of a results file that was merged from the parts of an array job, or was extended with more trials
/// since.
RunStatus status_of_merged(const fs::path& output, const RunStatus& of_parts) {
  RunStatus status = status_of_file(output);
  status.problems = of_parts.problems;
  if (status.trials == of_parts.trials) status.parts = of_parts.parts;
  return status;
}

RunStatus read_status(const fs::path& output) {
  if (!shards::has_begun(output)) return status_of_file(output);
  const Pieces found = read_pieces(output);
  const bool running = is_running(output, written_lately(found.pieces));
  const bool has_nothing = found.pieces.empty() && found.problems.empty();
  if (has_nothing && !running) return status_of_file(output);
  RunStatus status;
  status.running = running;
  status.name = found.name;
  status.trials = found.trials;
  status.problems = found.problems;
  status.finished = finished_trials(found.pieces);
  if (running) add_rate(rate_of(output, found.pieces), status);
  status.shards = std::count_if(found.pieces.begin(), found.pieces.end(),
                                [](const Piece& piece) { return !shards::part_named(piece.path); });
  add_damaged(layout::shards_directory(output), status);
  if (is_folder(shards::parts_directory(output))) {
    const PartCounts parts = count_parts(output, found, status);
    status.running = status.running || parts.running > 0;
    if (parts.all > 1) status.parts = parts;
    if (is_merged(output, status, found.pieces)) return status_of_merged(output, status);
  }
  const bool may_be_queued = status.parts && status.parts->waiting() > 0;
  status.stopped =
      !status.running && !may_be_queued && storage::lock_state(output) != storage::LockState::unknown;
  return status;
}

}  // namespace

RunStatus status_of(const fs::path& output) {
  RunStatus status = read_status(output);
  if (status.stopped) status = read_status(output);  // it may have ended while its files were read
  return status;
}

}  // namespace zerocount::run_status
