#include "hal/openni/driver_stage.h"

#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "rt/unique_fd.h"

namespace hal::openni {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLibrary = "libOpenNI2.so.0";
constexpr const char* kRecordings = "libOniFile.so.0";
constexpr const char* kPrefix = "kagami-openni-";

/// Where this machine has OpenNI2.
std::optional<fs::path> libraryPath() {
  void* library = ::dlopen(kLibrary, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr) return std::nullopt;
  std::optional<fs::path> found;
  Dl_info facts{};
  if (::dladdr(::dlsym(library, "oniInitialize"), &facts) != 0 && facts.dli_fname != nullptr) {
    std::error_code failed;
    const fs::path path = fs::canonical(facts.dli_fname, failed);
    if (!failed) found = path;
  }
  ::dlclose(library);
  return found;
}

/// "libastra.so", "libastra.so.0", "libastra.so.0.1" -> "libastra.so.0"; none: not a library.
std::optional<std::string> loadableName(const std::string& name) {
  const std::size_t end = name.find(".so");
  if (!name.starts_with("lib") || end == std::string::npos) return std::nullopt;
  if (end + 3 != name.size() && name[end + 3] != '.') return std::nullopt;
  return name.substr(0, end) + ".so.0";
}

/// Links to all that lies in @p drivers; how many of them OpenNI2 will load.
int linkAll(const fs::path& drivers, const fs::path& stage, std::error_code& failed) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(drivers, failed)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("libOpenNI2.")) continue;  // a vendor's copy of what we run already
    std::error_code there;  // libx.so and libx.so.0 are the same driver: the first one stays
    if (const auto loadable = loadableName(name)) {
      fs::create_symlink(fs::absolute(entry.path()), stage / *loadable, there);
      if (!there) ++count;
    }
    fs::create_symlink(fs::absolute(entry.path()), stage / name, there);
  }
  return count;
}

/// Locks the folder for this process and the program that it becomes: whatever ends them, the lock
/// ends with them. False: another process has it, or it was removed meanwhile.
bool tryTake(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY);  // exec must not close it
  std::error_code failed;
  if (descriptor >= 0 && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && fs::exists(folder, failed))
    return true;
  if (descriptor >= 0) ::close(descriptor);
  return false;
}

/// A folder of our own; empty: none can be made.
fs::path makeFolder(const fs::path& temporary) {
  constexpr int kAttempts = 5;
  for (int i = 0; i < kAttempts; ++i) {
    std::string pattern = temporary / (std::string(kPrefix) + "XXXXXX");
    if (::mkdtemp(pattern.data()) == nullptr) return {};
    if (tryTake(pattern)) return pattern;
  }
  return {};
}

/// Removes what processes left behind that were killed before they could.
void sweep(const fs::path& temporary) {
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(temporary, failed)) {
    if (!entry.path().filename().string().starts_with(kPrefix)) continue;
    const rt::UniqueFd folder(
        ::open(entry.path().c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!folder.valid() || ::flock(folder.get(), LOCK_EX | LOCK_NB) != 0) continue;
    fs::remove_all(entry.path(), failed);
  }
}

}  // namespace

DriverStage::DriverStage(fs::path folder) {
  if (folder.filename().string().starts_with(kPrefix)) folder_ = std::move(folder);
}

std::expected<DriverStage, std::string> DriverStage::make(const fs::path& drivers) {
  const std::string who = "depth sensor drivers " + drivers.string() + ": ";
  std::error_code failed;
  if (!fs::is_directory(drivers, failed))
    return std::unexpected(who + "there is no such folder: correct depth_sensor.drivers");
  const auto library = libraryPath();
  if (!library) return std::unexpected("OpenNI2 is not installed: install libopenni2-0");
  const fs::path temporary = fs::temp_directory_path(failed);
  if (!failed) sweep(temporary);
  const fs::path folder = failed ? fs::path() : makeFolder(temporary);
  if (folder.empty()) {
    return std::unexpected(who + "no temporary folder can be made: free space in " +
                           temporary.string());
  }
  DriverStage stage(folder);
  const fs::path place = stage.folder() / "OpenNI2" / "Drivers";
  fs::create_directories(place, failed);
  if (!failed) fs::copy_file(*library, stage.folder() / kLibrary, failed);
  if (failed)
    return std::unexpected(who + "cannot be staged in " + folder.string() + ": free some space");
  const int count = linkAll(drivers, place, failed);
  if (failed) return std::unexpected(who + failed.message() + ": check its permissions");
  if (count == 0) {
    return std::unexpected(who +
                           "no OpenNI2 driver (lib*.so) lies there: give the folder that "
                           "the vendor calls OpenNI2/Drivers");
  }
  const fs::path recordings = library->parent_path() / "OpenNI2" / "Drivers" / kRecordings;
  fs::create_symlink(recordings, place / kRecordings, failed);  // the vendor's own one may be there
  return stage;
}

void DriverStage::remove() {
  if (folder_.empty()) return;
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  folder_.clear();
}

}  // namespace hal::openni
