#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"

/// Stability margins of the linear loops of many machines. Besides the draws of the study, machines differ by
/// the spread of the margins (study::LoopSpread).
namespace zerocount::tuning {

/// The loop with the smallest value of a margin.
struct CriticalLoop {
  std::string name;  ///< TrialLoop::name: "before sliding", "while sliding, the load stands", …
  /// Stiffness of the contact before it slides, N m/rad; nothing if it has no spring.
  std::optional<double> stiffness{};
  /// Number of the draw that made the machine; nothing if the stiffness describes the machine completely.
  std::optional<std::int64_t> machine{};
  std::int64_t setting{0};
};

/// Worst value of a margin, and its loop. Without a loop that limits the margin, there is no loop.
struct Smallest {
  double value{std::numeric_limits<double>::infinity()};
  std::optional<CriticalLoop> loop{};
};

/// Smallest margins over the loops of all examined machines. A margin that no loop limits is infinite.
struct SmallestMargins {
  bool stable{true};  ///< Whether no loop is unstable over the hold of a move.
  Smallest gain{};    ///< Gain margin, dB.
  Smallest phase{};   ///< Phase margin, degrees.
  /// Delay margin, samples: growth of the delay until a loop is unstable, at most max_delay.
  Smallest delay{max_delay};
  Smallest sensitivity{0.0};                ///< Largest |S|, with S = 1/(1 + L).
  double crossover{0.0};                    ///< Highest frequency at which |L| = 1, Hz; 0 without one.
  std::int64_t machines{0};                 ///< Number of examined machines in each setting.
  bool before_sliding{false};               ///< Whether loops before sliding were examined.
  bool sliding{false};                      ///< Whether loops of sliding machines were examined.
  study::LoopSpread spread{};               ///< Spread of the machines in addition to the study's draws.
  std::vector<SmallestMargins> settings{};  ///< [setting] Smallest margins; empty without settings.

  static constexpr double max_delay = 10.0;
};

/// Whether all loops are stable and all wanted margins are kept.
bool keeps(const SmallestMargins& margins, const study::LoopMargins& wanted);

/// A machine in a setting, and the range of its contact stiffness. It may represent all machines that
/// differ only in stiffness.
struct ExaminedMachine {
  std::int64_t trial;
  std::int64_t setting;
  /// Number of the draw of the trial; nothing if the machine represents all that differ only in stiffness.
  std::optional<std::int64_t> draw;
  study::LoopSpread spread;
  /// Smallest stiffness of the contact before it slides, N m/rad. Only for friction with a spring of k1 and
  /// k2.
  double softest;
  double stiffest;  ///< Largest stiffness of the contact before it slides, N m/rad.
};

/// Subject of an examination: parameters of a machine's trial, with the gains of a candidate.
struct Examination {
  trial::TrialParameters p;
  const ExaminedMachine& machine;
  bool slides;
};

/// Examines whether the linear loops of the machines keep margins in every setting.
///
/// The contact before sliding is examined over its range of stiffness: from k1 to k1 + k2 over the friction
/// profile of the machine, or at the stiffness of its bristles. The sliding contact is examined if machines
/// slide or if friction has no stiffness. Each contact is examined in every state of a load
/// (theory::load_states). Each machine also represents the machines that differ from it by the spread of the
/// margins.
class LoopExaminer {
 public:
  /// Draws the machines. Machines that differ only in the stiffness of their spring are examined as one
  /// machine with the range of all. Of machines that differ otherwise, the first 100 are examined.
  /// @param study its first draws are the machines; its friction must not depend on free parameters
  /// @param machines number of these draws
  LoopExaminer(const study::Study& study, std::int64_t machines);

  /// Whether the loops have no transfer function, because a plugin controls. Then nothing is examined, and
  /// all margins count as kept.
  bool is_blind() const { return machines_.empty(); }

  /// Whether the machines that were critical so far keep the margins.
  /// @param slides whether machines of the candidate slide
  bool may_keep(const study::Study& candidate, const study::LoopMargins& margins, bool slides) const;
  /// Distance of the critical machines from keeping the margins. 0: they keep the margins. Below 1: largest
  /// missing fraction of a margin. From 1 on: a loop is unstable, and the value rises with its growth rate.
  double shortfall(const study::Study& candidate, const study::LoopMargins& margins, bool slides) const;
  /// Whether all machines keep the margins. A machine that does not counts as critical from then on.
  /// @throws trial::Interrupted
  bool keeps(const study::Study& candidate, const study::LoopMargins& margins, bool slides,
             const std::stop_token& stop = {});

  /// Smallest margins of all examined machines.
  /// @throws trial::Interrupted
  SmallestMargins margins_of(const study::Study& candidate, bool slides,
                             const std::stop_token& stop = {}) const;

  /// Lowest frequency of a load mode (theory::with_load_mode) that the critical machines bear, Hz. A mode at
  /// this or, in steps of 5 %, any higher frequency up to half the sample rate makes no loop unstable.
  /// Frequencies below 1 Hz are not tried. Nothing if the study has a load behind a coupling, or if a mode at
  /// half the sample rate makes a loop unstable.
  /// @throws trial::Interrupted
  std::optional<double> lowest_mode(const study::Study& candidate, bool slides,
                                    const std::stop_token& stop = {}) const;

 private:
  /// A machine at one of the corners of its spread. `corner` is an index in corners_of().
  struct Corner {
    std::size_t machine;
    std::size_t corner;
    bool operator==(const Corner&) const = default;
  };

  /// Corners to examine: all corners of a machine that represents all machines, but only the likely worst
  /// corners of machines that differ in more than stiffness.
  std::vector<Corner> examined_corners() const;
  Examination at(const Corner& corner, const study::Study& candidate, bool slides) const;

  /// Adds the likely worst corners of the machine to the critical ones, unless they are there already.
  void add_critical(std::size_t machine);

  std::vector<ExaminedMachine> machines_;
  std::int64_t examined_{0};  ///< Number of machines that machines_ represent, in each setting.
  std::int64_t settings_{0};  ///< Number of settings; 0: the study has none.
  std::vector<Corner> critical_;
};

}  // namespace zerocount::tuning
