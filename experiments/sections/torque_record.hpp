#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/trial/torque_record.hpp"
#include "experiments/sections/companions.hpp"
#include "experiments/yaml/scalars.hpp"

namespace zerocount::sections {

constexpr std::size_t max_record_rows = 100'000;

/// Reads the key command.torque.file as a list of pairs [time in s, torque in N m (N on a linear axis)]; null
/// after errors, which it reports.
std::shared_ptr<const trial::TorqueRecord> read_torque_record(const yaml::Field& list,
                                                              yaml::Problems& problems);

/// Overrides that put the pairs in place of the file that command.torque.file names, with the first time as
/// 0, and command.hold as long as the record where the manifest gives none. With them a study is whole
/// without the file.
///
/// The file is a table with a header: a column t or time, and torque or drive_torque, on a linear axis also
/// force or drive_force, each with its unit in brackets or else in SI units; other columns are not read. The
/// separator is a comma, a semicolon or a tab; empty lines and those that begin with # are left out.
std::vector<std::string> torque_record_overrides(const yaml::YamlNode& root, const SamplesReader& read,
                                                 yaml::Problems& problems);

}  // namespace zerocount::sections
