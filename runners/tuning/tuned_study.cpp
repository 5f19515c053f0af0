#include "runners/tuning/tuned_study.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <string_view>

#include "experiments/manifest/edited_text.hpp"
#include "experiments/manifest/load_study.hpp"

namespace zerocount::tuning {
namespace {

std::string_view key_of(std::string_view entry) {
  return entry.substr(0, entry.find('='));
}

/// The entries, the last of each key.
std::vector<std::string> last_of_each(const std::vector<std::string>& entries) {
  std::vector<std::string> kept;
  for (auto one = entries.begin(); one != entries.end(); ++one) {
    const auto again = [one](const std::string& later) { return key_of(later) == key_of(*one); };
    if (std::none_of(one + 1, entries.end(), again)) kept.push_back(*one);
  }
  return kept;
}

}  // namespace

study::Study with_values_in_text(const study::Study& study, const std::vector<std::string>& values) {
  std::vector<std::string> all = study.overrides;
  all.insert(all.end(), values.begin(), values.end());
  std::string text = study.manifest_text;
  std::vector<std::string> overrides;
  for (const std::string& one : last_of_each(all)) {
    const std::string_view key = key_of(one);
    const std::optional<std::string> edited =
        manifest::with_override(text, key, std::string_view(one).substr(key.size() + 1));
    if (edited) {
      text = *edited;
    } else {
      overrides.push_back(one);
    }
  }
  study::Study edited = manifest::parse_study(text, study.name, overrides, manifest::companions_of(study));
  edited.engine = study.engine;
  return edited;
}

}  // namespace zerocount::tuning
