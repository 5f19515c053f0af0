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

/// Requirement on the completeness of a results file when it is opened.
enum class Require {
  complete,   ///< The file must hold every trial of its study, as statistics need it.
  any_part,   ///< The file may also be a part of a study, or a shard (finished trials of a run that has not
              /// < ended).
  unfinished  ///< Any of these, even if this process is still making the file or has checked it already. The
              /// < checksum is not read.
};

/// A profile of a friction parameter along the axis, as it is tabulated in a results file.
struct StoredProfile {
  std::string name;
  std::string unit;
  std::vector<double> theta;  ///< Angles at which the profile is tabulated, rad
  std::vector<double> value;  ///< Values in `unit`, [theta]; for rotors of machines [machine][theta],
                              /// < flattened
  /// Number of machines, each with a rotor of its own; 0: one rotor for all trials
  std::int64_t machines{0};
  std::string theta_unit{"rad"};
};

/// The groups of a grouping (layout::groupings) in a results file: its machines, worlds (one draw of what all
/// machines share), conditions or ages. Counts and statistics are [point][group], flattened, and empty in a
/// part.
struct StoredGroups {
  std::int64_t count{0};
  std::vector<study::InputColumn> columns;  ///< Input parameters that are drawn once for each group
  std::vector<std::vector<double>> inputs;  ///< Values of these input parameters, [column][group]
  std::vector<std::string> names;           ///< Names of the groups, [group]; empty if the groups have only
                                            /// < numbers
  std::vector<double> values;               ///< Ages, [group]; empty for other groupings
  std::string unit;                         ///< Unit of the ages in `values`
  std::vector<std::int64_t> success;        ///< Number of trials that succeeded, [point][group], flattened
  std::vector<std::int64_t> trials;         ///< Number of trials that were judged, [point][group], flattened
  std::vector<std::int64_t> goal_met;  ///< Number of trials that meet the goal, [point][group], flattened;
                                       /// < empty for machines, and without a goal
  std::vector<layout::PointColumn> statistics;
};

/// A results file, a part of a study, or a shard, open to be read: the description of the study, the tables
/// by design point and machine, and the trials that it keeps. Every function throws Failure (bad_data) if it
/// finds that the file is damaged. Copies share the open file; only one thread may use them at a time.
class ResultsFile {
 public:
  /// Opens a file. Checks checksum trailer, format, version, completion mark, completeness as required, and
  /// the numbers of the rows (see validation.hpp). Reads the file once from beginning to end.
  /// @param table measures that the moves may have; must live as long as this object. Null: the measures of
  /// this program with the error bands of the file.
  /// @param study study of a shard, if it is known; must live as long as this object. Its manifest is then
  /// not parsed.
  /// @throws ForeignFile for another format or a newer version; Failure: bad_input if there is no such file,
  /// machine_failed if it cannot be read, otherwise bad_data.
  explicit ResultsFile(const std::filesystem::path& path, Require require = Require::complete,
                       const layout::MeasureTable* table = nullptr, const study::Study* study = nullptr);

  const std::filesystem::path& path() const { return path_; }
  const layout::FileHeader& header() const { return *header_; }
  /// The study whose trials the file holds, without the user's controller (see layout::recorded_study). Its
  /// manifest is parsed by the first call.
  const study::Study& study() const;
  /// Root group of the HDF5 file, to read groups that this class does not know. Not for a shard, which is not
  /// HDF5.
  const hdf5::Group& root() const { return opened_->file.value(); }
  layout::RowRange rows() const { return header().rows; }

  /// Labels of the design points. A shard has no labels, axes, statistics or tables of statistics. A file
  /// that is shown as the study of one setting, a condition at an age (AllTrialsFile::in_setting), has no
  /// statistics either.
  std::vector<std::string> point_labels() const;
  std::vector<study::SweepAxis> axes() const;
  std::vector<layout::PointColumn> statistics() const;
  std::vector<layout::StatisticTable> statistic_tables() const;

  bool has_profiles() const { return contains("profile"); }
  std::vector<StoredProfile> profiles() const;

  /// The groups of a grouping of the trials; empty in a shard, and in a study without such groups.
  /// @param name name of the grouping, such as "machine".
  std::optional<StoredGroups> groups(std::string_view name) const;

  /// The trials that the file keeps; empty in a study with `keep: statistics`.
  const std::optional<TrialTables>& trials() const { return opened_->trials; }

  /// Index of the design point to which the first trial in the file belongs. The other points of the file
  /// follow it.
  std::int64_t first_point() const { return rows().first / header().trials; }
  std::int64_t points() const { return (rows().end() - 1) / header().trials - first_point() + 1; }
  layout::RowRange rows_of(std::int64_t point) const;  ///< Rows of the design point's trials that are in the
                                                       /// < file
  /// The sums over the trials of one design point.
  /// @param index index of the point, counted from first_point().
  /// @throws ForeignFile if the file has no sums, because it keeps every trial
  layout::PointSums sums(std::int64_t index) const;

 protected:
  /// Lets this object present the file as a file of `study`, which is a part of the file's study, with all of
  /// its trials.
  void show_study(study::Study study);

 private:
  /// The tables /sums of a file or a shard: the sums over the trials of each design point.
  struct StoredSums {
    StoredSums(const std::function<layout::TableReader(const layout::Table&)>& open, std::int64_t points);

    layout::TableReader whole;
    layout::TableReader real;
    /// Index of the first whole and the first real number of each design point, [point], followed by the end
    std::vector<std::int64_t> whole_begin, real_begin;
  };

  /// The open parts of the file: a shard or an HDF5 file, and their tables.
  struct Opened {
    std::optional<ShardFile> shard;  ///< The open shard; empty if the file is not a shard
    std::optional<hdf5::File> file;  ///< The open HDF5 file; empty if the file is a shard
    std::optional<TrialTables> trials;
    std::optional<StoredSums> sums;
  };

  const hdf5::File& file() const { return opened_->file.value(); }
  bool contains(const std::string& name) const { return opened_->file && file().contains(name); }

  std::filesystem::path path_;
  std::shared_ptr<const Opened> opened_;
  std::shared_ptr<const layout::FileHeader> header_;
  mutable std::shared_ptr<const study::Study> study_;
  bool shows_part_{false};  ///< Whether study_ is only a part of the study in the file
};

}  // namespace zerocount::reading
