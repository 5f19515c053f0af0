#include "runners/cluster/batch_scripts.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "core/text/shell_word.hpp"
#include "results/shards/pieces.hpp"

namespace zerocount::cluster {
namespace {

/// Letters, digits and a few others; sbatch takes no blanks in a name.
std::string job_name(const std::string& study) {
  std::string name = "zerocount-" + study;
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  std::replace_if(
      name.begin(), name.end(), [&](char c) { return !is_plain(c); }, '-');
  return name;
}

/// @param log name of the file with what the job prints; %a is the element
std::string options_text(const BatchRequest& request, std::string_view ending, std::string_view log) {
  const std::filesystem::path folder = request.folder / shards::parts_directory(request.output);
  std::string text = fmt::format(
      "#SBATCH --job-name={}{}\n#SBATCH --output={}{}\n#SBATCH --open-mode=append\n#SBATCH "
      "--cpus-per-task={}\n",
      job_name(request.name), ending, sbatch_path(folder.string() + "/"), log, request.cpus);
  if (request.time) text += fmt::format("#SBATCH --time={}\n", *request.time);
  return text;
}

std::string further_options(const BatchRequest& request) {
  std::string text;
  for (const std::string& option : request.sbatch_options) text += fmt::format("#SBATCH {}\n", option);
  return text;
}

/// "zerocount run MANIFEST --set … --study …"
std::string run_words(const BatchRequest& request) {
  std::string words =
      fmt::format("{} run {}", text::shell_path(request.program), text::shell_path(request.manifest));
  for (const std::string& override : request.overrides) words += " --set " + text::shell_word(override);
  return words + " --study " + request.study_sha256;
}

}  // namespace

std::string sbatch_path(const std::string& path) {
  std::string pattern = "\"";
  for (const char c : path) {
    if (c == '"') pattern += '\\';
    if (c == '%') pattern += '%';
    pattern += c;
  }
  return pattern + "\"";
}

std::string single_script(const BatchRequest& request) {
  return fmt::format(
      "#!/bin/bash\n"
      "# The study as a whole; what was finished before an interruption is not run again.\n"
      "{}{}"
      "cd {} || exit 5\n"
      "exec {} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" --quiet --output {}{}\n",
      options_text(request, "", "run.log"), further_options(request), text::shell_path(request.folder),
      run_words(request), text::shell_path(request.output), request.replaces ? " --force" : "");
}

std::string array_script(const BatchRequest& request) {
  const auto& [parts, elements] = request.job;
  return fmt::format(
      "#!/bin/bash\n"
      "# The trials of the study in {0} parts, by {1} elements of an array job. Each element runs its parts "
      "one\n"
      "# after the other; what is complete is not run again.\n"
      "{2}#SBATCH --array={3}{4}\n"
      "{5}"
      "cd {6} || exit 5\n"
      "status=0\n"
      "trap 'stopped=yes' TERM INT  # the run ends by itself, and keeps what is finished\n"
      "for ((part = SLURM_ARRAY_TASK_ID + 1; part <= {0}; part += {1})); do\n"
      "  printf -v number '%0{7}d' \"$part\"\n"
      "  {8} \\\n"
      "    --shard \"$part/{0}\" --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" --quiet \\\n"
      "    --output {9}/\"part-$number-of-{0}.h5\" || status=$?\n"
      "  if [ \"${{stopped:-}}\" ] || [ \"$status\" -eq 130 ]; then break; fi\n"
      "done\n"
      "exit \"$status\"\n",
      parts, elements, options_text(request, "", "element-%a.log"), index_list(request.elements),
      request.at_once ? fmt::format("%{}", *request.at_once) : "", further_options(request),
      text::shell_path(request.folder), std::to_string(parts).size(), run_words(request),
      text::shell_path(shards::parts_directory(request.output)));
}

std::string merge_script(const BatchRequest& request) {
  BatchRequest one_processor = request;
  one_processor.cpus = 1;
  return fmt::format(
      "#!/bin/bash\n"
      "# Merges the parts; says which trials are missing where some are.\n"
      "{}{}"
      "cd {} || exit 5\n"
      "exec {} merge {} --output {}{}\n",
      options_text(one_processor, "-merge", "merge.log"), further_options(request),
      text::shell_path(request.folder), text::shell_path(request.program),
      text::shell_path(shards::parts_directory(request.output)), text::shell_path(request.output),
      request.replaces ? " --force" : "");
}

}  // namespace zerocount::cluster
