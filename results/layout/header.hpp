#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/failure/failure.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "experiments/study/sampling.hpp"
#include "experiments/study/study.hpp"
#include "results/hdf5/hdf5.hpp"
#include "results/layout/layout.hpp"

namespace zerocount::layout {

/// Origin of a results file: the program, the computer and the time.
struct Provenance {
  std::string zerocount_version;
  std::string git_commit;  ///< Commit of the sources; "unknown" if they were not a git checkout
  std::string compiler;
  std::string cpu;
  std::string created;  ///< Time of creation in UTC, such as 2002-07-21T12:00:00Z
};

/// The provenance of a file that this program writes now on this computer.
Provenance current_provenance();

/// Whether two programs run the same trials, because they have the same version and commit. Uncommitted
/// changes ("-dirty") are ignored, because they cannot be distinguished.
bool same_build(const Provenance& one, const Provenance& other);

/// Whether the program's sources had changes that were not committed to git.
bool is_dirty(const Provenance& provenance);

enum class FileKind {
  study,
  shard,
  rare  ///< A file of the command `zerocount rare`; it has no trials of the study.
};

/// Whether files of a study with this value of the key `keep` have tables of trials, either of every trial or
/// of the failed trials.
bool has_trials(study::Retention retention);
/// Whether files of a study with this value of the key `keep` have the tables /sums, sums over trials from
/// which the statistics of the design points follow. Exactly the files that do not keep every trial have
/// them.
bool has_sums(study::Retention retention);

/// Description of a results file: the attributes of its root, and the manifest (the study's input file).
struct FileHeader {
  FileKind kind{FileKind::study};
  study::Retention retention{study::Retention::trials};
  std::string name;
  Provenance provenance;
  study::Engine engine{study::Engine::reference};  ///< Engine that ran the trials, the scalar reference or
                                                   /// < the batch engine
  std::uint64_t seed{0};
  std::int64_t trials{0};  ///< Number of trials per design point
  std::int64_t points{0};
  RowRange rows;         ///< Trials in this file, by global row (point·trials + index)
  bool complete{false};  ///< Whether the file holds all trials of the study
  bool finished{false};  ///< Whether everything that the file should hold was written
  std::string manifest;  ///< Exact text of the manifest, the study's input file
  std::vector<std::string> overrides;
  std::string manifest_sha256;
  std::string study_sha256;
  std::optional<plugin::PluginDescription> plugin;  ///< The user's controller plugin; empty if the study has
                                                    /// < none
  std::optional<std::string> samples;  ///< Exact text of the table from which correlated parameters are drawn
                                       /// < jointly; empty if there is none
};

/// Error for a file that is valid as far as it was read, but unfit for this use: another format or version,
/// or trials of another study or by another build of the program. Its exit code is bad_data.
class ForeignFile : public Failure {
 public:
  /// @param what_it_is completes the error message "PATH: ".
  ForeignFile(const std::filesystem::path& path, const std::string& what_it_is);
};

/// Error for a file of the command `zerocount rare` where a file with trials of a study is expected.
class RareFile : public ForeignFile {
 public:
  explicit RareFile(const std::filesystem::path& path);
};

/// Checks that the file `path` keeps every trial.
/// @throws ForeignFile otherwise.
void require_every_trial(const std::filesystem::path& path, const FileHeader& header);

/// Name of the engine in files and messages: "batch" or "reference".
std::string_view name_of(study::Engine engine);

/// The range of all trials of a study, by global row.
RowRange all_rows(const study::Study& study);

FileHeader make_header(const study::Study& study, FileKind kind, RowRange rows, Provenance provenance);

/// Writes the header of a results file, without the mark that the file is finished.
void write_header(hdf5::File& file, const FileHeader& header);
void mark_finished(hdf5::File& file);

/// Creates a dataset in the file's root that holds one text; `meaning` is its description.
void write_single_text(hdf5::File& file, const std::string& name, const std::string& text,
                       const std::string& meaning);
/// Reads a text that write_single_text() wrote; empty if there is no such dataset.
/// @throws Failure (bad_data) if it is damaged.
std::optional<std::string> read_single_text(const hdf5::File& file, const std::string& name);

/// Reads the header of a results file, and checks the format, its version and the checksum of the manifest.
/// @throws RareFile for a file of `zerocount rare`; ForeignFile for another format or version; Failure
/// (bad_data) for damage.
FileHeader read_header(const hdf5::File& file);
/// Reads the header of a file of `zerocount rare`.
/// @throws ForeignFile for any other file, Failure (bad_data) for damage.
FileHeader read_rare_header(const hdf5::File& file);
/// Whether the file is one of the command `zerocount rare`.
/// @throws ForeignFile for a format that is not zerocount's
bool is_rare(const hdf5::File& file);

/// The study whose trials the file `path` holds: its manifest with its overrides, and its engine. All code
/// that needs the study of a results file gets it from here.
/// @param plugin the user's controller; null: as recorded, so that no trials can be run
/// @throws Failure (bad_input) as parse_study does, (bad_data) if the file has other numbers of design points
/// or trials than its manifest; see also require_same_plugin.
study::Study recorded_study(const FileHeader& header, const std::filesystem::path& path,
                            std::shared_ptr<const plugin::ControllerPlugin> plugin = nullptr);

/// Checks that the trials of the file were run with this user's controller.
/// @throws ForeignFile otherwise.
/// @param plugin the controller; null: none
void require_same_plugin(const std::filesystem::path& path, const FileHeader& header,
                         const plugin::ControllerPlugin* plugin);

/// Checks that the header of the file `path` describes this study, run by this build of the program (see
/// same_build()) with the study's engine.
/// @throws ForeignFile otherwise.
void require_same_study(const std::filesystem::path& path, const FileHeader& header,
                        const study::Study& study);

/// The folder in which a run that makes the results file `output` collects its shards (finished trials):
/// OUTPUT.shards.
std::filesystem::path shards_directory(const std::filesystem::path& output);

/// Whether the header's numbers are possible: a study can have these numbers of design points and trials, and
/// a file of it these rows.
bool has_possible_numbers(const FileHeader& header);

/// Whether a file is opened only if it has its checksum trailer (see file_contents.hpp), or also before it
/// has got one.
enum class Checksum { required, not_yet };

/// Opens an HDF5 file of this program's format for reading. If its checksum is not checked, a child process
/// reads it first, because a damaged file can crash the HDF5 library (see open_foreign()).
/// @throws Failure: bad_input if there is no such file, machine_failed if it cannot be read, bad_data if it
/// is damaged or something else.
hdf5::File open_results(const std::filesystem::path& path, Checksum checksum = Checksum::required);

/// Describes the user's controller as JSON for a results file: {"name", "version", "sha256", "parameters":
/// [{"name", "unit", "meaning", "default", "lowest", "highest"}]}. A lowest or highest value of null means
/// that there is no limit.
std::string plugin_as_json(const plugin::PluginDescription& plugin);

/// Reads the description of the user's controller that plugin_as_json() made; empty if the text does not
/// describe a plugin.
std::optional<plugin::PluginDescription> plugin_from_json(const std::string& text);

}  // namespace zerocount::layout
