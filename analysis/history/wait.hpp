#pragma once

#include <functional>

namespace zerocount::history {

/// How long to wait for another process that holds a database.
struct Wait {
  double seconds{60.0};
  double notice{1.0};              ///< seconds after which `notify` is called, once
  std::function<void()> notify{};  ///< may be empty
};

}  // namespace zerocount::history
