#include "tests/benchmarks/peers/system_functions.hpp"

#include <stdexcept>
#include <string>

#include <dlfcn.h>

namespace zerocount::testing {
namespace {

/// A function of the C library, in the version that a program is linked with today.
template <class Function>
Function system_function(const char* name) {
  void* const library = dlopen("libm.so.6", RTLD_LAZY);
  void* const address = library != nullptr ? dlsym(library, name) : nullptr;
  if (address == nullptr) throw std::runtime_error(std::string("the C library has no function ") + name);
  return reinterpret_cast<Function>(address);
}

}  // namespace

const SystemFunctions system_functions{system_function<double (*)(double)>("exp"),
                                       system_function<double (*)(double)>("expm1"),
                                       system_function<double (*)(double, double)>("pow")};

}  // namespace zerocount::testing
