#include <algorithm>
#include <array>

#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_rows.hpp"

namespace zerocount::parameters {
namespace {

constexpr std::size_t max_filters = 8;

// Sobol dimensions of one filter. The keys of different forms share them, because a filter has one form.
constexpr std::size_t dimensions_of_filter = 5;

// In the order of loop::FilterKind.
std::span<const ElementForm> filter_forms() {
  static const std::array<ElementForm, 4> forms{{
      {"lowpass", {"frequency", "damping"}, "second-order low-pass filter"},
      {"notch", {"frequency", "damping", "depth"}, "band-stop filter"},
      {"lead", {"frequency", "ratio"}, "lead element, of gain 1 at low frequencies"},
      {"biquad", {"b", "a"}, "(b0 + b1/z + b2/z^2)/(1 + a1/z + a2/z^2)"},
  }};
  return forms;
}

struct Fine {
  static constexpr std::string_view path = "controller.filters";
  static std::vector<loop::Filter>& filters(trial::TrialParameters& p) { return p.controller.blocks.filters; }
};

struct Coarse {
  static constexpr std::string_view path = "controller.coarse.filters";
  static std::vector<loop::Filter>& filters(trial::TrialParameters& p) {
    return p.controller.coarse.blocks.filters;
  }
};

template <class Phase>
void add_filter(trial::TrialParameters& parameters, std::size_t form) {
  Phase::filters(parameters).push_back({.kind = static_cast<loop::FilterKind>(form)});
}

// The row of a number of each filter.
template <class Phase, double loop::Filter::*field>
Parameter number_of_filter(parameter::Handle name, std::size_t dimension, std::string_view unit,
                           std::string_view meaning, const numerics::Interval& range) {
  Parameter row = real_row(name, dimension, unit, meaning, "required", range);
  row.element = {dimensions_of_filter,
                 +[](trial::TrialParameters& parameters, std::size_t filter, std::size_t, double value) {
                   Phase::filters(parameters)[filter].*field = value;
                 }};
  return row;
}

// The row of a list of coefficients of each filter.
template <class Phase, auto field>
Parameter coefficients_of_filter(parameter::Handle name, std::size_t dimension, std::string_view meaning) {
  Parameter row = real_row(name, dimension, "1", meaning, "required", numerics::all_numbers());
  constexpr std::size_t count = std::tuple_size_v<std::remove_reference_t<decltype(loop::Filter{}.*field)>>;
  row.list = {count, count, "coefficient", "coefficients", {}};
  row.element = {dimensions_of_filter,
                 +[](trial::TrialParameters& parameters, std::size_t filter, std::size_t index,
                     double value) { (Phase::filters(parameters)[filter].*field)[index] = value; }};
  return row;
}

// The names are literals, because rows refer to them.
template <class Phase>
std::vector<Parameter> rows_of(const std::array<parameter::Handle, 6>& names, std::size_t dimension) {
  using F = loop::Filter;
  const numerics::Interval positive = numerics::above(0);
  return {
      idealised_by(no_filter,
                   number_of_filter<Phase, &F::frequency>(
                       names[0], dimension, "Hz", "frequency w0/2pi of a lowpass, notch or lead", positive)),
      number_of_filter<Phase, &F::damping>(names[1], dimension + 1, "1",
                                           "damping ratio zeta of a lowpass or notch", positive),
      number_of_filter<Phase, &F::depth>(names[2], dimension + 2, "1",
                                         "gain of a notch at its frequency; 1 switches it off",
                                         numerics::at_least(0)),
      number_of_filter<Phase, &F::ratio>(names[3], dimension + 1, "1",
                                         "ratio of the pole frequency of a lead to its zero frequency",
                                         positive),
      idealised_by(no_filter,
                   coefficients_of_filter<Phase, &F::b>(names[4], dimension, "b0, b1, b2 of a biquad")),
      coefficients_of_filter<Phase, &F::a>(names[5], dimension + 3, "a1, a2 of a biquad"),
  };
}

}  // namespace

std::vector<Parameter> filter_rows() {
  std::vector<Parameter> rows =
      rows_of<Fine>({parameter::controller::filters::frequency, parameter::controller::filters::damping,
                     parameter::controller::filters::depth, parameter::controller::filters::ratio,
                     parameter::controller::filters::b, parameter::controller::filters::a},
                    beyond_moves(112));
  for (Parameter& row : rows_of<Coarse>(
           {parameter::controller::coarse::filters::frequency,
            parameter::controller::coarse::filters::damping, parameter::controller::coarse::filters::depth,
            parameter::controller::coarse::filters::ratio, parameter::controller::coarse::filters::b,
            parameter::controller::coarse::filters::a},
           beyond_moves(112 + max_filters * dimensions_of_filter)))
    rows.push_back(std::move(row));
  return rows;
}

std::span<const ElementList> element_lists() {
  static const std::array<ElementList, 7> lists{{
      {Fine::path, "filter", max_filters, filter_forms(), add_filter<Fine>},
      {Coarse::path, "filter", max_filters, filter_forms(), add_filter<Coarse>},
      ripple_list(),
      vibration_list(),
      load_ripple_list(),
      load_vibration_list(),
      kinematic_error_list(),
  }};
  return lists;
}

const ElementList* find_element_list(std::string_view path) {
  const auto lists = element_lists();
  const auto found =
      std::find_if(lists.begin(), lists.end(), [&](const ElementList& list) { return list.path == path; });
  return found == lists.end() ? nullptr : &*found;
}

std::string without_indices(std::string_view path) {
  std::string pattern;
  while (true) {
    const std::size_t end = std::min(path.find('.'), path.size());
    const std::string_view name = path.substr(0, end);
    const bool index = !name.empty() && name.find_first_not_of("0123456789") == std::string_view::npos;
    pattern += index ? "#" : name;
    if (end == path.size()) return pattern;
    pattern += '.';
    path.remove_prefix(end + 1);
  }
}

}  // namespace zerocount::parameters
