#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/record/experiment_design/expected_widths.hpp"
#include "analysis/record/experiment_design/torque_protocol.hpp"

namespace zerocount::experiment_design {

/// The search problem: find the protocol with the smallest mean of log_spread() over some machines, among
/// those that are safe on all. The expectation over the prior, in place of the spread at one guess, is the
/// average-optimal (ED-optimal) design: Pronzato, "Optimal experimental design and some related control
/// problems", Automatica 44 (2008) 303, section 6; the information matrix of a dynamic experiment: Goodwin &
/// Payne, Dynamic System Identification, 1977, chapter 6, and Ljung, System Identification, 1999, chapter 13.
struct SearchProblem {
  ProtocolFrame frame;
  std::span<const Machine> machines;  ///< Machines on all of which a protocol must be safe.
  /// Number of machines, from the first one on, over which the search criterion is averaged.
  std::size_t judging{4};
  double max_travel{0.0};  ///< Largest |angle| that a safe protocol may cause, rad; infinite: no limit.
};

struct SearchSettings {
  int max_protocols{80};
  /// Function that is called before each protocol with the number of protocols already examined. The search
  /// ends if it returns false. May be empty: the search is not interrupted.
  std::function<bool(int)> go_on{};
};

/// A protocol shape with the value of the search criterion; smaller is better.
struct JudgedShape {
  ProtocolShape shape;
  double spread{0.0};
};

struct SearchResult {
  /// The first safe shape, followed by each better one; the last element is the best.
  std::vector<JudgedShape> improvements;
  int protocols{0};  ///< Number of protocols that were examined.
  /// True if no change of a single property of the best shape is better; false if the search was stopped
  /// before.
  bool converged{false};
};

/// Searches the best safe protocol by coordinate exchange (Meyer & Nachtsheim, Technometrics 37 (1995) 60):
/// one property of the shape after the other goes to the next value on its grid, as long as that is better.
/// @throws Failure (bad_input) with the last reason if even the smallest protocol is not safe.
SearchResult search_protocol(const SearchProblem& problem, const SearchSettings& settings);

/// Result of the check whether a protocol is safe on all machines.
struct Safety {
  std::string danger{};  ///< Reason why the protocol is not safe; empty if it is safe.
  double travel{0.0};    ///< Largest |angle| on any machine under the protocol, rad.
};

Safety safety_of(const SearchProblem& problem, const TorqueProtocol& protocol);

}  // namespace zerocount::experiment_design
