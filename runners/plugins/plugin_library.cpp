#include "runners/plugins/plugin_library.hpp"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/hash/sha256.hpp"
#include "core/plugin/arithmetic_mode.hpp"

namespace zerocount::plugins {
namespace {

namespace fs = std::filesystem;
using plugin::PluginFault;

using Entry = const zerocount_controller* (*)();

/// The bytes of a file; nothing if it cannot be read.
std::optional<std::string> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file.is_open() || file.bad()) return std::nullopt;
  return bytes;
}

/// Name of the symbol that the loader's message says is undefined; empty if the message names none.
std::string missing_symbol(const char* message) {
  constexpr std::string_view words = "undefined symbol: ";
  const std::string_view text = message == nullptr ? "" : message;
  const std::size_t place = text.find(words);
  if (place == std::string_view::npos) return {};
  const std::string_view rest = text.substr(place + words.size());
  return std::string(rest.substr(0, rest.find_first_of(", \n")));
}

/// Loads the library and calls the function that returns its controller; a PluginFault if this fails.
/// Libraries compiled with -ffast-math change the processor's mode of arithmetic when they are loaded, so the
/// mode is restored.
std::variant<const zerocount_controller*, PluginFault> entry_of(const fs::path& library) {
  const plugin::ArithmeticMode mode;
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  mode.restore();
  if (handle == nullptr) {
    const std::string missing = missing_symbol(dlerror());
    return PluginFault{
        fmt::format("{} is not a shared library that this program can load{}", library.string(),
                    missing.empty() ? "" : fmt::format(": it calls {}, which no library defines", missing)),
        "a library for this machine, linked with everything that it calls"};
  }
  const auto entry = reinterpret_cast<Entry>(dlsym(handle, "zerocount_controller_entry"));
  if (entry == nullptr) {
    dlclose(handle);
    return PluginFault{fmt::format("{} has no function zerocount_controller_entry", library.string()),
                       "a controller by zerocount/controller.h, its entry exported and extern \"C\""};
  }
  const zerocount_controller* const controller = entry();
  mode.restore();
  return controller;
}

}  // namespace

sections::LoadedPlugin load_plugin(const fs::path& library) {
  std::error_code error;
  if (!fs::exists(library, error))
    return PluginFault{fmt::format("{}: no such file", library.string()), "the path of a shared library"};
  const auto bytes = fs::is_regular_file(library, error) ? bytes_of(library) : std::nullopt;
  if (!bytes) return PluginFault{fmt::format("{} cannot be read", library.string()), "a shared library"};
  // Without a folder in its path, dlopen would look elsewhere.
  const auto entry = entry_of(fs::absolute(library));
  if (const auto* fault = std::get_if<PluginFault>(&entry)) return *fault;
  auto checked =
      plugin::checked_plugin(std::get<const zerocount_controller*>(entry), hash::sha256_hex(*bytes));
  if (auto* fault = std::get_if<PluginFault>(&checked))
    return PluginFault{fmt::format("{}: {}", library.string(), fault->what), fault->expected};
  return std::make_shared<const plugin::ControllerPlugin>(
      std::move(std::get<plugin::ControllerPlugin>(checked)));
}

}  // namespace zerocount::plugins
