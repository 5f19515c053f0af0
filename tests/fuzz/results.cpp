// Feeds a results file with changes (see file_edits.hpp) to what `export` and `summary` read.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/basis/text/report_json.hpp"
#include "analysis/trials/iso230/results_group.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "analysis/trials/summary_answer/summary_answer.hpp"
#include "results/reading/export.hpp"
#include "results/reading/results_file.hpp"
#include "tests/fuzz/expectation.hpp"
#include "tests/fuzz/file_edits.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace zerocount;

void export_tables(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const reading::ResultsFile file(path);
  reading::export_csv(file, folder, iso230::repeatability_exports(file), reading::ExistingFiles::replace);
}

void print_summary(const std::filesystem::path& path) {
  const summary::StudySummary found = summary::summarise_file(path);
  const document::Answer answer = summary_answer::summary_answer(found);
  fuzz::require_text(document::text(answer));
  fuzz::require_text(text::json_text(document::json(answer)));
  document::csv(answer);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<fuzz::SampleFile> samples = fuzz::editable_files("results");
  static fuzz::MemoryFile file;
  static const testing::TemporaryFolder folder;
  if (size == 0) return 0;
  fuzz::write_input(samples, {data, size}, file);
  fuzz::require_clear_refusal([] { print_summary(file.path()); });
  fuzz::require_clear_refusal([] { export_tables(file.path(), folder.path()); });
  return 0;
}
