#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/disturbance.hpp"
#include "core/trial/torque_record.hpp"
#include "experiments/keys/values.hpp"
#include "experiments/sections/external_inputs.hpp"
#include "experiments/sections/sections.hpp"
#include "experiments/study/sampling.hpp"
#include "experiments/tables/text_table.hpp"
#include "experiments/yaml/scalars.hpp"

/// Tables of numbers in files that a manifest names, and the lists of pairs that may replace them.
namespace zerocount::sections {

/// Reads the table in the file that `field` names. Empty if the text is not a table; this is reported.
/// @param text contents of the file
/// @param expected phrase for the message
std::optional<tables::TextTable> read_table(const yaml::Field& field, std::string text,
                                            std::string_view expected, yaml::Problems& problems);

/// Reads the key command.torque.file as a list of pairs [time in s, torque in N m (N on a linear axis)]; null
/// after errors, which it reports.
std::shared_ptr<const trial::TorqueRecord> read_torque_record(const yaml::Field& list,
                                                              yaml::Problems& problems);

/// Reads the key command.reference.file as a list of pairs [time in s, position in rad (m on a linear axis)];
/// null after errors, which it reports.
std::shared_ptr<const loop::ReferenceRecord> read_reference_record(const yaml::Field& list,
                                                                   yaml::Problems& problems);

/// Whether an element of disturbance.vibration or disturbance.load.vibration is {spectrum: [[frequency,
/// density], …], lines: 100}.
bool is_spectrum(const yaml::Field& element);

/// Reads the spectrum of a vibration, {spectrum: [[frequency, density], …], lines: 100}; null after errors,
/// which it reports.
std::shared_ptr<const trial::SpectrumParameters> read_spectrum(const yaml::Field& element,
                                                               yaml::Problems& problems);

/// Overrides that replace the files of command.torque.file, command.reference.file and spectra by lists of
/// pairs, such as "disturbance.vibration.0.spectrum=[[1, 1e-10], [100, 1e-12]]". With these overrides a study
/// does not need the files.
///
/// The table of a record has a header: a column t or time, and torque or drive_torque, on a linear axis also
/// force or drive_force; of a reference the one that command.reference.column names, else `reference`. Each
/// has its unit in brackets or else is in SI units; the first time becomes 0. Other columns are not read. The
/// table of a spectrum has the columns frequency and density, under any names.
/// @param warnings is given one of each record with gaps in its times (tables::time_gaps()) across which the
/// value changes, of a list of pairs too
std::vector<std::string> table_overrides(const yaml::YamlNode& root, const SamplesReader& read,
                                         yaml::Problems& problems, std::vector<std::string>& warnings);

constexpr std::size_t max_samples_size = std::size_t{1}
                                         << 24;  ///< maximum size of the table of samples, bytes
constexpr std::size_t max_samples = 100'000;     ///< maximum number of rows of the table of samples

/// The table of joint draws that the key `samples` names, with places for messages. It is read before the
/// rest of the manifest.
struct SamplesTable {
  study::JointSamples samples;
  std::string source;                ///< name of the table's file, to which the places in it refer
  yaml::Field field;                 ///< field of the key `samples` in the manifest
  std::vector<yaml::Place> columns;  ///< [column] place of the column's name
};

/// Reads the key `samples` of `root`, "FILE" or {file: FILE, per: machine or trial}, and its table: a header
/// with dotted paths, then one joint draw a row. Each column becomes the value {choice: [...]} of its
/// parameter in `root`, so that it is checked as if the manifest gave it. `table` must outlive the tree.
void insert_samples(yaml::YamlPointer& root, const SamplesReader& read, std::optional<SamplesTable>& table,
                    yaml::Problems& problems);

/// Makes the sampled parameters take their values from one row of the table in each draw: sets
/// plan.sampled_slots and study.samples. The parameters and the sweep must be read already.
void join_samples(const SamplesTable& table, const std::vector<SweptAxis>& axes, keys::StudyDraft& draft);

/// Reads the key `correlation`, a list of entries [first parameter, second parameter, coefficient], into
/// plan.copula and study.correlations. The parameters and the sweep must be read already.
void read_correlations(const yaml::Field& root, keys::StudyDraft& draft);

}  // namespace zerocount::sections
