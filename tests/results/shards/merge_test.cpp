#include "results/shards/merge.hpp"

#include "results/layout/table_io.hpp"
#include "results/storage/durable_file.hpp"
#include "tests/results/equality.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/results/walk.hpp"
#include "tests/support/merged_file.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

/// Shards (files with the results of consecutive rows) of `rows`, cut at random places.
std::vector<shards::ShardInfo> random_shards(const fs::path& directory, const study::Study& study,
                                             layout::RowRange rows, std::mt19937& random) {
  fs::create_directories(directory);
  std::vector<shards::ShardInfo> shards;
  while (rows.count > 0) {
    const std::int64_t count =
        std::min<std::int64_t>(rows.count, 1 + static_cast<std::int64_t>(random()) % 60);
    shards.push_back(write_sample_shard(directory, study, {rows.first, count}));
    rows = {rows.first + count, rows.count - count};
  }
  std::shuffle(shards.begin(), shards.end(), random);
  return shards;
}

fs::path merged(const fs::path& path, const study::Study& study, std::span<const shards::ShardInfo> shards) {
  testing::merge_shards(shards, study, path, layout::all_rows(study), sample_statistics,
                        {sample_provenance()});
  return path;
}

TEST(Merge, KeepsEverythingOfEveryTrial) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(4, 50, 3);
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  expect_sound(file.path());
  EXPECT_TRUE(file.header().complete);
  EXPECT_EQ(file.header().seed, study.seed);
  EXPECT_EQ(file.moves(), 3);
  EXPECT_EQ(file.measures().size(), layout::outcome_fields(study.features).size());
  std::int64_t jerk = 0;
  std::int64_t record = 0;
  for (std::int64_t row = 0; row < study::trial_count(study); ++row) {
    const shards::TrialResult expected = sample_result(study, row);
    EXPECT_EQ(inputs_of(file, row), expected.inputs);
    expect_equal_records(file.measures(), file.outcomes({row, 1}), expected.outcome.moves);
    std::vector<layout::JerkRecord> jerks;
    for (const trial::Jerk& each : expected.jerks) jerks.push_back({each, row});
    expect_equal_records(layout::jerk_fields(), file.jerks({row, 1}), jerks);
    expect_equal_records(layout::jerk_fields(), file.jerks_at(jerk, std::ssize(jerks)), jerks);
    jerk += std::ssize(jerks);
    std::vector<layout::TraceRecord> trace;
    for (const trial::SampleRecord& each : expected.trace) trace.push_back({each, row});
    expect_equal_records(layout::trace_fields(study.features), file.trace_at(record, std::ssize(trace)),
                         trace);
    record += std::ssize(trace);
  }
  EXPECT_EQ(jerk, file.jerk_count());
  EXPECT_EQ(record, file.trace_count());
}

/// Shards whose chunks are those of the file, which takes them over as they are stored, and other shards.
TEST(Merge, StoresTheSameBytesWhetherChunksAreCopiedOrEncoded) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(2, 10000, 1);
  const auto shards_of = [&](const std::string& name, std::vector<std::int64_t> ends,
                             hdf5::Compression compression) {
    fs::create_directories(directory / name);
    std::vector<shards::ShardInfo> shards;
    std::int64_t first = 0;
    for (const std::int64_t end : ends) {
      const layout::RowRange rows{first, end - first};
      shards.push_back({shards::shard_path(directory / name, rows), rows});
      shards::write_shard(shards.back().path, study, rows, sample_results(study, rows), {},
                          {sample_provenance(), compression});
      first = end;
    }
    return shards;
  };
  const auto copied = shards_of("copied", {layout::chunk_elements, 20000}, hdf5::Compression::deflate);
  const auto whole = shards_of("whole", {20000}, hdf5::Compression::deflate);
  const auto encoded = shards_of("encoded", {5000, 17000, 20000}, hdf5::Compression::none);
  const fs::path expected = merged(directory / "encoded.h5", study, encoded);
  expect_same_datasets(merged(directory / "copied.h5", study, copied), expected);
  expect_same_datasets(merged(directory / "whole.h5", study, whole), expected);

  std::string bytes = read_bytes(copied[0].path);
  bytes[bytes.size() / 2] ^= 1;
  write_bytes(copied[0].path, bytes);
  expect_failure(ExitCode::bad_data, ": its values cannot be read or their checksum is wrong",
                 [&] { merged(directory / "damaged.h5", study, copied); });
  EXPECT_FALSE(fs::exists(directory / "damaged.h5"));
}

TEST(Merge, HasNoColumnsForUnusedFeatures) {
  const TemporaryFolder directory;
  study::Study study = sample_study();
  study.features.stopping = false;
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  EXPECT_FALSE(file.root().open_group("outcome").contains("stopped"));
  EXPECT_EQ(file.measures().size(), layout::outcome_fields(study.features).size());
  for (const trial::MoveOutcome& move : file.outcomes(file.rows())) EXPECT_FALSE(move.stopped);
  const auto moves = static_cast<std::size_t>(file.rows().count * file.moves());
  EXPECT_EQ(file.measure("stopped", file.rows()), std::vector<double>(moves, 0.0));
}

TEST(Merge, KeepsLabelsAxesAndStatisticsOfPoints) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  EXPECT_EQ(file.point_labels(), study.points.labels);
  const std::vector<study::SweepAxis> axes = file.axes();
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(axes[0].name, "controller.ki");
  EXPECT_EQ(axes[0].unit, "N m/count");
  EXPECT_TRUE(std::isnan(axes[0].numbers[0]));
  EXPECT_EQ(axes[0].numbers[2], study.points.axes[0].numbers[2]);
  EXPECT_EQ(axes[1].kind, study::SweepAxis::Kind::text);
  EXPECT_EQ(axes[1].texts, study.points.axes[1].texts);
  ASSERT_EQ(file.statistics().size(), 2U);
  EXPECT_EQ(file.statistics()[0].values, std::vector<double>(3, 40.0));
  EXPECT_EQ(file.statistics()[1].values, sample_statistics(file).points[1].values);
  ASSERT_EQ(file.input_columns().size(), 2U);
  EXPECT_EQ(file.input_columns()[0].unit, "N m/rad");
}

TEST(Merge, KeepsTablesOfStatisticsAndFurtherGroups) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(3, 40, 2);
  const auto shards = write_sample_shards(directory / "shards", study, layout::all_rows(study), 50);
  shards::MergedFile merged(shards, study, directory / "all.h5", layout::all_rows(study));
  merged.write_statistics(sample_statistics(merged.trials()));
  merged.file().create_group("further").set_integer("answer", 42);
  merged.finish();
  const reading::AllTrialsFile file(directory / "all.h5");
  const std::vector<layout::StatisticTable> tables = file.statistic_tables();
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_EQ(tables[0].group, &layout::level_group());
  EXPECT_EQ(tables[0].width, 2);
  ASSERT_EQ(tables[0].columns.size(), 1U);
  const layout::PointColumn expected = sample_table(file).columns[0];
  EXPECT_EQ(tables[0].columns[0].name, expected.name);
  EXPECT_EQ(tables[0].columns[0].unit, expected.unit);
  EXPECT_EQ(tables[0].columns[0].values, expected.values);
  EXPECT_EQ(file.root().open_group("further").integer("answer"), 42);
}

TEST(Merge, RefusesStatisticsWithAnotherNumberOfPoints) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(3, 40, 2);
  const auto shards = write_sample_shards(directory / "shards", study, layout::all_rows(study), 50);
  const testing::StatisticsOfPoints statistics = [](const reading::AllTrialsFile& file) {
    layout::StoredStatistics stored = sample_statistics(file);
    stored.tables[0].columns[0].values.pop_back();
    return stored;
  };
  EXPECT_THROW(
      testing::merge_shards(shards, study, directory / "all.h5", layout::all_rows(study), statistics),
      std::invalid_argument);
}

TEST(Merge, KeepsOnlyTheColumnsOfSampleRecordsThatTheStudyHas) {
  const TemporaryFolder directory;
  study::Study study = sample_study(1, 5, 1);
  study.features.travel = study.features.drive_torque = false;
  const auto shards = write_sample_shards(directory / "shards", study, layout::all_rows(study), 2);
  const reading::AllTrialsFile file(merged(directory / "all.h5", study, shards));
  EXPECT_FALSE(file.features().travel);
  EXPECT_TRUE(file.features().phases);
  EXPECT_FALSE(file.features().drive_torque);
  const std::vector<trial::SampleRecord> written = sample_result(study, 0).trace;
  const std::vector<layout::TraceRecord> read = file.trace_at(0, file.trace_count());
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].theta, written[i].theta);
    EXPECT_EQ(read[i].phase, written[i].phase);
    EXPECT_EQ(read[i].reference, written[i].target);
    EXPECT_EQ(read[i].drive_torque, written[i].torque);
  }
}

TEST(Merge, TabulatesTheProfiles) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  ASSERT_EQ(file.profiles().size(), 1U);
  const reading::StoredProfile profile = file.profiles()[0];
  EXPECT_EQ(profile.name, "friction.k1");
  ASSERT_EQ(profile.theta.size(), static_cast<std::size_t>(layout::profile_angles));
  for (std::size_t i = 0; i < profile.theta.size(); i += 97)
    EXPECT_EQ(profile.value[i], friction::value_at(*study.profiles[0].profile, profile.theta[i]));
}

TEST(Merge, ReadsOneMeasureAsNumbers) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const reading::AllTrialsFile file(write_sample_file(directory.path(), study));
  const std::vector<trial::MoveOutcome> outcomes = file.outcomes({10, 30});
  const std::vector<double> verdicts = file.measure("outcome", {10, 30});
  const std::vector<double> arrived = file.measure("arrived", {10, 30});
  ASSERT_EQ(verdicts.size(), outcomes.size());
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    EXPECT_EQ(verdicts[i], static_cast<double>(outcomes[i].outcome));
    EXPECT_EQ(arrived[i], outcomes[i].arrived ? 1.0 : 0.0);
  }
  EXPECT_THROW(file.measure("no_such_measure", {0, 1}), std::invalid_argument);
}

TEST(Merge, GivesTheSameBytesForAnyDivisionIntoShards) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(3, 70, 2);
  std::mt19937 random(11);
  const std::vector<shards::ShardInfo> one =
      write_sample_shards(directory / "one", study, layout::all_rows(study), 1000);
  const fs::path reference = merged(directory / "reference.h5", study, one);
  const std::map<std::string, std::string> expected = stored_datasets(reference);
  ASSERT_GT(expected.size(), 40U);
  for (int repetition = 0; repetition < 8; ++repetition) {
    const std::string name = "cut" + std::to_string(repetition);
    const fs::path path = merged(directory / (name + ".h5"), study,
                                 random_shards(directory / name, study, layout::all_rows(study), random));
    EXPECT_EQ(stored_datasets(path), expected);
    EXPECT_TRUE(read_bytes(path) == read_bytes(reference)) << "the datasets agree, but not the files";
  }
}

TEST(Merge, JoinsPartsLikeShards) {
  const TemporaryFolder directory;
  const study::Study study = sample_study(3, 50, 2);
  const std::vector<shards::ShardInfo> shards =
      write_sample_shards(directory / "shards", study, layout::all_rows(study), 13);
  const fs::path whole = merged(directory / "whole.h5", study, shards);
  std::vector<fs::path> parts;
  for (const layout::RowRange rows : {layout::RowRange{0, 61}, layout::RowRange{61, 89}}) {
    parts.push_back(directory / ("part" + std::to_string(rows.first) + ".h5"));
    const auto pieces =
        write_sample_shards(directory / ("shards" + std::to_string(rows.first)), study, rows, 20);
    testing::merge_shards(pieces, study, parts.back(), rows, sample_statistics, {sample_provenance()});
    const reading::AllTrialsFile part(parts.back(), reading::Require::any_part);
    EXPECT_FALSE(part.header().complete);
    EXPECT_TRUE(part.statistics().empty());
    expect_sound(parts.back());
    expect_failure(ExitCode::bad_data, "incomplete: it holds trials",
                   [&] { reading::AllTrialsFile{parts.back()}; });
  }
  EXPECT_EQ(stored_datasets(merged(directory / "joined.h5", study, shards::merge_inputs(parts, study))),
            stored_datasets(whole));
}

TEST(Merge, TakesDirectoriesOfShardsAndFindsTheStudyInThem) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  write_sample_shards(directory / "shards", study, layout::all_rows(study), 25);
  const std::vector<fs::path> inputs{directory / "shards"};
  const layout::FileHeader header = shards::first_header(inputs);
  EXPECT_EQ(header.manifest, study.manifest.text);
  EXPECT_EQ(header.overrides, study.manifest.overrides);
  expect_sound(merged(directory / "all.h5", study, shards::merge_inputs(inputs, study)));
}

TEST(Merge, WorksWithoutAxesInputsProfilesJerksAndOverrides) {
  const TemporaryFolder directory;
  study::Study study = sample_study(1, 5, 1);
  study.points.axes.clear();
  study.columns.inputs.clear();
  study.profiles.clear();
  study.manifest.overrides.clear();
  std::vector<shards::TrialResult> results(5);
  for (std::int64_t row = 0; row < 5; ++row) {
    results[static_cast<std::size_t>(row)].row = row;
    results[static_cast<std::size_t>(row)].outcome.moves.resize(1);
  }
  shards::write_shard(directory / "shard.h5", study, {0, std::ssize(results)}, results);
  const std::vector<shards::ShardInfo> shards{{directory / "shard.h5", {0, 5}}};
  testing::merge_shards(shards, study, directory / "all.h5", {0, 5}, {});
  const reading::AllTrialsFile file(directory / "all.h5");
  expect_sound(file.path());
  EXPECT_EQ(file.jerk_count(), 0);
  EXPECT_TRUE(file.jerks({0, 5}).empty());
  EXPECT_TRUE(file.has_trace());
  EXPECT_EQ(file.trace_count(), 0);
  EXPECT_TRUE(file.profiles().empty() && file.axes().empty() && file.statistics().empty());
  EXPECT_TRUE(file.header().overrides.empty());
}

TEST(Merge, RefusesGapsOverlapsAndShardsOutOfRange) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  std::vector<shards::ShardInfo> shards =
      write_sample_shards(directory / "shards", study, layout::all_rows(study), 40);
  const fs::path output = directory / "all.h5";
  const auto merge = [&](const std::vector<shards::ShardInfo>& given, layout::RowRange rows) {
    return [&, given, rows] { testing::merge_shards(given, study, output, rows, {}); };
  };
  expect_failure(ExitCode::bad_data, "trials 40 to 79 are in none", merge({shards[0], shards[2]}, {0, 120}));
  expect_failure(ExitCode::bad_data, "trials 80 to 119 are in none", merge({shards[0], shards[1]}, {0, 120}));
  expect_failure(ExitCode::bad_data, "trials 0 to 39 are in none", merge({shards[1], shards[2]}, {0, 120}));
  expect_failure(ExitCode::bad_data, "trials 0 to 119 are in none", merge({}, {0, 120}));
  expect_failure(ExitCode::bad_data, "outside the 0 to 79", merge(shards, {0, 80}));
  const shards::ShardInfo twice = write_sample_shard(directory.path(), study, {30, 20});
  shards.push_back(twice);
  expect_failure(ExitCode::bad_data, "overlap", merge(shards, {0, 120}));
  EXPECT_FALSE(fs::exists(output));
  EXPECT_FALSE(fs::exists(storage::part_of(output)));
}

TEST(Merge, RefusesShardsOfAnotherStudyOrFormat) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  study::Study other = study;
  other.study_sha256 = "another";
  const std::vector<fs::path> inputs{write_sample_file(directory.path(), study)};
  expect_failure(ExitCode::bad_data, "is from another study", [&] { shards::merge_inputs(inputs, other); });
  replace_attribute(inputs[0], "format_version", layout::format_version + 1);
  expect_failure(ExitCode::bad_data, fmt::format("newer than the {}", layout::format_version),
                 [&] { shards::merge_inputs(inputs, study); });
  replace_attribute(inputs[0], "format_version", 3);
  expect_failure(ExitCode::bad_data, fmt::format("reads version {}", layout::format_version),
                 [&] { shards::merge_inputs(inputs, study); });
  replace_attribute(inputs[0], "format", "another");
  expect_failure(ExitCode::bad_data, "its format is 'another'", [&] { shards::merge_inputs(inputs, study); });
  const std::vector<fs::path> nothing{directory / "nothing.h5"};
  expect_failure(ExitCode::bad_input, "nothing.h5: no such file",
                 [&] { shards::merge_inputs(nothing, study); });
  fs::create_directory(directory / "empty");
  const std::vector<fs::path> empty{directory / "empty"};
  expect_failure(ExitCode::bad_input, "no shards", [&] { shards::merge_inputs(empty, study); });
}

TEST(Merge, RefusesTrialsOfAnotherBuild) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  layout::Provenance another = sample_provenance();
  another.git_commit = std::string(40, '0');
  const std::vector<fs::path> inputs{directory / "shard.h5"};
  shards::write_shard(inputs[0], study, layout::all_rows(study),
                      sample_results(study, layout::all_rows(study)), {}, {another});
  expect_failure(ExitCode::bad_data, "finish with the same build",
                 [&] { shards::merge_inputs(inputs, study); });
}

TEST(Merge, RecordsThatAShardWasMadeFromChangedSources) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  layout::Provenance clean = sample_provenance();
  const std::string here = layout::current_provenance().git_commit;
  clean.git_commit = here.substr(0, here.find('-'));
  layout::Provenance changed = clean;
  changed.git_commit += "-dirty";
  const std::vector<shards::ShardInfo> shards{{directory / "a.h5", {0, 50}}, {directory / "b.h5", {50, 70}}};
  shards::write_shard(shards[0].path, study, shards[0].rows, sample_results(study, shards[0].rows), {},
                      {clean});
  shards::write_shard(shards[1].path, study, shards[1].rows, sample_results(study, shards[1].rows), {},
                      {changed});
  testing::merge_shards(shards, study, directory / "all.h5", layout::all_rows(study), {}, {clean});
  EXPECT_EQ(reading::AllTrialsFile(directory / "all.h5").header().provenance.git_commit, changed.git_commit);
}

TEST(Merge, ReplacesAnEarlierFileOnlyWhenItIsWhole) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const fs::path path = write_sample_file(directory.path(), study);
  const std::string whole = read_bytes(path);
  const std::vector<shards::ShardInfo> shards =
      shards::merge_inputs(std::vector<fs::path>{layout::shards_directory(path)}, study);
  const testing::StatisticsOfPoints failing = [](const reading::AllTrialsFile&) -> layout::StoredStatistics {
    throw std::runtime_error("no");
  };
  EXPECT_THROW(testing::merge_shards(shards, study, path, layout::all_rows(study), failing),
               std::runtime_error);
  EXPECT_TRUE(read_bytes(path) == whole);
  directory.write(path.filename().string(), "an earlier file");
  testing::merge_shards(shards, study, path, layout::all_rows(study), {});
  EXPECT_EQ(reading::AllTrialsFile(path).rows(), layout::all_rows(study));
}

TEST(Merge, LeavesNoFileIfTheStatisticsFail) {
  const TemporaryFolder directory;
  const study::Study study = sample_study();
  const auto shards = write_sample_shards(directory / "shards", study, layout::all_rows(study), 40);
  const fs::path output = directory / "all.h5";
  const testing::StatisticsOfPoints failing = [](const reading::AllTrialsFile&) -> layout::StoredStatistics {
    throw std::runtime_error("no");
  };
  EXPECT_THROW(testing::merge_shards(shards, study, output, layout::all_rows(study), failing),
               std::runtime_error);
  EXPECT_FALSE(fs::exists(output));
  EXPECT_FALSE(fs::exists(storage::part_of(output)));
}

}  // namespace
}  // namespace zerocount::testing
