#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/study/study.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/row_range.hpp"

namespace zerocount::reading {

/// How much of its study a file must hold to be opened.
enum class Require {
  complete,   ///< every trial: what statistics may be made of
  any_part,   ///< also a part or a shard
  unfinished  ///< also a file that is still being made
};

/// A profile as it stands in a results file.
struct StoredProfile {
  std::string name;
  std::string unit;
  std::vector<double> theta;  ///< rad
  std::vector<double> value;  ///< in `unit`; of rigs [rig][theta], flattened
  std::int64_t rigs{0};       ///< each with a rotor of its own; 0: one rotor of all trials
  std::string theta_unit{"rad"};
};

/// The rigs of a study as they stand in a results file.
struct StoredRigs {
  std::int64_t rigs{0};
  std::vector<study::InputColumn> columns;  ///< what differs between them
  std::vector<std::vector<double>> inputs;  ///< [column][rig]
  std::vector<std::int64_t> success;        ///< [point][rig], flattened: trials that succeeded
  std::vector<std::int64_t> trials;         ///< likewise: trials that were judged; none of both in a part
};

/// What all results files have: the description of the study and the tables by design point and rig. Every
/// function may find that the file is damaged, and throws Failure (bad_data) then. One thread at a time.
class ResultsFile {
 public:
  const std::filesystem::path& path() const { return path_; }
  const layout::FileHeader& header() const { return header_; }
  const hdf5::Group& root() const { return file_; }  ///< for groups that this class does not know
  layout::RowRange rows() const { return header_.rows; }

  /// Empty in a shard, like axes, statistics and their tables.
  std::vector<std::string> point_labels() const;
  std::vector<study::SweepAxis> axes() const;
  std::vector<layout::PointColumn> statistics() const;
  std::vector<layout::StatisticTable> statistic_tables() const;

  bool has_profiles() const { return file_.contains("profile"); }
  std::vector<StoredProfile> profiles() const;

  /// Nothing in a study without rigs, and in a shard.
  std::optional<StoredRigs> rigs() const;

 protected:
  /// Checks checksum trailer, format, version, completion mark and completeness as required.
  /// @param contents that the derived class reads
  /// @throws as the derived classes do
  ResultsFile(const std::filesystem::path& path, Require require, layout::Contents contents);
  ResultsFile(const std::filesystem::path& path, Require require);  ///< whatever its contents
  ~ResultsFile() = default;
  ResultsFile(ResultsFile&&) = default;
  ResultsFile& operator=(ResultsFile&&) = delete;

  const hdf5::File& file() const { return file_; }

 private:
  std::filesystem::path path_;
  hdf5::File file_;
  layout::FileHeader header_;
};

/// The description of a results file, whatever it keeps.
class DescribedFile : public ResultsFile {
 public:
  /// Reads the file once from beginning to end. @throws as StudyFile does
  explicit DescribedFile(const std::filesystem::path& path, Require require = Require::complete)
      : ResultsFile(path, require) {}
};

}  // namespace zerocount::reading
