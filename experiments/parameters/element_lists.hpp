#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/parameters.hpp"

namespace zerocount::parameters {

/// One form that an element of a list in a manifest can have, such as a notch among the filters. With a name,
/// the element is a map with a single key, this name, and its value is a map of `keys`. Without a name, the
/// element itself is a map of `keys`.
struct ElementForm {
  /// Name of the form, the only key of such an element; empty: the element has no name.
  std::string_view name;
  /// Keys, each with a row "list.#.key" in the table of parameters. A key is required if its row has no
  /// default.
  std::vector<std::string_view> keys;
  std::string_view meaning;
};

/// A manifest key whose value is a list of maps, such as controller.filters. Each map has one of several
/// forms. The values in the maps are parameters: "controller.filters.0.frequency". The form of an element is
/// the same in all trials.
struct ElementList {
  std::string_view path;
  std::string_view element;  ///< noun for one element in messages, such as "filter"
  std::size_t max_elements{0};
  std::span<const ElementForm> forms;
  /// Appends an element with this form to the trial's parameters.
  void (*add)(trial::TrialParameters&, std::size_t form){nullptr};
};

/// All keys of a manifest whose value is a list of maps, such as controller.filters.
std::span<const ElementList> element_lists();

/// The description of the list of maps with this dotted path, or null.
const ElementList* find_element_list(std::string_view path);

/// The dotted path with # for every index: "controller.filters.#.frequency".
std::string without_indices(std::string_view path);

ElementList ripple_list();          ///< The list of torque ripples on the motor, disturbance.ripple.
ElementList vibration_list();       ///< The list of vibrations on the motor, disturbance.vibration.
ElementList load_ripple_list();     ///< The list of torque ripples on the load, disturbance.load.ripple.
ElementList load_vibration_list();  ///< The list of vibrations on the load, disturbance.load.vibration.
/// The list of kinematic errors of the coupling to the load, plant.load.error.
ElementList kinematic_error_list();

/// Whether elements of the list may be given as a power spectral density ({spectrum: …}). A spectrum is not a
/// parameter.
inline bool has_spectra(const ElementList& list) {
  return list.path == "disturbance.vibration" || list.path == "disturbance.load.vibration";
}

}  // namespace zerocount::parameters
