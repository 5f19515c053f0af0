#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/point_sums.hpp"
#include "results/layout/table_io.hpp"
#include "results/reading/shard_file.hpp"
#include "results/reading/trial_tables.hpp"

namespace zerocount::reading {

/// How much of its study a file must hold to be opened.
enum class Require {
  complete,   ///< every trial: what statistics may be made of
  any_part,   ///< also a part or a shard
  unfinished  ///< also a file that this process is making, or has checked: its checksum is not read
};

/// A profile as it stands in a results file.
struct StoredProfile {
  std::string name;
  std::string unit;
  std::vector<double> theta;  ///< rad
  std::vector<double> value;  ///< in `unit`; of machines [machine][theta], flattened
  std::int64_t machines{0};   ///< each with a rotor of its own; 0: one rotor of all trials
  std::string theta_unit{"rad"};
};

/// The groups of a grouping in a results file (layout::groupings): its machines, worlds, conditions or ages.
/// Counts and statistics are [point][group], flattened, and empty in a part.
struct StoredGroups {
  std::int64_t count{0};
  std::vector<study::InputColumn> columns;  ///< what is drawn for each of them
  std::vector<std::vector<double>> inputs;  ///< [column][group]
  std::vector<std::string> names;           ///< [group] of conditions; otherwise empty
  std::vector<double> values;               ///< [group] of ages; otherwise empty
  std::string unit;                         ///< of these
  std::vector<std::int64_t> success;        ///< trials that succeeded
  std::vector<std::int64_t> trials;         ///< trials that were judged
  std::vector<std::int64_t> goal_met;  ///< trials that meet the goal; empty of machines, and without a goal
  std::vector<layout::PointColumn> statistics;
};

/// A results file, part or shard, open to be read: the description of the study, the tables by design point
/// and machine, and what it keeps of its trials. Every function may find that the file is damaged, and throws
/// Failure (bad_data) then. Copies share the open file. One thread at a time uses them all.
class ResultsFile {
 public:
  /// Checks checksum trailer, format, version, completion mark, completeness as required, and the numbers of
  /// the rows (see validation.hpp). Reads the file once from beginning to end.
  /// @param table the measures that its moves may have; stays as long as this. Null: those of this program
  /// with the error bands of the file.
  /// @param study of a shard, if it is known, which stays as long as this: its manifest is not parsed then
  /// @throws ForeignFile for another format or a newer version; Failure: bad_input where there is no such
  /// file, machine_failed where it cannot be read, otherwise bad_data.
  explicit ResultsFile(const std::filesystem::path& path, Require require = Require::complete,
                       const layout::MeasureTable* table = nullptr, const study::Study* study = nullptr);

  const std::filesystem::path& path() const { return path_; }
  const layout::FileHeader& header() const { return *header_; }
  /// The study whose trials the file holds, without the user's controller (see layout::recorded_study). Its
  /// manifest is parsed by the first call.
  const study::Study& study() const;
  /// For groups that this class does not know. Not of a shard.
  const hdf5::Group& root() const { return opened_->file.value(); }
  layout::RowRange rows() const { return header().rows; }

  /// Empty in a shard, like axes, statistics and their tables. Statistics are also empty of a file that is
  /// shown as the study of one condition (AllTrialsFile::under_condition).
  std::vector<std::string> point_labels() const;
  std::vector<study::SweepAxis> axes() const;
  std::vector<layout::PointColumn> statistics() const;
  std::vector<layout::StatisticTable> statistic_tables() const;

  bool has_profiles() const { return contains("profile"); }
  std::vector<StoredProfile> profiles() const;

  /// Nothing in a study without such groups, and in a shard. @param name of a grouping: "machine"
  std::optional<StoredGroups> groups(std::string_view name) const;

  /// Nothing with `keep: statistics`.
  const std::optional<TrialTables>& trials() const { return opened_->trials; }

  /// The point of the first trial. The others follow it.
  std::int64_t first_point() const { return rows().first / header().trials; }
  std::int64_t points() const { return (rows().end() - 1) / header().trials - first_point() + 1; }
  layout::RowRange rows_of(std::int64_t point) const;  ///< those in the file
  /// The sums of a point. @param index of the point, from first_point() on
  /// @throws ForeignFile if the file has no sums, because it keeps every trial
  layout::PointSums sums(std::int64_t index) const;

 protected:
  /// Shows the file as one of this study, a part of its own, with all trials.
  void show_study(study::Study study);

 private:
  /// The sums that a file or a shard has.
  struct StoredSums {
    StoredSums(const std::function<layout::TableReader(const layout::Table&)>& open, std::int64_t points);

    layout::TableReader whole;
    layout::TableReader real;
    std::vector<std::int64_t> whole_begin, real_begin;  ///< [point] its first number; one more for the end
  };

  /// What is open of the file.
  struct Opened {
    std::optional<ShardFile> shard;  ///< if it is one
    std::optional<hdf5::File> file;  ///< otherwise
    std::optional<TrialTables> trials;
    std::optional<StoredSums> sums;
  };

  const hdf5::File& file() const { return opened_->file.value(); }
  bool contains(const std::string& name) const { return opened_->file && file().contains(name); }

  std::filesystem::path path_;
  std::shared_ptr<const Opened> opened_;
  std::shared_ptr<const layout::FileHeader> header_;
  mutable std::shared_ptr<const study::Study> study_;
  bool shows_part_{false};  ///< study_ is not the whole study of the file
};

}  // namespace zerocount::reading
