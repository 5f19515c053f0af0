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

/// Part of its study that a file must hold to be opened.
enum class Require {
  complete,   ///< Every trial, as statistics need it.
  any_part,   ///< A whole file, a part or a shard.
  unfinished  ///< Any of these, even if this process is still making it or has checked it. The checksum is
              ///< not read.
};

/// A profile as it stands in a results file.
struct StoredProfile {
  std::string name;
  std::string unit;
  std::vector<double> theta;  ///< Angles, rad
  std::vector<double> value;  ///< Values in `unit`; for rotors of machines [machine][theta], flattened
  /// Number of machines, each with a rotor of its own; 0: one rotor for all trials
  std::int64_t machines{0};
  std::string theta_unit{"rad"};
};

/// The groups of a grouping in a results file (layout::groupings): its machines, worlds, settings or ages.
/// Counts and statistics are [point][group], flattened, and empty in a part.
struct StoredGroups {
  std::int64_t count{0};
  std::vector<study::InputColumn> columns;  ///< Inputs that are drawn for each group
  std::vector<std::vector<double>> inputs;  ///< Values of the inputs, [column][group]
  std::vector<std::string> names;           ///< Names of settings, [group]; otherwise empty
  std::vector<double> values;               ///< Ages, [group]; otherwise empty
  std::string unit;                         ///< Unit of `values`
  std::vector<std::int64_t> success;        ///< Trials that succeeded
  std::vector<std::int64_t> trials;         ///< Trials that were judged
  std::vector<std::int64_t> goal_met;  ///< Trials that meet the goal; empty for machines, and without a goal
  std::vector<layout::PointColumn> statistics;
};

/// A results file, part or shard, open to be read: the description of the study, the tables by design point
/// and machine, and what it keeps of its trials. Every function may find that the file is damaged, and throws
/// Failure (bad_data) then. Copies share the open file. One thread at a time uses them all.
class ResultsFile {
 public:
  /// Checks checksum trailer, format, version, completion mark, completeness as required, and the numbers of
  /// the rows (see validation.hpp). Reads the file once from beginning to end.
  /// @param table measures that the moves may have; must live as long as this. Null: the measures of this
  /// program with the error bands of the file.
  /// @param study study of a shard, if it is known; must live as long as this. Its manifest is then not
  /// parsed.
  /// @throws ForeignFile for another format or a newer version; Failure: bad_input if there is no such file,
  /// machine_failed if it cannot be read, otherwise bad_data.
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

  /// Labels of the design points. A shard has no labels, axes, statistics or tables of statistics. A file
  /// that is shown as the study of one setting (AllTrialsFile::in_setting) has no statistics either.
  std::vector<std::string> point_labels() const;
  std::vector<study::SweepAxis> axes() const;
  std::vector<layout::PointColumn> statistics() const;
  std::vector<layout::StatisticTable> statistic_tables() const;

  bool has_profiles() const { return contains("profile"); }
  std::vector<StoredProfile> profiles() const;

  /// The groups of a grouping; empty in a shard, and in a study without such groups. @param name name of the
  /// grouping, such as "machine".
  std::optional<StoredGroups> groups(std::string_view name) const;

  /// Nothing with `keep: statistics`.
  const std::optional<TrialTables>& trials() const { return opened_->trials; }

  /// The design point of the first trial. The other points of the file follow it.
  std::int64_t first_point() const { return rows().first / header().trials; }
  std::int64_t points() const { return (rows().end() - 1) / header().trials - first_point() + 1; }
  layout::RowRange rows_of(std::int64_t point) const;  ///< Rows of the point that are in the file
  /// The sums of a point. @param index index of the point, counted from first_point().
  /// @throws ForeignFile if the file has no sums, because it keeps every trial
  layout::PointSums sums(std::int64_t index) const;

 protected:
  /// Shows the file as a file of `study`, which is a part of the study in the file, with all trials.
  void show_study(study::Study study);

 private:
  /// The tables of sums in a file or a shard.
  struct StoredSums {
    StoredSums(const std::function<layout::TableReader(const layout::Table&)>& open, std::int64_t points);

    layout::TableReader whole;
    layout::TableReader real;
    /// Index of the first number of each point, [point], and of the end
    std::vector<std::int64_t> whole_begin, real_begin;
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
