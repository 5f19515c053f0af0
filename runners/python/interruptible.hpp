#pragma once

#include <functional>
#include <stop_token>

namespace zerocount::python {

/// Does work without the lock of the interpreter (GIL), on a thread of its own, while this one answers
/// signals: a handler that raises, such as that of Ctrl-C, asks the work to stop, and its exception is raised
/// once it has. Exceptions of the work are raised here.
void interruptible(const std::function<void(const std::stop_token&)>& work);

}  // namespace zerocount::python
