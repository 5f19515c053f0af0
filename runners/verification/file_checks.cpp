#include "runners/verification/file_checks.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "results/layout/table_io.hpp"
#include "results/storage/checksum_trailer.hpp"

namespace zerocount::verification {
namespace {

template <class Value>
void require_equal(std::string_view name, const Value& there, const Value& expected, ProblemList& problems) {
  if (there == expected) return;
  problems.add(fmt::format("the attribute '{}' is {}; its manifest says {}", name, there, expected));
}

void compare_header(const layout::FileHeader& header, const study::Study& study, ProblemList& problems) {
  require_equal("name", header.name, study.name, problems);
  require_equal("seed", header.seed, study.seed, problems);
  // Another program may define the hash otherwise: its files are compared by their manifests alone.
  if (layout::same_build(header.provenance, layout::current_provenance()))
    require_equal("study_sha256", header.study_sha256, study.study_sha256, problems);
}

/// The tables of trials and sums that a file of this study has.
std::vector<layout::Table> tables_of(const reading::ResultsFile& file, const study::Study& study) {
  const layout::FileHeader& header = file.header();
  std::vector<layout::Table> tables;
  if (file.trials()) {
    // A file of an earlier version lacks columns that a study of today has.
    const study::StudyFeatures& features =
        header.version == layout::format_version ? study.features : file.trials()->features();
    // Shards have the units of a rotary axis, whatever the study's.
    const parameters::AxisKind axis =
        header.kind == layout::FileKind::shard ? parameters::AxisKind::rotary : study.units.axis;
    tables = {layout::trial_table(study.columns.inputs),
              layout::on_axis(layout::outcome_table(header.version, features, file.trials()->table()), axis),
              layout::jerk_table()};
    if (features.bands.count > 0) tables.push_back(layout::on_axis(layout::band_table(features.bands), axis));
    if (features.tolerances.count > 0)
      tables.push_back(layout::on_axis(layout::tolerance_table(features.tolerances), axis));
    if (!study.retained_trials.empty())
      tables.push_back(layout::on_axis(layout::trace_table(features), axis));
  }
  if (layout::has_sums(header.retention)) {
    for (const layout::Table& table :
         {layout::sums_table(), layout::whole_sums_table(), layout::real_sums_table()})
      tables.push_back(table);
  }
  return tables;
}

/// Opens every column on its own, so that all problems are found.
void check_columns(const reading::ResultsFile& file, const layout::Table& table, ProblemList& problems) {
  for (const layout::Column& column : table.columns) {
    layout::Table single{table.group, table.rows, table.second, {column}, table.last};
    try {
      const layout::TableIo io = layout::TableIo::open(file.root(), single);
      const bool may_lack_units = file.header().kind == layout::FileKind::shard;
      if (may_lack_units && !io.column(0).has_attribute("units")) continue;
      const std::string unit = io.column(0).text("units");
      if (unit == column.unit) continue;
      problems.add(fmt::format("/{}/{}: its unit is '{}'; expected '{}'", table.group, column.name, unit,
                               column.unit));
    } catch (const Failure& failure) {
      problems.add(problem_of(failure, file.path()));
    }
  }
}

/// Checks a dataset of whole numbers: `expected` gives the number of each row.
template <class Expected>
void check_numbers(const reading::ResultsFile& file, const std::string& path, const Expected& expected,
                   ProblemList& problems) {
  const hdf5::Dataset dataset = file.root().open_dataset(path);
  if (dataset.element() != hdf5::Element::int64 || dataset.extent().size() != 1) {
    problems.add(fmt::format("/{}: it should be whole numbers in one dimension", path));
    return;
  }
  const auto rows = static_cast<std::int64_t>(dataset.extent()[0]);
  std::vector<std::int64_t> numbers;
  for (std::int64_t first = 0; first < rows; first += layout::chunk_elements) {
    numbers.resize(static_cast<std::size_t>(std::min(layout::chunk_elements, rows - first)));
    dataset.read(first, std::ssize(numbers), numbers.data());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::int64_t row = first + static_cast<std::int64_t>(i);
      if (numbers[i] == expected(row)) continue;
      problems.add(fmt::format("/{}: row {}: it is {}; expected {}", path, row, numbers[i], expected(row)));
      return;
    }
  }
}

/// Checks that the sample records belong to the retained trials, each from its first sample on.
void check_trace_numbers(const reading::ResultsFile& file, const study::Study& study, ProblemList& problems) {
  const reading::TrialTables& trials = *file.trials();
  std::vector<std::int64_t> expected;
  for (std::int64_t row = file.rows().first; row < file.rows().end(); ++row) {
    if (std::binary_search(study.retained_trials.begin(), study.retained_trials.end(), row % study.trials))
      expected.push_back(row);
  }
  std::size_t begun = 0;  // trials
  std::int64_t k = 0;
  for (std::int64_t first = 0; first < trials.trace_count(); first += layout::chunk_elements) {
    const std::int64_t count = std::min(layout::chunk_elements, trials.trace_count() - first);
    std::int64_t number = first;
    for (const layout::TraceRecord& record : trials.trace_at(first, count)) {
      const bool continues = begun > 0 && record.k == k;
      const bool begins = begun < expected.size() && record.trial == expected[begun] && !continues;
      if (begins) {
        ++begun;
        k = 0;
      }
      if (begun == 0 || record.trial != expected[begun - 1]) {
        problems.add(
            fmt::format("/trace/trial: row {}: it is {}; expected the retained trials, in their order",
                        number, record.trial));
        return;
      }
      if (record.k != k) {
        problems.add(fmt::format("/trace/k: trial {}: it is {}; expected {}", record.trial, record.k, k));
        return;
      }
      ++k;
      ++number;
    }
  }
  if (begun != expected.size()) {
    problems.add(
        fmt::format("/trace/trial: it has records of {} trials; expected those of the {} retained ones",
                    begun, expected.size()));
  }
}

void check_all_numbers(const reading::ResultsFile& file, const study::Study& study, ProblemList& problems) {
  const std::int64_t first = file.rows().first;
  const auto global = [first](std::int64_t row) { return first + row; };
  const auto same = [](std::int64_t row) { return row; };
  if (!layout::has_sums(
          file.header().retention)) {  // the rows of failures were checked when they were opened
    check_numbers(file, "trial/trial", global, problems);
    check_numbers(file, "outcome/trial", global, problems);
    check_numbers(
        file, "trial/point", [&](std::int64_t row) { return global(row) / study.trials; }, problems);
    check_numbers(
        file, "trial/index", [&](std::int64_t row) { return global(row) % study.trials; }, problems);
  }
  check_numbers(file, "outcome/move", same, problems);
  check_numbers(file, "jerk/jerk", same, problems);
  if (file.trials()->moves() != study.moves) {
    problems.add(
        fmt::format("/outcome/move: {} moves; its manifest has {}", file.trials()->moves(), study.moves));
  }
  if (study.retained_trials.empty()) return;
  check_numbers(file, "trace/record", same, problems);
  check_trace_numbers(file, study, problems);
}

}  // namespace

bool check_bytes(CheckReport& report) {
  return add_check(report, "checksum", [&](Check& check, ProblemList&) {
    layout::open_results(report.path);
    check.detail = "SHA-256 " + storage::recorded_checksum(report.path);
  });
}

bool check_bytes_to_reseal(CheckReport& report, bool& holds) {
  return add_check(report, "checksum", [&](Check& check, ProblemList&) {
    layout::open_results(report.path, layout::Checksum::not_yet);
    holds = storage::check_checksum(report.path) == storage::ChecksumState::valid;
    check.detail = holds ? "SHA-256 " + storage::recorded_checksum(report.path)
                         : "does not hold; it is made again if everything else does";
  });
}

std::optional<Described> check_header(CheckReport& report,
                                      const std::shared_ptr<const plugin::ControllerPlugin>& plugin) {
  std::optional<Described> described;
  add_check(report, "header", [&](Check& check, ProblemList& problems) {
    const hdf5::File file = hdf5::File::open_to_read(report.path);
    layout::FileHeader header = layout::read_header(file);
    if (!header.finished) problems.add("it was never finished");
    study::Study study = layout::recorded_study(header, report.path, header.plugin ? plugin : nullptr);
    compare_header(header, study, problems);
    check.detail = fmt::format("{}, trials {} to {} of {}", header.name, header.rows.first,
                               header.rows.end() - 1, header.trials * header.points);
    described = {std::move(header), std::move(study)};
  });
  return described;
}

std::optional<reading::ResultsFile> check_tables(CheckReport& report, const study::Study& study) {
  std::optional<reading::ResultsFile> file;
  add_check(report, "datasets", [&](Check& check, ProblemList& problems) {
    file.emplace(report.path, reading::Require::unfinished);  // the checksum was checked before
    const std::vector<layout::Table> tables = tables_of(*file, study);
    std::size_t columns = 0;
    for (const layout::Table& table : tables) {
      columns += table.columns.size();
      check_columns(*file, table, problems);
    }
    if (file->trials()) check_all_numbers(*file, study, problems);
    check.detail = fmt::format("{} columns", columns);
  });
  return file;
}

}  // namespace zerocount::verification
