// Feeds a part with changes (see file_edits.hpp) to what resuming, `status` and `merge` read of finished
// trials.

#include "results/shards/shard.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "analysis/trials/summary/study_statistics.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"
#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/merge.hpp"
#include "runners/study_run/file_run.hpp"
#include "tests/fuzz/expectation.hpp"
#include "tests/fuzz/file_edits.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace zerocount;

void read_shard(const std::filesystem::path& path) {
  const reading::ResultsFile file(path, reading::Require::any_part);
  if (layout::has_sums(file.header().retention)) {
    const study::Study& study = file.study();
    for (std::int64_t i = 0; i < file.points(); ++i)
      summary::restored_point(file, study, file.first_point() + i);
  }
  if (file.trials()) file.trials()->require_valid_values();
}

void merge_shard(const std::filesystem::path& path, const std::filesystem::path& output) {
  const std::vector<std::filesystem::path> inputs{path};
  const study::Study study = layout::recorded_study(shards::first_header(inputs), path);
  const std::vector<shards::ShardInfo> found = shards::merge_inputs(inputs, study);
  study_run::assemble(found, study, output, found.front().rows);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<fuzz::SampleFile> samples = fuzz::editable_files("shard");
  static fuzz::MemoryFile file;
  static const testing::TemporaryFolder folder;
  static const std::filesystem::path shards = folder.path() / "run.h5.shards";
  if (size == 0) return 0;
  if (!std::filesystem::exists(shards)) {
    std::filesystem::create_directory(shards);
    std::filesystem::create_symlink(file.path(), shards / "trials.h5");
  }
  fuzz::write_input(samples, {data, size}, file);
  fuzz::require_clear_refusal([] { read_shard(file.path()); });
  fuzz::require_clear_refusal([] {
    const summary::StudySummary found = summary::summarise_unfinished(folder.path() / "run.h5", 0.95, false);
    fuzz::require_text(document::text(summary_answer::summary_answer(found)));
  });
  fuzz::require_clear_refusal([] { merge_shard(file.path(), folder.path() / "merged.h5"); });
  return 0;
}
