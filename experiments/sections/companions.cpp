#include "experiments/sections/companions.hpp"

#include <utility>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/study/plan.hpp"
#include "experiments/study/study.hpp"

namespace zerocount::sections {

Companions known_companions(std::shared_ptr<const plugin::ControllerPlugin> plugin,
                            std::optional<std::string> samples) {
  return {.plugin = known_plugin(std::move(plugin)),
          .samples = [samples = std::move(samples)](const std::string& path, std::string_view) {
            if (samples) return *samples;
            throw Failure(ExitCode::bad_data,
                          fmt::format("{}: this table of samples was not recorded", path));
          }};
}

Companions companions_of(const study::Study& study) {
  std::optional<std::string> samples;
  if (study.samples) samples = study.samples->text;
  Companions companions = known_companions(study.plugin, std::move(samples));
  companions.rotors = study.plan->profiles;
  return companions;
}

}  // namespace zerocount::sections
