#include "runners/commands/study_argument.hpp"

#include <string>

#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest/samples.hpp"
#include "experiments/yaml/text_file.hpp"
#include "runners/plugins/plugin_library.hpp"

namespace zerocount::commands {

study::Study load_study(const std::filesystem::path& manifest, const command_line::Arguments& arguments) {
  const std::filesystem::path folder =
      yaml::is_standard_stream(manifest) ? std::filesystem::path() : manifest.parent_path();
  const auto read_samples = [&](const std::string& path) {
    return yaml::read_text(folder / path, manifest::max_samples_size, "a table of samples");
  };
  return manifest::load_study(manifest, arguments.values("set"),
                              {.plugin = plugins::plugins_from(folder), .samples = read_samples});
}

}  // namespace zerocount::commands
