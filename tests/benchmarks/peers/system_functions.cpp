#include "tests/benchmarks/peers/system_functions.hpp"

#include <stdexcept>
#include <string>

#include <dlfcn.h>

namespace zerocount::testing {
namespace {

/// The function that this program would use if it had none of its own of that name.
template <class Function>
Function system_function(const char* name) {
  void* const address = dlsym(RTLD_NEXT, name);
  if (address == nullptr) throw std::runtime_error(std::string("the C library has no function ") + name);
  return reinterpret_cast<Function>(address);
}

}  // namespace

const SystemFunctions system_functions{system_function<double (*)(double)>("exp"),
                                       system_function<double (*)(double)>("expm1"),
                                       system_function<double (*)(double, double)>("pow")};

}  // namespace zerocount::testing
