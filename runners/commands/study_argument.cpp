#include "runners/commands/study_argument.hpp"

#include <string>

#include "experiments/manifest/load_study.hpp"
#include "experiments/sections/joint_draws.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/hdf5/array_file.hpp"
#include "results/layout/header.hpp"
#include "results/shards/shard.hpp"
#include "runners/command_line/output_place.hpp"
#include "runners/plugins/plugin_library.hpp"

namespace zerocount::commands {

namespace fs = std::filesystem;

bool is_results_file(const fs::path& path) {
  if (path.extension() == ".h5") return true;
  return !yaml::is_stream(path) && hdf5::is_hdf5_with_user_block(path);
}

study::Study described_study(const fs::path& path) {
  return layout::recorded_study(shards::inspect_header(path, layout::Checksum::not_yet), path);
}

study::Study load_study(const fs::path& manifest, const command_line::Arguments& arguments,
                        std::span<const fs::path> outputs) {
  const fs::path folder = yaml::is_stream(manifest) ? fs::path() : manifest.parent_path();
  const auto input = [&](const fs::path& path) {
    for (const fs::path& output : outputs) command_line::require_no_input(arguments, output, {&path, 1});
    return path;
  };
  const auto load_plugin = [&](const std::string& path) {
    return plugins::load_plugin(input(folder / path));
  };
  const auto read_samples = [&](const std::string& path) {
    return yaml::read_text(input(folder / path), sections::max_samples_size, "a table of samples");
  };
  return manifest::load_study(input(manifest), arguments.values("set"),
                              {.plugin = load_plugin, .samples = read_samples});
}

}  // namespace zerocount::commands
