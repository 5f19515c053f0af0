#include "experiments/manifest/drawn_per.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace zerocount {
namespace {

struct Misfit {
  std::string_view what;
  std::string_view expected;
};

// Why the parameter cannot be drawn so often, if so.
std::optional<Misfit> misfit_of(Per per, const Parameter& parameter, Drawn drawn, bool has_rigs) {
  switch (per) {
    case Per::study:
      return std::nullopt;
    case Per::rig:
      if (has_rigs) return std::nullopt;
      return Misfit{"the study has no rigs", "the key rigs, or study, trial or contact here"};
    case Per::trial:
      if (drawn == Drawn::value) return std::nullopt;
      return Misfit{"a profile is that of a rotor, which no trial has for itself",
                    "study or rig (a rotor for every trial: rigs, as many as trials)"};
    case Per::contact:
      if (drawn == Drawn::profile) {
        return Misfit{"a profile is that of a rotor, and a contact takes its value where it forms",
                      "study or rig"};
      }
      if (parameter.profiled != nullptr) return std::nullopt;
      return Misfit{"only friction is drawn anew at each contact", "study, rig or trial"};
  }
  return std::nullopt;
}

}  // namespace

std::span<const std::string_view> per_labels() {
  static constexpr std::array<std::string_view, 4> words{"study", "rig", "trial", "contact"};
  return words;
}

Per usual_per(const Parameter& parameter, Drawn drawn, bool has_rigs) {
  if (!has_rigs) return drawn == Drawn::profile ? Per::study : Per::trial;
  return parameter.of_machine ? Per::rig : Per::trial;
}

std::optional<Per> read_per(const Field& field, const Parameter& parameter, Drawn drawn, bool has_rigs,
                            Problems& problems) {
  const YamlNode& node = *field.node;
  const auto words = per_labels();
  const auto word = std::find(words.begin(), words.end(), node.text);
  if (node.kind != YamlNode::Kind::scalar || word == words.end()) {
    problems.add(node.place, field.path, fmt::format("{} is none of its words", in_quotes(flow_text(node))),
                 fmt::format("one of {}", fmt::join(words, ", ")));
    return std::nullopt;
  }
  const auto per = static_cast<Per>(word - words.begin());
  const auto misfit = misfit_of(per, parameter, drawn, has_rigs);
  if (!misfit) return per;
  problems.add(node.place, field.path, std::string(misfit->what), misfit->expected);
  return std::nullopt;
}

}  // namespace zerocount
