#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiments/study.hpp"
#include "results/layout/header.hpp"
#include "results/reading/study_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/assemble.hpp"
#include "runners/commands.hpp"
#include "runners/earlier_shards.hpp"
#include "runners/interruption.hpp"
#include "runners/output_place.hpp"
#include "runners/progress.hpp"
#include "runners/stopping_run.hpp"
#include "runners/study_runner.hpp"
#include "runners/warnings.hpp"

namespace zerocount {
namespace {

namespace fs = std::filesystem;

constexpr const char* run_help =
    "Runs the trials of the manifest on all cores, and writes them to the results file.\n"
    "Finished trials go to shards in FILE.shards/ while the run goes on; at the end they\n"
    "become FILE. A run that was interrupted or killed goes on where it stopped when the\n"
    "same command is given again. The data do not depend on the number of threads, on\n"
    "--shard, or on interruptions.\n"
    "\n"
    "Examples:\n"
    "  zerocount run experiments/manifests/paper-gains.yaml -o gains.h5\n"
    "  zerocount run study.yaml --set trials=100000 --set controller.ki=9.45e-5 -o out.h5\n"
    "  zerocount run study.yaml --shard 1/2 -o a.h5     on one machine, and on another\n"
    "  zerocount run study.yaml --shard 2/2 -o b.h5     then: zerocount merge a.h5 b.h5 -o all.h5\n";

/// The rows of part `text` = "I/N", I from 1 to N: parts differ by at most one trial in size.
RowRange part_of(const Arguments& arguments, const std::string& text, const Study& study) {
  std::int64_t part = 0;
  std::int64_t parts = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, part);
  const bool slash = first.ec == std::errc{} && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, parts) : first;
  const std::int64_t rows = trial_count(study);
  if (!slash || second.ec != std::errc{} || second.ptr != end || part < 1 || part > parts) {
    arguments.refuse(fmt::format("option '--shard': '{}' is not I/N with 1 ≤ I ≤ N, such as 2/8", text));
  }
  if (parts > rows) {
    arguments.refuse(
        fmt::format("option '--shard': the study has {} trials, which cannot make {} parts", rows, parts));
  }
  const auto start = [&](std::int64_t i) { return rows / parts * i + std::min(i, rows % parts); };
  return {start(part - 1), start(part) - start(part - 1)};
}

/// Whether `output` holds these rows already.
/// @throws Failure (bad_input) where it holds anything else: nothing is ever overwritten.
bool already_there(const fs::path& output, const Study& study, RowRange wanted) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(output, error))) return false;
  const auto refuse = [&](std::string_view what) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: {}; give another name with -o, or remove the file first", output.string(), what));
  };
  FileHeader header;
  try {
    header = StudyFile(output, Require::any_part).header();
  } catch (const Failure& failure) {
    refuse(fmt::format("exists, and is no usable results file ({})", failure.what()));
  }
  if (header.engine != study.engine) {
    refuse(fmt::format("holds the results of the {} engine, and this run is for the {} engine",
                       name_of(header.engine), name_of(study.engine)));
  }
  if (header.study_sha256 != study.study_sha256) {
    refuse("holds the results of another manifest (or of other --set values)");
  }
  if (!(header.rows == wanted)) {
    refuse(fmt::format("holds trials {} to {} of this study, and this run is for {} to {}", header.rows.first,
                       header.rows.end() - 1, wanted.first, wanted.end() - 1));
  }
  return true;
}

ExitCode run(const Arguments& arguments) {
  const fs::path output = output_place(arguments);
  Study study = load_study(arguments.operands()[0], arguments.values("set"));
  study.engine =
      arguments.one_of("engine", {"batch", "reference"}) == "batch" ? Engine::batch : Engine::reference;
  warn(study);
  const std::optional<std::string> part = arguments.value("shard");
  const RowRange wanted = part ? part_of(arguments, *part, study) : all_rows(study);
  const auto threads = static_cast<int>(arguments.whole_number("threads", 1, 4096).value_or(0));
  const bool quiet = arguments.has("quiet");

  if (study.stop && part) {
    arguments.refuse(
        "option '--shard': how many trials a study with `stop` takes can only be decided in one run");
  }

  const InterruptionWatch interruption;
  const OutputLock lock(output);
  if (study.stop) return run_until_sure(study, output, {threads, quiet}, interruption.token());
  const fs::path directory = shards_directory(output);
  if (already_there(output, study, wanted)) {
    // Left by a run that died at its very end; what is not of this study stays.
    remove_shards(directory, choose_shards(list_shards(directory, study).shards, wanted).all);
    if (!quiet) fmt::print(stderr, "{}: complete already, nothing to run\n", output.string());
    return ExitCode::success;
  }
  make_directory(directory);
  EarlierShards earlier = earlier_shards(directory, study, wanted);
  const std::vector<RowRange> missing = missing_ranges(earlier.usable, wanted);
  const std::int64_t kept = wanted.count - total_rows(missing);

  Progress progress(wanted.count, kept, samples_per_trial(study), quiet);
  std::int64_t done = kept;
  RunSettings settings;
  settings.threads = threads;
  settings.finished = [&](std::int64_t trials) { progress.update(done += trials); };
  const std::vector<ShardInfo> written =
      run_trials(study, missing, directory, settings, interruption.token());
  progress.finish(done);

  if (done < wanted.count) {
    throw Failure(
        ExitCode::interrupted,
        fmt::format("interrupted: {} of {} trials are kept in {}; give the same command again to go on", done,
                    wanted.count, directory.string()));
  }
  std::vector<ShardInfo> shards = std::move(earlier.usable);
  shards.insert(shards.end(), written.begin(), written.end());
  std::sort(shards.begin(), shards.end(),
            [](const ShardInfo& a, const ShardInfo& b) { return a.rows.first < b.rows.first; });
  assemble(shards, study, output, wanted);
  for (const ShardInfo& shard : written) earlier.all.push_back(shard.path);
  remove_shards(directory, earlier.all);
  if (!quiet) fmt::print(stderr, "wrote {}\n", output.string());
  return ExitCode::success;
}

}  // namespace

Command run_command() {
  return {{"run",
           "MANIFEST -o FILE",
           1,
           1,
           {{"output,o", "FILE", "the results file to make (required)"},
            {"threads", "N", "threads to use; default: all cores"},
            {"engine", "NAME",
             "batch (default): many trials at a time in vector lanes; reference: one after the other"},
            {"shard", "I/N", "run only the I-th of N parts, into a part file for 'zerocount merge'"},
            {"set", "KEY=VALUE",
             "override a manifest key, e.g. controller.ki=2e-5; may be repeated; recorded in the file", true},
            {"quiet,q", "", "say nothing of progress"}}},
          "run a study: manifest in, results file out",
          run_help,
          run};
}

}  // namespace zerocount
