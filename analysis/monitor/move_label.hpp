#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace zerocount::monitor {

/// What tells a move from others beside its measures.
struct MoveLabel {
  std::optional<std::int64_t> number{};  ///< in the sequence of a trial
  std::optional<double> target{};        ///< counts, or in SI
  int direction{0};                      ///< of the target less the one before; 0: not known
};

/// The labels of the moves of a log, or of a simulated study.
struct MoveLabels {
  bool numbered{false};            ///< whether moves have numbers
  bool targeted{false};            ///< whether moves have targets
  std::string target_unit{};       ///< empty: not stated
  double count{0.0};               ///< size of a count in `si_unit`; 0: not known, as of a log
  std::string si_unit{};           ///< of the axis, where `count` is known
  std::vector<MoveLabel> moves{};  ///< [move]; empty where moves have no labels

  MoveLabel of(std::size_t move) const { return moves.empty() ? MoveLabel{} : moves[move]; }
};

}  // namespace zerocount::monitor
