#include "results/shards/statistics_shard.hpp"

#include <algorithm>
#include <vector>

#include "results/layout/table_io.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::shards {
namespace {

/// Writes the numbers of all points, one after the other.
template <class Number>
void write_numbers(hdf5::File& file, const layout::Table& table, std::span<const layout::PointSums> sums,
                   std::vector<Number> layout::PointSums::*numbers) {
  std::vector<Number> all;
  for (const layout::PointSums& point : sums)
    all.insert(all.end(), (point.*numbers).begin(), (point.*numbers).end());
  layout::TableIo io = layout::TableIo::create(file, table, std::ssize(all), 1);
  io.number_rows(0);
  io.column(0).write(0, std::ssize(all), all.data());
}

}  // namespace

void write_sums(hdf5::File& file, std::int64_t first_point, std::span<const layout::PointSums> sums) {
  layout::TableIo io = layout::TableIo::create(file, layout::sums_table(), std::ssize(sums), 1);
  io.number_rows(first_point);
  std::vector<std::int64_t> whole, real;
  for (const layout::PointSums& point : sums) {
    whole.push_back(std::ssize(point.whole));
    real.push_back(std::ssize(point.real));
  }
  io.column(0).write(0, std::ssize(whole), whole.data());
  io.column(1).write(0, std::ssize(real), real.data());
  write_numbers(file, layout::whole_sums_table(), sums, &layout::PointSums::whole);
  write_numbers(file, layout::real_sums_table(), sums, &layout::PointSums::real);
}

void write_statistics_shard(const std::filesystem::path& path, const study::Study& study,
                            layout::RowRange rows, std::span<const layout::PointSums> sums,
                            std::span<const TrialResult> failures, const layout::Provenance& provenance) {
  const storage::UnfinishedFile part(path);
  hdf5::File file = hdf5::File::create(part.path());
  layout::write_header(file, layout::make_header(study, layout::FileKind::shard, rows, provenance));
  if (study.kept == study::Kept::failures) write_trial_tables(file, study, failures, shard_compression);
  write_sums(file, rows.first / study.trials, sums);
  layout::mark_finished(file);
  finish_results(path, file.close());
}

}  // namespace zerocount::shards
