#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "core/text/shell_word.hpp"
#include "experiments/study/study.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/layout/header.hpp"
#include "results/shards/pieces.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/cluster/array_job.hpp"
#include "runners/cluster/batch_scripts.hpp"
#include "runners/cluster/earlier_parts.hpp"
#include "runners/cluster/slurm.hpp"
#include "runners/cluster/submission.hpp"
#include "runners/command_line/output_place.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/study_run/earlier_shards.hpp"

namespace zerocount::study_commands {
namespace {

namespace fs = std::filesystem;

constexpr const char* slurm_help =
    "Writes the scripts of an array job and of a job that merges its results to FILE.parts/, and submits\n"
    "them with sbatch. The trials of the study are divided into N parts; each is run by an element of the\n"
    "array, on all the processors that the element has. Where N is larger than Slurm's MaxArraySize, an\n"
    "element runs several parts. The merge begins when all elements have ended; where some failed, it\n"
    "says which trials are missing.\n"
    "\n"
    "The same command again submits what is missing: parts that are complete are not run again, and parts\n"
    "that were interrupted go on from their last shard. It is refused while jobs of this output are in the\n"
    "queue, and where the manifest, its overrides or the program have changed. The jobs, too, refuse a\n"
    "manifest that has changed since.\n"
    "\n"
    "A study with `stop` cannot be divided, because the number of its trials is decided while it runs:\n"
    "with --tasks 1 it is run by one job.\n"
    "\n"
    "Examples:\n"
    "  zerocount slurm study.yaml -o study.h5 --tasks 64 --cpus 16 --time 2:00:00\n"
    "  zerocount slurm study.yaml -o study.h5 --tasks 64 --sbatch=--partition=long --dry-run\n"
    "  zerocount status study.h5\n";

constexpr std::int64_t max_tasks = 1'000'000;

bool has_control_character(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

/// Options of the dependencies between jobs, and those that this command sets itself. sbatch takes a
/// long option by any beginning of its name, and the value of a short one without a space.
bool is_reserved(const std::string& option) {
  constexpr std::array<std::string_view, 14> names{
      "--array", "--dependency", "--output", "--error", "--wrap",          "--parsable", "--test-only",
      "--wait",  "--chdir",      "--ntasks", "--time",  "--cpus-per-task", "--job-name", "--export-file"};
  constexpr std::string_view letters = "adoeWDntcJ";
  if (!option.starts_with("--"))
    return option.size() > 1 && letters.find(option[1]) != std::string_view::npos;
  const std::string name = option.substr(0, option.find_first_of("= "));
  if (name == "--export") return false;
  return std::any_of(names.begin(), names.end(), [&](std::string_view one) { return one.starts_with(name); });
}

std::vector<std::string> sbatch_options(const command_line::Arguments& arguments) {
  std::vector<std::string> options = arguments.values("sbatch");
  for (const std::string& option : options) {
    if (!option.starts_with('-') || has_control_character(option)) {
      arguments.refuse(fmt::format(
          "option '--sbatch': '{}' is not an option of sbatch, such as --sbatch=--partition=long", option));
    }
    if (is_reserved(option)) {
      arguments.refuse(fmt::format("option '--sbatch': {} is set by this command; see --time and --cpus",
                                   option.substr(0, option.find_first_of("= "))));
    }
  }
  return options;
}

bool is_slurm_time(std::string_view text) {
  std::string form;  // of the text: 0 for each number
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit || !form.ends_with('0')) form += digit ? '0' : c;
  }
  constexpr std::array forms{"0", "0:0", "0:0:0", "0-0", "0-0:0", "0-0:0:0"};
  return std::find(forms.begin(), forms.end(), form) != forms.end();
}

std::optional<std::string> time_limit(const command_line::Arguments& arguments) {
  std::optional<std::string> time = arguments.value("time");
  if (time && !is_slurm_time(*time)) {
    arguments.refuse(fmt::format(
        "option '--time': '{}' is not a Slurm time: minutes, H:MM:SS, or D-HH, such as 2:00:00", *time));
  }
  return time;
}

/// The folder to which the paths in the scripts are relative.
fs::path current_folder(const command_line::Arguments& arguments, const fs::path& output) {
  fs::path folder = fs::current_path();
  const std::string paths = (folder / output).string();
  if (has_control_character(paths) || paths.find('\\') != std::string::npos)
    arguments.refuse(
        "Slurm does not accept a path with a backslash or a control character; name another folder");
  return folder;
}

study::Study study_to_divide(const command_line::Arguments& arguments, std::int64_t parts) {
  study::Study study =
      commands::load_study(arguments.operands()[0], arguments, commands::StudyUse::to_make_files);
  study.engine = study.plugin ? study::Engine::reference : study::Engine::batch;
  if (study.stop && parts > 1) {
    arguments.refuse(
        "option '--tasks': a study with `stop` cannot be divided, because its number of trials is decided "
        "while "
        "it runs; give --tasks 1, or remove `stop`");
  }
  if (parts > study::trial_count(study)) {
    arguments.refuse(
        fmt::format("option '--tasks': the {} trials of the study cannot be divided into {} parts",
                    study::trial_count(study), parts));
  }
  return study;
}

/// Maximum number of elements of an array job of so many parts. For --dry-run on a machine without Slurm, the
/// maximum of Slurm's default configuration.
/// @throws Failure (machine_failed) if Slurm is not installed, or does not run arrays.
std::int64_t max_array(const command_line::Arguments& arguments, std::int64_t parts) {
  std::int64_t size = cluster::default_max_array_size;
  try {
    size = cluster::max_array_size();
  } catch (const Failure&) {
    if (!arguments.has("dry-run")) throw;
  }
  if (parts == 1) return 1;
  if (size > 0) return size;
  throw Failure(ExitCode::machine_failed,
                "this Slurm has no array jobs (MaxArraySize is 0 in its configuration); use --tasks 1");
}

/// This program as nodes are to start it. That of an archive is `lib/zerocount`, or a loader in `lib/libc`,
/// and its launcher chooses the C library by the node.
fs::path program_for_nodes() {
  fs::path program = fs::read_symlink("/proc/self/exe");
  for (const fs::path& folder : {program.parent_path(), program.parent_path().parent_path()}) {
    fs::path launcher = folder.parent_path() / "bin" / "zerocount";
    if (folder.filename() == "lib" && fs::exists(launcher)) return launcher;
  }
  return program;
}

/// The request of the options; its elements are added when the missing parts are known.
cluster::BatchRequest batch_request(const command_line::Arguments& arguments, const fs::path& output,
                                    const study::Study& study) {
  cluster::BatchRequest request;
  request.name = study.name;
  request.study_sha256 = study.study_sha256;
  request.program = program_for_nodes();
  request.folder = current_folder(arguments, output);
  request.manifest = arguments.operands()[0];
  request.overrides = arguments.values("set");
  request.output = output;
  request.at_once = arguments.whole_number("at-once", 1, max_tasks);
  request.cpus = arguments.whole_number("cpus", 1, 4096).value_or(1);
  request.time = time_limit(arguments);
  request.sbatch_options = sbatch_options(arguments);
  request.replaces = arguments.has("force");
  return request;
}

/// @throws Failure (bad_input) if files of another division of the trials exist.
void require_same_division(const fs::path& output, std::int64_t parts) {
  const std::optional<cluster::Submission> earlier = cluster::read_submission(output);
  if (earlier && earlier->parts != parts) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: the trials were divided into {} parts earlier; give --tasks {}, or remove {}",
                    output.string(), earlier->parts, earlier->parts,
                    shards::parts_directory(output).string()));
  }
  std::error_code ignored;
  const fs::path shards = layout::shards_directory(output);
  if (parts > 1 && fs::exists(shards, ignored)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: a run of the whole study has begun and left shards in {}; continue it "
                              "with --tasks 1, or remove this folder",
                              output.string(), shards.string()));
  }
}

/// @throws Failure (bad_input) if a job that was submitted for this output has not ended.
void require_no_job(const fs::path& output) {
  const std::optional<cluster::Submission> earlier = cluster::read_submission(output);
  if (!earlier || earlier->jobs.empty()) return;
  const std::vector<std::string> queued = cluster::queued_jobs();
  for (const std::string& job : earlier->jobs) {
    if (std::find(queued.begin(), queued.end(), job) == queued.end()) continue;
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: job {} of this output is still in the queue; wait for it, or end it with "
                              "'scancel {}'",
                              output.string(), job, job));
  }
}

/// A script to submit.
struct Script {
  std::string title;
  fs::path path;
  std::string text;
};

/// Each begins after the end of the one before.
std::vector<Script> scripts_of(const cluster::BatchRequest& request) {
  const fs::path directory = shards::parts_directory(request.output);
  if (request.job.parts == 1) return {{"job", directory / "run.sbatch", cluster::single_script(request)}};
  std::vector<Script> all;
  if (!request.elements.empty()) {
    const std::size_t count = request.elements.size();
    all.push_back({fmt::format("array job of {} {}", count, count == 1 ? "element" : "elements"),
                   directory / "array.sbatch", cluster::array_script(request)});
  }
  all.push_back({"merge job", directory / "merge.sbatch", cluster::merge_script(request)});
  return all;
}

/// Whether the name exists, even as a dangling link.
bool has_entry(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

/// Submits the scripts; prints and records each job at once.
void submit(const fs::path& output, const cluster::BatchRequest& request) {
  cluster::Submission submission{request.job.parts, request.study_sha256, {}};
  for (const Script& script : scripts_of(request)) {
    const bool is_new = !has_entry(script.path);
    storage::replace_file(script.path, script.text);
    try {
      submission.jobs.push_back(
          cluster::submit(script.path, submission.jobs.empty() ? "" : submission.jobs.back()));
    } catch (const Failure&) {
      std::error_code ignored;
      if (is_new && submission.jobs.empty()) fs::remove(script.path, ignored);
      throw;
    }
    standard_output::print("submitted: {} {} ({})\n", script.title, submission.jobs.back(),
                           script.path.string());
    cluster::write_submission(output, submission);
  }
  standard_output::print("watch:     squeue --jobs={}\n           zerocount status {}\n",
                         fmt::join(submission.jobs, ","), text::shell_path(output));
}

/// Submits the incomplete parts and the merge.
void submit_missing(const fs::path& output, const study::Study& study, cluster::BatchRequest& request) {
  const fs::path directory = shards::parts_directory(output);
  const bool is_new = !has_entry(directory);
  storage::make_directory(directory);
  try {
    const storage::OutputLock lock(cluster::submission_file(output));  // one command at a time
    require_no_job(output);
    cluster::prepare_parts(
        output, study, request.job.parts,
        request.replaces ? study_run::ForeignShards::remove : study_run::ForeignShards::refuse);
    request.elements =
        cluster::elements_of(request.job, cluster::missing_parts(output, study, request.job.parts));
    submit(output, request);
  } catch (const Failure&) {
    std::error_code ignored;
    if (is_new) fs::remove(directory, ignored);  // if there is nothing in it
    throw;
  }
}

ExitCode slurm(const command_line::Arguments& arguments) {
  const fs::path output = command_line::output_place(arguments);
  if (yaml::is_stream(arguments.operands()[0]))
    arguments.refuse("the jobs read the manifest later; name a file instead of a stream");
  arguments.required("tasks");
  const std::int64_t parts = *arguments.whole_number("tasks", 1, max_tasks);
  if (parts == 1 && arguments.has("at-once")) arguments.refuse("option '--at-once' needs more than one part");
  const study::Study study = study_to_divide(arguments, parts);
  cluster::BatchRequest request = batch_request(arguments, output, study);
  if (!arguments.has("dry-run")) require_no_job(output);
  require_same_division(output, parts);
  request.job = cluster::array_job(parts, max_array(arguments, parts));
  if (!arguments.has("dry-run")) {
    submit_missing(output, study, request);
    return ExitCode::success;
  }
  request.elements = cluster::elements_of(request.job, cluster::missing_parts(output, study, parts));
  for (const Script& script : scripts_of(request))
    standard_output::write(fmt::format("==> {} <==\n{}\n", script.path.string(), script.text));
  return ExitCode::success;
}

}  // namespace

commands::Command slurm_command() {
  return {{"slurm",
           "MANIFEST -o FILE --tasks N",
           {command_line::written_file({"output,o", "FILE", "the results file to make (required)"}),
            {"tasks", "N", "parts that the trials are divided into (required)"},
            {"cpus", "C", "processors of each job (default 1)"},
            {"time", "T", "time limit of each job, as for sbatch, e.g. 2:00:00"},
            {"at-once", "M", "maximum number of elements that run at the same time"},
            {"sbatch", "OPTION",
             "further option of sbatch for all jobs, e.g. --sbatch=--partition=long; may be repeated", true},
            {"dry-run", "", "print the scripts; write and submit nothing"},
            {"set", "KEY=VALUE", "override a manifest key, as in 'zerocount run'; may be repeated", true},
            {"force", "", "replace FILE, and discard the parts of another study or build"}}},
          "run a study as an array job of Slurm",
          slurm_help,
          slurm};
}

}  // namespace zerocount::study_commands
