#pragma once

namespace zerocount::python {

/// Makes a Failure of the program an exception of the package (zerocount/errors.py), by its exit code.
void register_failures();

}  // namespace zerocount::python
