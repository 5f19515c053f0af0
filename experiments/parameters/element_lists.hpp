#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/parameters.hpp"

namespace zerocount::parameters {

/// A form of the elements of a list: a map with one key, its name, whose value is a map of these keys, or,
/// without a name, the map of these keys itself.
struct ElementForm {
  std::string_view name;
  /// Each is a row "list.#.key" of the table of parameters, and required if that has no default.
  std::vector<std::string_view> keys;
  std::string_view meaning;
};

/// A key whose value is a list of maps, each of one of several forms: controller.filters. The values in them
/// are parameters: "controller.filters.0.frequency". The forms themselves are the same in all trials.
struct ElementList {
  std::string_view path;
  std::string_view element;  ///< noun for one of them
  std::size_t max_elements{0};
  std::span<const ElementForm> forms;
  void (*add)(trial::TrialParameters&, std::size_t form){nullptr};  ///< appends an element
};

/// All such lists.
std::span<const ElementList> element_lists();

/// The list with this dotted path, or null.
const ElementList* find_element_list(std::string_view path);

/// The dotted path with # for every index: "controller.filters.#.frequency".
std::string without_indices(std::string_view path);

ElementList ripple_list();           ///< disturbance.ripple
ElementList vibration_list();        ///< disturbance.vibration
ElementList load_ripple_list();      ///< disturbance.load.ripple
ElementList load_vibration_list();   ///< disturbance.load.vibration
ElementList kinematic_error_list();  ///< plant.load.error

/// Whether elements of the list may be spectra, which are no parameters.
inline bool has_spectra(const ElementList& list) {
  return list.path == "disturbance.vibration" || list.path == "disturbance.load.vibration";
}

}  // namespace zerocount::parameters
