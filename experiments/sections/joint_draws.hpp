#pragma once

#include <string>
#include <vector>

#include "experiments/keys/values.hpp"
#include "experiments/sections/companions.hpp"
#include "experiments/sections/sweep.hpp"
#include "experiments/study/sampling.hpp"

namespace zerocount::sections {

constexpr std::size_t max_samples_size = std::size_t{1} << 24;  ///< bytes of the table
constexpr std::size_t max_samples = 100'000;                    ///< rows

/// The table of the key `samples`, as it is before the manifest is read.
struct SamplesTable {
  study::JointSamples samples;
  std::string source;                ///< of its places, for messages
  yaml::Field field;                 ///< in the manifest
  std::vector<yaml::Place> columns;  ///< [column] place of its name
};

/// Reads the key `samples` of `root`, "FILE" or {file: FILE, per: rig or trial}, and its table: a header with
/// dotted paths, then one joint draw a row. Each column becomes the value {choice: [...]} of its parameter in
/// `root`, so that it is checked as if the manifest gave it. `table` must outlive the tree.
void insert_samples(yaml::YamlPointer& root, const SamplesReader& read, std::optional<SamplesTable>& table,
                    yaml::Problems& problems);

/// Joins the draws of the columns: plan.sampled_slots and study.samples. Comes after the parameters and the
/// sweep.
void join_samples(const SamplesTable& table, const std::vector<SweptAxis>& axes, keys::Reading& reading);

/// Reads the key `correlation`, a list of entries [first parameter, second parameter, coefficient]:
/// plan.copula and study.correlations. Comes after the parameters and the sweep.
void read_correlations(const yaml::Field& root, keys::Reading& reading);

}  // namespace zerocount::sections
