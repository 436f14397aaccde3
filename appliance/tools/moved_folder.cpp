#include "appliance/tools/moved_folder.h"

#include <system_error>

namespace appliance {

namespace fs = std::filesystem;

std::expected<void, std::string> checkNewFolder(const fs::path& path) {
  std::error_code failed;
  const fs::path around = fs::absolute(path).parent_path();
  if (!fs::is_directory(around, failed))
    return std::unexpected(around.string() + ": there is no such folder: make it first");
  if (!fs::exists(path, failed)) return {};
  if (fs::is_directory(path, failed) && fs::is_empty(path, failed)) return {};
  return std::unexpected(path.string() + ": exists already: give a new folder");
}

std::expected<std::string, std::string> moveFolder(const fs::path& from, const fs::path& to) {
  std::error_code failed;
  std::error_code ignored;
  fs::copy(from, to, fs::copy_options::recursive, failed);
  if (failed) {
    fs::remove_all(to, ignored);
    return std::unexpected(from.string() + ": cannot be copied to " + to.string() + " (" +
                           failed.message() + "): it stays there");
  }
  fs::remove_all(from, failed);
  if (!failed) return std::string();
  return from.string() + ": a copy stays there (" + failed.message() + ")";
}

}  // namespace appliance
