#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/trial/parameters.hpp"

namespace zerocount::parameters {

/// One form that an element of a list can have. With a name, the element is a map with a single key, this
/// name, and its value is a map of `keys`. Without a name, the element itself is a map of `keys`.
struct ElementForm {
  std::string_view name;  ///< name of the form; may be empty
  /// Keys, each with a row "list.#.key" in the table of parameters. A key is required if its row has no
  /// default.
  std::vector<std::string_view> keys;
  std::string_view meaning;
};

/// A key whose value is a list of maps, such as controller.filters. Each map has one of several forms. The
/// values in the maps are parameters: "controller.filters.0.frequency". The form of an element is the same in
/// all trials.
struct ElementList {
  std::string_view path;
  std::string_view element;  ///< noun for one element
  std::size_t max_elements{0};
  std::span<const ElementForm> forms;
  void (*add)(trial::TrialParameters&, std::size_t form){nullptr};  ///< appends an element of this form
};

/// All keys whose value is a list of elements.
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

/// Whether elements of the list may be spectra. A spectrum is not a parameter.
inline bool has_spectra(const ElementList& list) {
  return list.path == "disturbance.vibration" || list.path == "disturbance.load.vibration";
}

}  // namespace zerocount::parameters
